#include "engine/storage/file_writer.h"

#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>

#include "engine/base/error.h"
#include "engine/storage/checkpoint.h"
#include "tests/support/states.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

int no_hard_links(const char*, const char*) {
  errno = EPERM;
  return -1;
}

class SecondName : public testing::TestWithParam<LinkFile> {
 protected:
  TempFolder folder_;
};

TEST_P(SecondName, LeavesTheFirstAndReplacesTheSecond) {
  const std::string path = folder_.write("new", "new content");
  const std::string second = folder_.write("old", "old content");
  put_at_second_name(path, second, GetParam());
  EXPECT_EQ(read_bytes(path), "new content");
  EXPECT_EQ(read_bytes(second), "new content");
  EXPECT_EQ(files_in(folder_.path()), 2U);
}

/// A file that is later moved to the first name does not change the content at the second name.
TEST_P(SecondName, MayBeGivenAgainAndAgain) {
  const std::string path = folder_.write("new", "1");
  const std::string second = folder_ / "old";
  for (int time = 0; time < 2; ++time) put_at_second_name(path, second, GetParam());
  std::filesystem::rename(folder_.write("newest", "2"), path);
  EXPECT_EQ(read_bytes(second), "1");
  EXPECT_EQ(files_in(folder_.path()), 2U);
}

TEST_P(SecondName, IsNotTouchedWhenThereIsNoFirst) {
  const std::string second = folder_.write("old", "old content");
  EXPECT_THROW(put_at_second_name(folder_ / "absent", second, GetParam()), FileError);
  EXPECT_EQ(read_bytes(second), "old content");
  EXPECT_EQ(files_in(folder_.path()), 1U);
}

INSTANTIATE_TEST_SUITE_P(Ways, SecondName, testing::Values(::link, no_hard_links),
                         [](const auto& each) { return std::string(each.param == ::link ? "HardLink" : "Copy"); });

/// The names that were removed from a folder while `act` ran, as reported by inotify.
template <class Act>
std::multiset<std::string> names_taken_away(const std::string& folder, const Act& act) {
  const int watcher = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  EXPECT_NE(inotify_add_watch(watcher, folder.c_str(), IN_DELETE | IN_MOVED_FROM), -1);
  act();
  std::multiset<std::string> names;
  alignas(inotify_event) std::array<char, 1 << 16> events{};
  const ssize_t length = read(watcher, events.data(), events.size());
  for (ssize_t at = 0; at < length;) {
    inotify_event event{};
    std::memcpy(&event, &events[static_cast<std::size_t>(at)], sizeof event);
    names.insert(&events[static_cast<std::size_t>(at) + sizeof event]);
    at += static_cast<ssize_t>(sizeof event + event.len);
  }
  close(watcher);
  return names;
}

TEST(CheckpointFilesUnderWay, NeverTakeTheNewestAway) {
  const TempFolder folder;
  CheckpointFiles files(folder / "r.h5");
  const std::vector<Bytes> stages{Bytes(1000)};
  const auto write_some = [&] {
    for (int time = 0; time < 5; ++time) files.write({}, {}, sources_of(stages));
  };
  const std::multiset<std::string> taken = names_taken_away(folder.path(), write_some);
  EXPECT_EQ(taken.count("r.h5.part"), 0U);
  EXPECT_EQ(taken.count("r.h5.part.1"), 0U);
  const auto is_temporary = [](const std::string& name) { return name.starts_with("r.h5.part.tmp."); };
  EXPECT_EQ(std::ranges::count_if(taken, is_temporary), 5) << "what is written is seen";
  EXPECT_EQ(files_in(folder.path()), 2U);
}

}  // namespace
}  // namespace poesy::test
