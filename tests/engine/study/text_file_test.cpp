#include "engine/study/text_file.h"

#include <gtest/gtest.h>

#include "tests/support/swapped_file.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

TEST(ReadText, WaitsForNoFifoThatTakesAFilesPlace) {
  const TempFolder folder;
  const std::string path = folder.write("text", "text");
  const TempFolder others;
  const SwappedFile swapped(others, path);
  std::size_t texts = 0;
  std::size_t refused = 0;
  for (std::size_t n = 0; n < 20'000; ++n) {
    try {
      EXPECT_EQ(read_text(path, "study", 100), "text");
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
}  // namespace poesy::test
