#include "engine/storage/poesy_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/sanitizers.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

class TrialRead : public testing::Test {
 protected:
  /// The message of the FileError that a trial read throws. Empty if it throws none.
  std::string message(const std::function<void()>& read, unsigned long wait_seconds = kTrialWaitSeconds) const {
    try {
      trial_read(path_, read, wait_seconds);
    } catch (const FileError& error) {
      return error.what();
    }
    return {};
  }
  void expect_message(const std::string& part, const std::function<void()>& read) const {
    const std::string found = message(read);
    EXPECT_TRUE(found.starts_with(path_ + ": is damaged: ")) << found;
    EXPECT_NE(found.find(part), std::string::npos) << found;
    EXPECT_NE(found.find("; take another copy"), std::string::npos) << found;
  }

  TempFolder folder_;
  std::string path_ = folder_.write("r.h5", "some bytes");
};

TEST_F(TrialRead, LeavesThisProcessAlone) {
  const std::size_t files = files_in("/proc/self/fd");
  int value = 1;
  EXPECT_EQ(message([&] {
              value = 2;
              std::puts("nobody reads this");
              std::fflush(stdout);
            }),
            "");
  EXPECT_EQ(value, 1);
  EXPECT_EQ(files_in("/proc/self/fd"), files);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

TEST_F(TrialRead, PassesOnWhatIsWrong) {
  EXPECT_EQ(message([] { throw FileError("f", "is of another kind", "take mine"); }),
            "f: is of another kind; take mine");
  const std::string much(1 << 20, 'x');  // more than a pipe holds
  EXPECT_EQ(message([&] { throw FileError("f", much, "shorten it"); }), "f: " + much + "; shorten it");
}

TEST_F(TrialRead, SurvivesAnyEnd) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) {
    expect_message("crashes", [signal] { std::raise(signal); });
  }
  expect_message("crashes", [] { ::_exit(0); });
  expect_message("crashes", [] { throw std::runtime_error("no FileError"); });
}

/// HDF5 does not raise SIGKILL, but a system without memory does. So the file is not called damaged.
TEST_F(TrialRead, CallsAFileThatWasNotReadNotDamaged) {
  EXPECT_EQ(message([] { std::raise(SIGKILL); }),
            path_ +
                ": cannot be read: the process that read it was killed, as a system without memory does; end other "
                "programs, and try again");
}

TEST_F(TrialRead, EndsWhatDoesNotEnd) {
  expect_message("does not end", [] {
    rlimit limits{};
    ::getrlimit(RLIMIT_CPU, &limits);
    if (limits.rlim_cur > kTrialSeconds) throw std::runtime_error("this would take too long");
    limits.rlim_cur = 1;
    ::setrlimit(RLIMIT_CPU, &limits);
    for (volatile bool ever = true; ever;) {
    }
  });
}

/// The limits grow with the size of the file, but not with its holes: a sparse file may claim any size.
TEST_F(TrialRead, GivesNothingForTheHolesOfAFile) {
  std::filesystem::resize_file(path_, std::uintmax_t{1} << 35U);
  EXPECT_NO_THROW(trial_read(path_, [] {
    rlimit limits{};
    ::getrlimit(RLIMIT_CPU, &limits);
    if (limits.rlim_cur > kTrialSeconds) throw FileError("", "has more time", "");
  }));
}

TEST_F(TrialRead, EndsWhatWaitsForEver) {
  const auto start = std::chrono::steady_clock::now();
  const auto wait = [] {
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, nullptr);
    for (;;) ::pause();
  };
  const std::string found = message(wait, 1);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(found,
            path_ +
                ": cannot be read within 1 s: it is damaged, or the machine or its disk is busy; try again, or take "
                "another copy");
  EXPECT_GE(took.count(), 1.0);
  EXPECT_LT(took.count(), 20.0);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

TEST_F(TrialRead, HasSoMuchMemoryAndNoMore) {
#ifdef POESY_SANITIZED
  GTEST_SKIP() << "without memory, a sanitizer ends the process";
#endif
  const auto take = [](std::size_t bytes) { ::operator delete(::operator new(bytes)); };
  EXPECT_EQ(message([&] { take(kTrialBytes / 2); }), "");
  expect_message("takes more memory", [&] { take(2 * kTrialBytes); });
}

TEST_F(TrialRead, NeedsNobodyToWaitForIt) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);  // as some programs set it for their child processes
  EXPECT_EQ(message([] {}), "");
  EXPECT_NE(message([] { throw FileError("f", "is wrong", "mend it"); }), "");
  expect_message("crashes", [] { std::abort(); });
  std::signal(SIGCHLD, before);
}

TEST_F(TrialRead, MayBeCalledWhileOtherThreadsAllocate) {
  std::atomic<bool> stop{false};
  std::thread other([&] {
    while (!stop) std::vector<char>(1000).shrink_to_fit();
  });
  for (int k = 0; k < 50; ++k) EXPECT_EQ(message([] { std::vector<char>(100000).shrink_to_fit(); }), "");
  stop = true;
  other.join();
}

}  // namespace
}  // namespace poesy::test
