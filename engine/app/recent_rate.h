#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

namespace poesy::app {

/// How fast something is done now: over the last 15 seconds or so, not over all of the time.
class RecentRate {
 public:
  using Clock = std::chrono::steady_clock;

  explicit RecentRate(Clock::time_point start) : marks_{{start, 0}}, latest_{start, 0} {}

  /// done: so much by now. Neither time nor amount ever falls.
  void add(Clock::time_point now, std::uint64_t done);
  /// Zero while nothing is done.
  double per_second() const;

 private:
  struct Mark {
    Clock::time_point time;
    std::uint64_t done;
  };

  std::deque<Mark> marks_;  ///< of the window, some time apart; the first is at its beginning or just before
  Mark latest_;
};

}  // namespace poesy::app
