#include "engine/run/threads.h"

#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <vector>

#include "engine/base/address_space.h"
#include "engine/base/error.h"

namespace poesy {
namespace {

/// A number of threads that do nothing until this object is destroyed.
class WaitingThreads {
 public:
  explicit WaitingThreads(std::size_t count) {
    pthread_attr_t attributes;
    ::pthread_attr_init(&attributes);
    ::pthread_attr_setstacksize(&attributes, kThreadStackBytes);
    threads_.reserve(count);
    for (pthread_t thread{}; reason_ == 0 && threads_.size() < count;) {
      reason_ = ::pthread_create(&thread, &attributes, live, this);
      if (reason_ == 0) threads_.push_back(thread);
    }
    ::pthread_attr_destroy(&attributes);
    for (std::size_t n = ready_; n < threads_.size(); n = ready_) ready_.wait(n);
  }
  WaitingThreads(const WaitingThreads&) = delete;
  WaitingThreads& operator=(const WaitingThreads&) = delete;
  ~WaitingThreads() {
    over_ = true;
    over_.notify_all();
    for (const pthread_t thread : threads_) ::pthread_join(thread, nullptr);
  }

  /// 0 if all threads were created; otherwise the errno of the failure.
  int reason() const { return reason_; }

 private:
  static void* live(void* self) {
    auto& all = *static_cast<WaitingThreads*>(self);
    ++all.ready_;
    all.ready_.notify_all();
    all.over_.wait(false);
    return nullptr;
  }

  std::vector<pthread_t> threads_;
  int reason_ = 0;
  std::atomic<std::size_t> ready_{0};
  std::atomic<bool> over_{false};
};

/// 0 if `threads` threads can exist at once with memory for their work; otherwise the errno of the failure.
int problem_of(std::size_t threads) {
  constexpr std::size_t kRoom = std::size_t{2} << 20U;
  constexpr std::size_t kRoomOfThread = std::size_t{1} << 18U;
  const WaitingThreads others(threads - 1);
  if (others.reason() != 0) return others.reason();
  return has_address_space(kRoom + threads * kRoomOfThread) ? 0 : ENOMEM;
}

}  // namespace

void expect_threads(std::size_t threads) {
  if (const int problem = problem_of(threads); problem != 0) {
    throw FileError(
        "", std::to_string(threads) + " threads cannot be started (" + std::generic_category().message(problem) + ")",
        "give fewer with --threads, or raise the limits on processes and memory (ulimit -u, ulimit -v)");
  }
}

}  // namespace poesy
