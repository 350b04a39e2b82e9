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

/// The seconds of a duration such as "10 s", "5 min" or "2 h". Throws InputError, which names the option, for any other
/// text, and unless it is greater than zero.
double parse_duration(const std::string& text, const std::string& option);

/// A duration as text: "2.3 s", "45 s", "1 min 20 s", "35 min", "2 h 10 min", "3 d 4 h". Precondition: seconds >= 0.
std::string readable_duration(double seconds);

/// Seconds since this time.
double seconds_since(std::chrono::steady_clock::time_point start);

/// The present rate of work, over about the last 15 seconds.
class RecentRate {
 public:
  using Clock = std::chrono::steady_clock;

  explicit RecentRate(Clock::time_point start) : marks_{{start, 0}}, latest_{start, 0} {}

  /// Records the amount done by now. Preconditions: neither time nor amount ever falls.
  void add(Clock::time_point now, std::uint64_t done);
  /// Units of work per second; zero while nothing is done.
  double per_second() const;

 private:
  struct Mark {
    Clock::time_point time;
    std::uint64_t done;
  };

  std::deque<Mark> marks_;  ///< marks within the window, some time apart; the first is at its beginning or just before
  Mark latest_;
};

/// The content of a line of progress.
struct ProgressFacts {
  Progress progress;
  double rate = 0.0;      ///< present solves per second; 0: not known yet
  std::size_t stage = 1;  ///< number of the stage, counted from 1; the size of a stage is known when it begins
};

/// A line of progress: "43.2 % done, 7.21 M solves/s, 12 not converged (0.0012 %), 1 min 20 s left".
std::string plain_line(const ProgressFacts& facts);

/// The same with a bar, in at most `width` columns of one byte each. If there is little room the bar gets shorter, then
/// the details are left out, then the time left.
std::string live_line(const ProgressFacts& facts, std::size_t width);

/// The progress of a search: "looking for poses: 12 of 100 found, 34000 candidates".
std::string search_line(const PoseSearch& search);

/// A line on stderr that is updated. On a terminal it is overwritten, at the present width; otherwise a new line is
/// written every few seconds. Quiet: nothing is written.
class ProgressLine {
 public:
  using Clock = std::chrono::steady_clock;

  explicit ProgressLine(bool quiet);
  ~ProgressLine() { finish(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Whether it is time to write the line. A positive answer starts a new interval.
  bool is_due(Clock::time_point now);
  /// Writes the line. plain: its text; live(width): its text in at most this many columns.
  void write(const std::function<std::string()>& plain, const std::function<std::string(std::size_t)>& live);
  /// Erases the live line, so that other lines may follow.
  void finish();

 private:
  Clock::duration interval() const;

  bool quiet_;
  bool live_;
  bool open_ = false;
  Clock::time_point next_;
};

/// Shows the progress of solves.
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
