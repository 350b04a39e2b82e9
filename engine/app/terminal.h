#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

/// Output of the program, and how it ends.
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

/// The columns of a page of help, and of a terminal whose width is unknown.
inline constexpr std::size_t kUsualWidth = 80;

/// The present width of the terminal behind a file descriptor; 0 if it is not a terminal or its width is unknown.
std::size_t terminal_width(int descriptor);

/// Whether lines there can be overwritten: it is a terminal, and TERM is set and not "dumb".
bool shows_live_lines(int descriptor);

/// The number of characters in a line of stdout: the width of a terminal if known, else COLUMNS, else 80. Unlimited if
/// stdout is not a terminal.
std::size_t output_width();

/// Whether texts for people may have signs beyond ASCII: the locale of LC_ALL, LC_CTYPE or LANG has UTF-8.
bool shows_signs();

/// Prints on stdout. Control characters except line ends and tabs are replaced, because the text may quote a file
/// (printable_lines).
void print(const std::string& text);

enum class Message { note, warning, error };

/// Prints one line on stderr: "poesy: TEXT", "poesy: warning: TEXT". The prefix of a warning or error is coloured on a
/// terminal that shows live lines, unless NO_COLOR is set (https://no-color.org).
void say(Message kind, const std::string& text);

/// Asks a question on stderr and waits for a line; true if it begins with "y". None if stdin or stderr is not a
/// terminal, or on an interrupt (catch_interrupts).
std::optional<bool> asked(const std::string& question);

/// Prints the problem on stderr and returns the code. Under a launcher only the first process prints, because all
/// processes have the same problem.
int complain(const std::string& problem, ExitCode code);

/// Runs the action and returns its exit code, or that of an exception, whose message is printed on stderr.
int exit_code_of(const std::function<int()>& action);

/// Afterwards, Ctrl-C, SIGTERM and SIGHUP set the returned flag instead of ending the program. A Ctrl-C after any of
/// them ends it as usual. Further SIGTERMs have no effect, because batch systems send it several times.
const std::atomic<bool>& catch_interrupts();

/// Sets the flag of catch_interrupts().
void interrupt();

}  // namespace poesy::app
