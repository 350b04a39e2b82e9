// Code that checks a path and then opens it by name may find a FIFO there by then, and wait for ever.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>

#include "engine/base/error.h"
#include "engine/storage/checkpoint.h"
#include "engine/storage/file_writer.h"
#include "engine/storage/h5.h"
#include "engine/storage/output_folder.h"
#include "engine/storage/poesy_file.h"
#include "tests/support/swapped_file.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

/// Calls read() 20 000 times or more, until it has met both the plain file and the FIFO. read() returns whether it read
/// the plain file.
void expect_both(const TempFolder& others, const std::string& path, const std::function<bool()>& read) {
  const SwappedFile swapped(others, path);
  std::size_t read_file = 0;
  std::size_t refused = 0;
  for (std::size_t n = 0; n < 20'000 || ((read_file == 0 || refused == 0) && n < 1'000'000); ++n) {
    ++(read() ? read_file : refused);
  }
  EXPECT_GT(read_file, 0U);
  EXPECT_GT(refused, 0U);
}

class SwappedFiles : public testing::Test {
 protected:
  TempFolder folder_;
  TempFolder others_;
};

TEST_F(SwappedFiles, OfHdf5) {
  const std::string path = folder_ / "f.h5";
  FileWriter writer(path);
  h5::File file = h5::File::on_disk(writer);
  file.set_attribute("/", "number", std::int64_t{7});
  file.close();
  writer.commit();
  expect_both(others_, path, [&] {
    try {
      EXPECT_EQ(h5::File::open(path).attribute<std::int64_t>("/", "number").at(0), 7);
      return true;
    } catch (const h5::Error& error) {
      EXPECT_NE(std::string(error.what()).find("(is a FIFO)"), std::string::npos) << error.what();
      return false;
    }
  });
}

TEST(H5File, LeavesNothingOpen) {
  const TempFolder folder;
  const std::string path = folder / "f.h5";
  FileWriter writer(path);
  h5::File::on_disk(writer).close();
  writer.commit();
  const std::size_t open = files_in("/proc/self/fd");
  { const h5::File file = h5::File::open(path); }
  EXPECT_THROW(h5::File::open(folder.write("text", "no HDF5")), h5::Error);
  EXPECT_THROW(h5::File::open(folder.path()), h5::Error);
  EXPECT_EQ(files_in("/proc/self/fd"), open);
}

TEST(H5File, SaysWhenTheDiskFails) {
  try {
    h5::File::open("/proc/self/mem");  // a plain file of which nothing can be read at 0
    ADD_FAILURE() << "was opened";
  } catch (const h5::Error& error) {
    EXPECT_NE(std::string(error.what()).find("Input/output error"), std::string::npos) << error.what();
  }
}

TEST_F(SwappedFiles, OfCheckpoints) {
  const std::string result = folder_ / "r.h5";
  CheckpointFiles files(result);
  files.write({}, {}, {});
  expect_both(others_, files.newer(), [&] {
    try {
      return CheckpointFiles(result).find().has_value();
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("is not a plain file"), std::string::npos) << error.what();
      return false;
    }
  });
}

TEST_F(SwappedFiles, ThatMayBeReplaced) {
  const std::string path = folder_.write("f", "with a mark");
  expect_both(others_, path, [&] { return has_mark(path, "mark"); });
}

TEST_F(SwappedFiles, OfTables) {
  {
    OutputFolder output(folder_.path(), {});
    output.claim("a.csv");
    output.fill([&] { folder_.write("a.csv", "z\n0.1\n"); });
  }
  expect_both(others_, folder_ / "a.csv", [&] {
    OutputFolder output(folder_.path(), {});
    try {
      output.claim("a.csv");
      return true;
    } catch (const InputError&) {
      return false;
    }
  });
}

}  // namespace
}  // namespace poesy::test
