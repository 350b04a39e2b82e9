#include "engine/storage/file_writer.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
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

/// Makes the temporary name known beforehand.
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

/// An access list as the system keeps it: the owner and user 12345 may read and write, nobody else anything.
std::string access_list() {
  struct Entry {
    std::uint16_t whom, rights;
    std::uint32_t id;
  };
  constexpr std::uint32_t kVersion = 2;
  constexpr std::uint32_t kNobody = 0xFFFF'FFFF;
  constexpr std::array<Entry, 5> kEntries{
      {{0x01, 6, kNobody}, {0x02, 6, 12345}, {0x04, 0, kNobody}, {0x10, 6, kNobody}, {0x20, 0, kNobody}}};
  std::string list(sizeof kVersion + sizeof kEntries, '\0');
  std::memcpy(list.data(), &kVersion, sizeof kVersion);
  std::memcpy(list.data() + sizeof kVersion, kEntries.data(), sizeof kEntries);
  return list;
}

/// Gives a path such a list under this name. Whether its file system has them.
bool give_access_list(const std::string& path, const char* name) {
  const std::string list = access_list();
  return ::setxattr(path.c_str(), name, list.data(), list.size(), 0) == 0;
}

std::string access_list_of(const std::string& path) {
  std::string list(200, '\0');
  const ssize_t bytes = ::getxattr(path.c_str(), "system.posix_acl_access", list.data(), list.size());
  list.resize(bytes < 0 ? 0 : static_cast<std::size_t>(bytes));
  return list;
}

TEST(FileWriter, KeepsTheAccessListOfWhatItReplaces) {
  const TempFolder folder;
  const std::string path = folder.write("f", "old");
  if (!give_access_list(path, "system.posix_acl_access")) GTEST_SKIP() << "this file system has no access lists";
  ASSERT_EQ(access_list_of(path), access_list());
  write_text(path, "new");
  EXPECT_EQ(access_list_of(path), access_list());
}

TEST(FileWriter, GetsNoAccessListThatTheOldFileHasNot) {
  const TempFolder folder;
  const std::string path = folder.write("f", "old");
  ::chmod(path.c_str(), 0640);
  if (!give_access_list(folder.path(), "system.posix_acl_default")) {
    GTEST_SKIP() << "this file system has no access lists";
  }
  write_text(path, "new");
  EXPECT_EQ(access_list_of(path), "");
  EXPECT_EQ(mode_of(path), 0640U);
}

constexpr uid_t kOther = 12345;

/// Replaces a file of another user and this group, which has these rights, under this umask; the rights then.
mode_t rights_after(mode_t theirs, gid_t group, mode_t mask, const std::string& like = {}) {
  const TempFolder folder;
  const std::string path = folder.write("f", "");
  EXPECT_EQ(::chown(path.c_str(), kOther, group), 0);
  ::chmod(path.c_str(), theirs);
  const mode_t old_mask = ::umask(mask);
  write_like(path, like);
  ::umask(old_mask);
  struct stat facts {};
  EXPECT_EQ(::stat(path.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_uid, ::geteuid());
  EXPECT_EQ(facts.st_gid, ::getegid());
  return facts.st_mode & 0777U;
}

TEST(FileWriter, GetsNoRightsFromAFileOfAnotherUser) {
  const TempFolder folder;
  const std::string like = folder.write("like", "");
  if (::chown(like.c_str(), kOther, kOther) != 0) GTEST_SKIP() << "only root makes files of others";
  EXPECT_EQ(rights_after(0666, kOther, 022), 0644U);
  EXPECT_EQ(rights_after(0600, kOther, 022), 0600U);
  EXPECT_EQ(rights_after(0660, kOther, 022), 0600U);
  EXPECT_EQ(rights_after(0604, kOther, 022), 0644U);
  EXPECT_EQ(rights_after(0044, kOther, 022), 0644U) << "the owner may read and write";
  EXPECT_EQ(rights_after(0660, ::getegid(), 002), 0660U) << "of a folder whose files have its group";
  EXPECT_EQ(rights_after(0660, ::getegid(), 022), 0640U);
  ASSERT_EQ(::chown(like.c_str(), ::geteuid(), ::getegid()), 0);
  ::chmod(like.c_str(), 0600);
  EXPECT_EQ(rights_after(0666, kOther, 022, like), 0600U);
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
