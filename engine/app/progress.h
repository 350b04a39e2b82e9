#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>

#include "engine/run/run_options.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy::app {

/// Seconds of "10 s", "5 min" or "2 h". Throws InputError that names the option when the text is anything else, or not
/// greater than zero.
double parse_duration(const std::string& text, const std::string& option);

/// "2.3 s", "45 s", "1 min 20 s", "35 min", "2 h 10 min", "3 d 4 h". Seconds of zero or more.
std::string readable_duration(double seconds);

/// Seconds since then.
double seconds_since(std::chrono::steady_clock::time_point start);

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

/// What a line of progress says.
struct ProgressFacts {
  Progress progress;
  double rate = 0.0;      ///< solves per second, now; 0: not known yet
  std::size_t stage = 1;  ///< of a run in several stages, the size of which is known one by one
};

/// "43.2 % done, 7.21 M solves/s, 12 not converged (0.0012 %), 1 min 20 s left"
std::string plain_line(const ProgressFacts& facts);

/// The same with a bar, in at most `width` columns of one byte each. Where there is little room the bar gets shorter,
/// then the details go, and the time left last of all.
std::string live_line(const ProgressFacts& facts, std::size_t width);

/// "looking for poses: 12 of 100 found, 34000 candidates"
std::string search_line(const PoseSearch& search);

/// A line on stderr that is written again and again: over itself on a terminal, as wide as that is now, below itself
/// every few seconds otherwise, never when quiet.
class ProgressLine {
 public:
  using Clock = std::chrono::steady_clock;

  explicit ProgressLine(bool quiet);
  ~ProgressLine() { finish(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Whether it is time to write it, which is so once.
  bool is_due(Clock::time_point now);
  /// plain: the line; live(width): the same in at most so many columns.
  void write(const std::function<std::string()>& plain, const std::function<std::string(std::size_t)>& live);
  /// Takes the live line away, so that other lines may follow.
  void finish();

 private:
  Clock::duration interval() const;

  bool quiet_;
  bool live_;
  bool open_ = false;
  Clock::time_point next_;
};

/// Writes the progress of solves.
class ProgressPrinter {
 public:
  explicit ProgressPrinter(bool quiet) : line_(quiet), rate_(RecentRate::Clock::now()) {}

  void operator()(const Progress& progress);

 private:
  ProgressLine line_;
  RecentRate rate_;
  std::uint64_t done_ = 0;
  std::size_t stage_ = 1;
};

}  // namespace poesy::app
