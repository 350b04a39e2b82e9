#include "engine/app/ending.h"

#include <csignal>
#include <exception>

#include "engine/app/mpi_ranks.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"

namespace poesy::app {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free flags");

void on_signal(int /*signal*/) {
  interrupted = true;
  std::signal(SIGINT, SIG_DFL);
}

}  // namespace

const std::atomic<bool>& catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  // Of a terminal that was closed; nohup has it ignored.
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  return interrupted;
}

void interrupt() { interrupted = true; }

int complain(const std::string& problem, ExitCode code) {
  if (is_first_process()) say(Message::error, problem);
  return code;
}

int exit_code_of(const std::function<int()>& action) {
  try {
    return action();
  } catch (const InputError& error) {
    return complain(error.what(), kBadInput);
  } catch (const FileError& error) {
    return complain(error.what(), kFileTrouble);
  } catch (const std::exception& error) {
    return complain(std::string("internal error: ") + error.what() + "; please report it", kInternalError);
  }
}

}  // namespace poesy::app
