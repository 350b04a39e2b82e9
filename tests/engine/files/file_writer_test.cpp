#include "engine/files/file_writer.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "engine/base/error.h"
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

TEST(FileWriter, RefusesAFolder) {
  const TempFolder folder;
  EXPECT_THROW(FileWriter(folder.path()), FileError);
}

}  // namespace
}  // namespace poesy::test
