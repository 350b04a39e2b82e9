#include "engine/base/plain_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

std::string text(const PlainFile& file, std::uintmax_t at, std::size_t most) {
  std::string read(most, '?');
  read.resize(file.read(at, std::as_writable_bytes(std::span(read))).value());
  return read;
}

TEST(PlainFile, ReadsFromAnyPositionToTheEnd) {
  const TempFolder folder;
  const PlainFile file(folder.write("f", "0123456789"));
  ASSERT_TRUE(file.is_open());
  EXPECT_EQ(file.size(), 10U);
  EXPECT_EQ(text(file, 0, 4), "0123");
  EXPECT_EQ(text(file, 7, 2), "78");
  EXPECT_EQ(text(file, 7, 100), "789");
  EXPECT_EQ(text(file, 10, 1), "");
  EXPECT_EQ(text(file, 1000, 1), "");
}

TEST(PlainFile, HandsOutTheWholeFileInOrder) {
  const TempFolder folder;
  for (const std::size_t size : {0U, 1U, 65535U, 65536U, 65537U, 200'000U}) {
    std::string content;
    for (std::size_t k = 0; k < size; ++k) content += static_cast<char>('a' + k % 23);
    std::string read;
    const auto take = [&](std::span<const std::byte> part) {
      EXPECT_FALSE(part.empty());
      for (const std::byte byte : part) read += static_cast<char>(byte);
    };
    EXPECT_TRUE(PlainFile(folder.write("f", content)).read_parts(take));
    EXPECT_EQ(read, content) << size;
  }
}

TEST(PlainFile, IsTheFileThatWasOpenedWhateverHasItsNameLater) {
  const TempFolder folder;
  const PlainFile file(folder.write("f", "first"));
  std::filesystem::remove(folder / "f");
  folder.write("f", "second");
  EXPECT_EQ(text(file, 0, 100), "first");
}

TEST(PlainFile, SaysWhatThereIsInItsPlace) {
  const TempFolder folder;
  const std::string fifo = folder / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), S_IRUSR | S_IWUSR), 0);
  const std::array<std::pair<std::string, std::string_view>, 3> others{
      {{folder.path(), "a folder"}, {fifo, "a FIFO"}, {"/dev/null", "a device"}}};
  for (const auto& [path, words] : others) {
    const PlainFile file(path);
    EXPECT_FALSE(file.is_open()) << path;
    EXPECT_EQ(file.other(), words);
    EXPECT_EQ(file.error(), EINVAL) << path;
  }
}

TEST(PlainFile, SaysWhyThereIsNone) {
  const TempFolder folder;
  const PlainFile file(folder / "missing");
  EXPECT_FALSE(file.is_open());
  EXPECT_EQ(file.other(), "");
  EXPECT_EQ(file.error(), ENOENT);
}

TEST(PlainFile, SaysWhenTheDiskFails) {
  const PlainFile memory("/proc/self/mem");  // a plain file, but reading at offset 0 fails
  ASSERT_TRUE(memory.is_open());
  std::array<std::byte, 8> bytes{};
  errno = 0;
  EXPECT_FALSE(memory.read(0, bytes));
  EXPECT_EQ(errno, EIO);
  errno = 0;
  EXPECT_FALSE(memory.read_parts([](std::span<const std::byte>) { ADD_FAILURE() << "nothing can be read"; }));
  EXPECT_EQ(errno, EIO);
}

TEST(PlainFile, DoesNotCountHoles) {
  const TempFolder folder;
  const std::string path = folder.write("f", "some bytes");
  constexpr std::uintmax_t kBytes = std::uintmax_t{1} << 32U;
  std::filesystem::resize_file(path, kBytes);
  const PlainFile file(path);
  EXPECT_EQ(file.size(), kBytes);
  EXPECT_GE(file.stored_bytes(), 10U);
  EXPECT_LE(file.stored_bytes(), 1U << 20U);
}

TEST(PlainFile, LeavesNothingOpen) {
  const TempFolder folder;
  const std::string path = folder.write("f", "bytes");
  const std::size_t open = files_in("/proc/self/fd");
  {
    const PlainFile one(path);
    const PlainFile other(folder.path());
    EXPECT_EQ(files_in("/proc/self/fd"), open + 1);
  }
  EXPECT_EQ(files_in("/proc/self/fd"), open);
}

}  // namespace
}  // namespace poesy::test
