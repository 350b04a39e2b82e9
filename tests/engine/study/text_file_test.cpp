#include "engine/study/text_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

namespace fs = std::filesystem;

/// Puts a FIFO and a plain file in each other's place, until it goes.
class Swapping {
 public:
  Swapping(const test::TempFolder& folder, const std::string& plain, const std::string& fifo)
      : thread_([=, this, path = folder / "text", next = folder / "next"] {
          for (std::size_t n = 0; !done_; ++n) {
            fs::create_hard_link(n % 2 == 0 ? fifo : plain, next);
            fs::rename(next, path);
          }
        }) {}
  Swapping(const Swapping&) = delete;
  Swapping& operator=(const Swapping&) = delete;
  ~Swapping() {
    done_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

/// A program that looks at a path and then opens it by the same name waits here for a writer, after some hundred tries.
TEST(ReadText, WaitsForNoFifoThatTakesAFilesPlace) {
  const test::TempFolder folder;
  const std::string plain = folder.write("plain", "text");
  const std::string fifo = folder / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), S_IRUSR | S_IWUSR), 0);
  folder.write("text", "text");
  const Swapping swapping(folder, plain, fifo);
  std::size_t texts = 0;
  std::size_t refused = 0;
  for (std::size_t n = 0; n < 20'000; ++n) {
    try {
      EXPECT_EQ(read_text(folder / "text", "study", 100), "text");
      ++texts;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("is a FIFO, not a study"), std::string::npos) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(texts, 0u);
  EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace poesy
