#include "engine/storage/file_writer.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <regex>
#include <set>
#include <span>
#include <string>

#include "engine/base/error.h"
#include "tests/support/input_error.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

TEST(FileWriter, FileAppearsAtCommit) {
  const TempFolder folder;
  FileWriter writer(folder / "f");
  writer.write("one ");
  writer.write("two");
  EXPECT_FALSE(std::filesystem::exists(folder / "f"));
  writer.commit();
  EXPECT_EQ(read_bytes(folder / "f"), "one two");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(FileWriter, WithoutCommitTheOldFileStays) {
  const TempFolder folder;
  write_bytes(folder / "f", "old");
  {
    FileWriter writer(folder / "f");
    writer.write("new");
  }
  EXPECT_EQ(read_bytes(folder / "f"), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(FileWriter, GivesTheRightsThatTheUmaskAllows) {
  const TempFolder folder;
  const mode_t old_mask = ::umask(022);
  FileWriter writer(folder / "f");
  writer.commit();
  ::umask(old_mask);
  struct stat facts {};
  ASSERT_EQ(::stat((folder / "f").c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777U, 0644U);
}

TEST(NameLength, IsWhatAFileTakesWhileItIsWritten) {
  const TempFolder folder;
  std::size_t longest = 0;
  for (std::size_t length = 200; length <= 255; ++length) {
    const std::string path = folder / std::string(length, 'a');
    bool written = true;
    try {
      FileWriter(path).commit();
      longest = length;
    } catch (const FileError& error) {
      written = false;
      EXPECT_NE(std::string(error.what()).find("; give it a shorter name"), std::string::npos) << error.what();
    }
    if (written) {
      check_name_length(path);
    } else {
      expect_input_error([&] { check_name_length(path); }, {path, 0, 0},
                         {"too long a name", "shorter by " + std::to_string(length - longest)});
    }
  }
  EXPECT_GT(longest, 200U);
  EXPECT_LT(longest, 255U);
}

/// The only name in a folder.
std::string only_name(const TempFolder& folder) {
  EXPECT_EQ(files_in(folder.path()), 1U);
  return std::filesystem::directory_iterator(folder.path())->path().filename().string();
}

TEST(FileWriter, HasATemporaryNameThatNobodyCanGuess) {
  std::set<std::string> names;
  for (int k = 0; k < 20; ++k) {
    const TempFolder folder;
    const FileWriter writer(folder / "f");
    const std::string name = only_name(folder);
    EXPECT_TRUE(std::regex_match(name, std::regex("f\\.tmp\\.[0-9a-f]{12}"))) << name;
    names.insert(name);
  }
  EXPECT_EQ(names.size(), 20U);
}

/// A source of "random" bytes that are all 0x11, so that the temporary name is known in advance.
bool fill_with_ones(std::span<std::byte> bytes) {
  std::ranges::fill(bytes, std::byte{0x11});
  return true;
}

bool cannot_fill(std::span<std::byte> /*bytes*/) {
  errno = ENOSYS;
  return false;
}

TEST(FileWriter, TouchesNothingThatHasItsTemporaryName) {
  const TempFolder folder;
  const std::string victim = folder.write("victim", "precious");
  const std::string planted = folder / "f.tmp.111111111111";
  const auto plant = [&](const std::string& what) {
    std::filesystem::remove(planted);
    if (what == "file") write_bytes(planted, "planted");
    if (what == "link") std::filesystem::create_symlink(victim, planted);
    if (what == "link to nothing") std::filesystem::create_symlink(folder / "absent", planted);
    if (what == "second name") std::filesystem::create_hard_link(victim, planted);
    if (what == "FIFO") ::mkfifo(planted.c_str(), S_IRUSR | S_IWUSR);
  };
  for (const std::string what : {"file", "link", "link to nothing", "second name", "FIFO"}) {
    plant(what);
    EXPECT_THROW(FileWriter(folder / "f", {}, fill_with_ones), FileError) << what;
    EXPECT_TRUE(stands(planted)) << what;
    EXPECT_EQ(read_bytes(victim), "precious") << what;
    EXPECT_EQ(files_in(folder.path()), 2U) << what;
  }
  std::filesystem::remove(planted);
  FileWriter writer(folder / "f", {}, fill_with_ones);
  EXPECT_TRUE(stands(planted));
}

TEST(FileWriter, WritesNothingWithoutRandomNumbers) {
  const TempFolder folder;
  EXPECT_THROW(FileWriter(folder / "f", {}, cannot_fill), FileError);
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(FileWriter, ReplacesALinkAndLeavesWhatItLeadsTo) {
  const TempFolder folder;
  const std::string victim = folder.write("victim", "precious");
  std::filesystem::create_symlink(victim, folder / "f");
  write_text(folder / "f", "new");
  EXPECT_EQ(read_bytes(victim), "precious");
  EXPECT_FALSE(std::filesystem::is_symlink(folder / "f"));
  EXPECT_EQ(read_bytes(folder / "f"), "new");
}

void write_like(const std::string& path, const std::string& like) {
  FileWriter writer(path, like);
  writer.commit();
}

mode_t mode_of(const std::string& path) {
  struct stat facts {};
  EXPECT_EQ(::stat(path.c_str(), &facts), 0);
  return facts.st_mode & 0777U;
}

TEST(FileWriter, KeepsThePermissionsOfWhatItReplaces) {
  const TempFolder folder;
  for (const mode_t mode : {0600U, 0640U, 0400U, 0666U}) {
    write_bytes(folder / "f", "old");
    ::chmod((folder / "f").c_str(), mode);
    FileWriter writer(folder / "f");
    writer.commit();
    EXPECT_EQ(mode_of(folder / "f"), mode);
    std::filesystem::remove(folder / "f");
  }
}

TEST(FileWriter, HasThePermissionsOfTheFileThatItIsToBeLike) {
  const TempFolder folder;
  ::chmod(folder.write("like", "").c_str(), 0604);
  for (int k = 0; k < 2; ++k) {
    write_like(folder / "f", folder / "like");
    EXPECT_EQ(mode_of(folder / "f"), 0604U);
    ::chmod((folder / "f").c_str(), 0666);
  }
}

TEST(LeftOver, IsRemovedAndNothingElse) {
  const TempFolder folder;
  for (const char* name : {"f", "f.tmp.0123456789ab", "f.tmp.ffffffffffff"}) folder.write(name, "x");
  for (const char* name : {"f.tmp.012", "f.tmp.0123456789aX", "g.tmp.0123456789ab"}) folder.write(name, "x");
  remove_left_over(folder / "f");
  EXPECT_EQ(files_in(folder.path()), 4U);
  EXPECT_FALSE(std::filesystem::exists(folder / "f.tmp.ffffffffffff"));
  remove_left_over(folder / "no/such/folder");
}

TEST(OutputPath, IsWhereLinksEnd) {
  const TempFolder folder;
  const auto path_of = [&](const std::string& name) {
    return check_output_path(folder / name, {"result", [](const std::string&) { return true; }}, {});
  };
  std::filesystem::create_directory(folder / "disk");
  std::filesystem::create_symlink("disk/new", folder / "one");
  std::filesystem::create_symlink(folder / "one", folder / "two");
  std::filesystem::create_symlink("three", folder / "three");
  EXPECT_EQ(path_of("plain"), folder / "plain");
  EXPECT_EQ(path_of("one"), folder / "disk/new");
  EXPECT_EQ(path_of("two"), folder / "disk/new");
  EXPECT_THROW(path_of("three"), InputError);
}

TEST(FileWriter, RefusesAFolder) {
  const TempFolder folder;
  EXPECT_THROW(FileWriter(folder.path()), FileError);
}

}  // namespace
}  // namespace poesy::test
