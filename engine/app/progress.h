#pragma once

#include <chrono>

#include "engine/run/runner.h"

namespace poesy::app {

/// Writes progress to stderr: one live line on a terminal, a line every few seconds otherwise, nothing when quiet.
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
  using Clock = std::chrono::steady_clock;

  bool quiet_;
  bool terminal_;
  bool line_open_ = false;
  Clock::time_point start_;
  Clock::time_point next_;
};

}  // namespace poesy::app
