#pragma once

#include <atomic>
#include <functional>
#include <string>

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

/// Says what is wrong on stderr; the code. Under a launcher the first process alone speaks, for all have the same to
/// say.
int complain(const std::string& problem, ExitCode code);

/// The action's exit code; that of what it throws, which is said on stderr.
int exit_code_of(const std::function<int()>& action);

/// From now on Ctrl-C, SIGTERM and SIGHUP set the returned flag instead of ending the program at once. Ctrl-C after
/// either ends it as usual; SIGTERM, which batch systems send to a process by several ways, may come any number of
/// times.
const std::atomic<bool>& catch_interrupts();

/// Sets the flag.
void interrupt();

}  // namespace poesy::app
