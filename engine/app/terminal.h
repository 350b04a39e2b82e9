#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

/// What the program prints and says, and how it ends.
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

/// Columns of a terminal that does not say, and of a page of help.
inline constexpr std::size_t kUsualWidth = 80;

/// Columns of the terminal behind a file descriptor, now; 0 when it is none, or does not say.
std::size_t terminal_width(int descriptor);

/// Whether a line there can be written over: a terminal, and not one that TERM calls "dumb" or says nothing of.
bool shows_live_lines(int descriptor);

/// Characters that a line of stdout has room for: of a terminal what it says, else what COLUMNS says, else 80. What is
/// no terminal has room for any line.
std::size_t output_width();

/// Text on stdout, without control characters but line ends and tabs: it may quote a file (printable_lines).
void print(const std::string& text);

enum class Message { note, warning, error };

/// One line on stderr, as print(): "poesy: TEXT", "poesy: warning: TEXT". What is before the text of a warning or error
/// is coloured where stderr is a terminal that shows live lines, unless NO_COLOR is set (https://no-color.org).
void say(Message kind, const std::string& text);

/// Asks on stderr, where stdin and stderr are a terminal, and waits for a line that begins with "y", or another one.
/// None where there is no terminal, or on an interrupt (catch_interrupts).
std::optional<bool> asked(const std::string& question);

/// Says what is wrong on stderr; the code. Under a launcher the first process alone speaks, because all have the same
/// to say.
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
