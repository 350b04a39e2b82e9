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

/// Reads a duration such as "10 s", "5 min" or "2 h", and returns it in s. Throws InputError with the name of the
/// option for any other text and for a duration that is not greater than zero.
double parse_duration(const std::string& text, const std::string& option);

/// A duration as text: "2.3 s", "45 s", "1 min 20 s", "35 min", "2 h 10 min", "3 d 4 h". Precondition: seconds >= 0.
std::string readable_duration(double seconds);

/// The time since `start`, s.
double seconds_since(std::chrono::steady_clock::time_point start);

/// The present rate of work: the average over about the last 15 seconds.
class RecentRate {
 public:
  using Clock = std::chrono::steady_clock;

  explicit RecentRate(Clock::time_point start) : marks_{{start, 0}}, latest_{start, 0} {}

  /// Records the amount of work that is done by now. Precondition: time and amount are not smaller than at the last
  /// call.
  void add(Clock::time_point now, std::uint64_t done);
  /// The rate in amount of work per second; zero as long as no work is done.
  double per_second() const;

 private:
  struct Mark {
    Clock::time_point time;
    std::uint64_t done;
  };

  /// Amounts of work at some times in the last 15 seconds. The first mark is at the beginning of this period, or the
  /// last one before it.
  std::deque<Mark> marks_;
  Mark latest_;
};

/// What a line of progress shows.
struct ProgressFacts {
  Progress progress;
  double rate = 0.0;        ///< present rate, samples per second; 0 as long as it is not known
  std::size_t stage = 1;    ///< number of the present stage of the study, from 1
  std::size_t design = 0;   ///< number of the present design of a sweep, from 1; 0: the run is not a sweep
  std::size_t designs = 0;  ///< number of designs of the sweep; 0: the run is not a sweep
};

/// A line of progress as text: "43.2 % done, 7.21 M samples/s, 12 not converged (0.0012 %), 1 min 20 s left". In a
/// sweep the line begins with "design 4 of 10: ". The percentage is then that of this design. The time left is that of
/// this and all later designs, if each later design has as many solves as this one.
std::string plain_line(const ProgressFacts& facts);

/// A line of progress with a bar, in at most `width` columns. If there is too little room, the bar becomes shorter, and
/// then parts of the line are left out, the percentage last.
std::string live_line(const ProgressFacts& facts, std::size_t width);

/// The progress of a search for poses as text: "looking for poses: 12 of 100 found, 34000 candidates".
std::string search_line(const PoseSearch& search);

/// The progress of the validation of a sweep as text: "validating designs: 3 of 10 done".
std::string validation_line(std::size_t done, std::size_t designs);

/// A line on stderr that shows progress. On a terminal the line is overwritten, at the terminal's present width. If
/// stderr is not a terminal, a new line is written every few seconds. If `quiet` is set, nothing is written.
class ProgressLine {
 public:
  using Clock = std::chrono::steady_clock;

  explicit ProgressLine(bool quiet);
  ~ProgressLine() { finish(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Returns true if it is time to write the line. The next time is then one interval later.
  bool is_due(Clock::time_point now);
  /// Writes the line. plain: returns the text if lines cannot be overwritten. live: returns the text for a terminal, in
  /// at most as many columns as its argument.
  void write(const std::function<std::string()>& plain, const std::function<std::string(std::size_t)>& live);
  /// Erases the line on a terminal, so that other lines may follow.
  void finish();

 private:
  Clock::duration interval() const;

  bool quiet_;
  bool live_;
  bool open_ = false;
  Clock::time_point next_;
};

/// Shows the progress of solves on stderr.
class ProgressPrinter {
 public:
  explicit ProgressPrinter(bool quiet) : line_(quiet), rate_(RecentRate::Clock::now()) {}

  /// Tells the printer that the next design of a sweep begins. design: number of the design, from 1. designs: number of
  /// all designs.
  void begin_design(std::size_t design, std::size_t designs);
  void operator()(const Progress& progress);

 private:
  ProgressLine line_;
  RecentRate rate_;
  std::uint64_t done_ = 0;
  std::size_t stage_ = 1;
  std::size_t design_ = 0;
  std::size_t designs_ = 0;
};

}  // namespace poesy::app
