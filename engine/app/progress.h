#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "engine/app/recent_rate.h"
#include "engine/run/runner.h"

namespace poesy::app {

/// Writes progress to stderr: one live line on a terminal, as wide as that is now, a line every few seconds otherwise,
/// nothing when quiet.
class ProgressPrinter {
 public:
  explicit ProgressPrinter(bool quiet);
  ~ProgressPrinter();
  ProgressPrinter(const ProgressPrinter&) = delete;
  ProgressPrinter& operator=(const ProgressPrinter&) = delete;

  void operator()(const Progress& progress);
  /// Takes the live line away, so that other lines may follow.
  void finish();

 private:
  using Clock = RecentRate::Clock;

  Clock::duration interval() const;

  bool quiet_;
  bool live_;
  bool line_open_ = false;
  Clock::time_point next_;
  RecentRate rate_;
  std::uint64_t done_ = 0;
  std::size_t stage_ = 1;
};

}  // namespace poesy::app
