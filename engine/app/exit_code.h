#pragma once

namespace poesy::app {

/// Exit codes, as promised to scripts.
enum ExitCode : int {
  kDone = 0,
  kInternalError = 1,
  kBadInput = 2,
  kFileTrouble = 3,
  kInterrupted = 4,
  kTooManyNotConverged = 5,
  kLimitNotKept = 6
};

}  // namespace poesy::app
