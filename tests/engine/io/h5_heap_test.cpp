#include "engine/io/h5_heap.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/io/h5.h"
#include "engine/io/result_file.h"
#include "tests/engine/io/example_result.h"
#include "tests/support/temp_folder.h"

// Read by the leak sanitizer: HDF5 1.10 does not free everything when it refuses a damaged file.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace poesy::test {
namespace {

std::vector<std::byte> file_with_texts() {
  h5::File file = h5::File::in_memory();
  const std::vector<std::string> texts{"first", "second", "third"};
  file.write<std::string>("/texts", {texts.size()}, texts);
  return file.image();
}

std::size_t heap_start(const std::vector<std::byte>& file) {
  const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
  return text.find("GCOL");
}

TEST(DamagedHeap, AcceptsWhatHdf5Writes) {
  const auto file = file_with_texts();
  ASSERT_LT(heap_start(file), file.size());
  EXPECT_FALSE(h5::damaged_heap(file).has_value());
  EXPECT_FALSE(h5::damaged_heap({}).has_value());
}

TEST(DamagedHeap, FindsEveryChangeOfALengthOrANumber) {
  const auto intact = file_with_texts();
  const std::size_t heap = heap_start(intact);
  const std::size_t second_object = heap + 16 + 24;  // header; first object with its text padded to 8
  std::vector<std::size_t> places{second_object, second_object + 1};
  for (std::size_t k = 8; k < 16; ++k) places.insert(places.end(), {heap + k, heap + 16 + k});
  for (const std::size_t place : places) {
    for (const unsigned mask : {0x10U, 0x80U, 0xffU}) {
      auto damaged = intact;
      damaged[place] ^= static_cast<std::byte>(mask);
      EXPECT_TRUE(h5::damaged_heap(damaged).has_value()) << place - heap << " ^ " << mask;
    }
  }
}

TEST(DamagedHeap, FindsACollectionThatIsCutOff) {
  auto file = file_with_texts();
  file.resize(heap_start(file) + 12);
  EXPECT_TRUE(h5::damaged_heap(file).has_value());
}

// Whatever byte is damaged, the reader refuses the file, or sees the difference, or the byte meant nothing: it never
// crashes.
TEST(DamagedResult, NeverCrashesTheReader) {
  const TempFolder folder;
  const std::string path = folder / "r.h5";
  Example().write_sensitivity(path);
  const std::string intact = read_bytes(path);
  std::size_t refused = 0;
  std::size_t different = 0;
  for (std::size_t place = 0; place < intact.size(); place += 37) {
    std::string damaged = intact;
    damaged[place] = static_cast<char>(damaged[place] ^ 0xff);
    write_bytes(path, damaged);
    try {
      const Verification verification = verify_result(path);
      if (!verification.matches()) ++different;
      read_result(path);
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100U);
  EXPECT_GT(different, 20U);
}

}  // namespace
}  // namespace poesy::test
