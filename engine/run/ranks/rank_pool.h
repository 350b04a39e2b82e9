#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "engine/run/run_in_slots.h"
#include "engine/run/run_options.h"

namespace poesy {

/// A pool of threads (run_in_slots) that works beside the calling thread, on numbers that it is given bit by bit.
class RankPool {
 public:
  /// The slot of the next number n. Called from one thread at a time.
  using SlotOf = std::function<std::size_t(std::size_t n)>;

  /// Calls deliver(n, slot) after each work, one after another, on threads of the pool.
  RankPool(const RunOptions& options, std::function<SlotJob()> make_work, SlotOf slot_of, SlotJob deliver);
  RankPool(const RankPool&) = delete;
  RankPool& operator=(const RankPool&) = delete;
  ~RankPool();

  /// Work with the numbers first, first + 1, ...
  void give(std::size_t first, std::size_t count);
  /// Returns at the end of that time, or when numbers have become few since the last call.
  void wait(std::chrono::microseconds at_most);
  /// Whether something was thrown.
  bool failed() const { return failed_; }
  /// Ends the pool: what is being worked on is delivered, no more is begun. Throws what was thrown in it.
  void finish();

 private:
  struct Range {
    std::size_t first;
    std::size_t end;
  };

  std::optional<Ticket> take();
  void close();
  /// The function, closing the pool when it throws, for oneTBB lets no thread go that waits for a number.
  template <class Function>
  auto closing(Function function);

  SlotOf slot_of_;
  std::size_t low_;  ///< so many numbers are few
  std::mutex mutex_;
  std::condition_variable given_;
  std::condition_variable hungry_;
  std::deque<Range> ranges_;
  std::size_t left_ = 0;  ///< numbers in them
  bool hungry_now_ = false;
  bool closed_ = false;
  std::atomic<bool> failed_{false};
  std::exception_ptr problem_;
  std::thread thread_;  ///< last, for it uses all others
};

}  // namespace poesy
