#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

/// Output of the program on terminals, and exit codes.
namespace poesy::app {

/// The exit codes, which scripts may rely on.
enum ExitCode : int {
  kDone = 0,
  kInternalError = 1,
  kBadInput = 2,
  kFileTrouble = 3,
  kInterrupted = 4,
  kTooManyNotConverged = 5,
  kLimitNotKept = 6
};

/// The number of columns that output uses if the width of the terminal is not known.
inline constexpr std::size_t kUsualWidth = 80;

/// The present width of a terminal in columns. descriptor: file descriptor of the terminal. Returns 0 if the descriptor
/// is not that of a terminal, or if the width is not known.
std::size_t terminal_width(int descriptor);

/// Returns true if lines written to a file descriptor can be overwritten: the descriptor is that of a terminal, and
/// TERM is set and not "dumb".
bool shows_live_lines(int descriptor);

/// The number of characters in a line of stdout: the width of the terminal, or if it is not known the value of COLUMNS,
/// or 80. Unlimited if stdout is not a terminal.
std::size_t output_width();

/// Returns true if texts for people may have characters beyond ASCII, because the locale (LC_ALL, LC_CTYPE or LANG) is
/// for UTF-8.
bool shows_signs();

/// Prints a text on stdout. Control characters other than line ends and tabs are replaced (printable_lines()), because
/// the text may quote a file.
void print(const std::string& text);

enum class Message { note, warning, error };

/// Prints one line on stderr: "poesy: TEXT", "poesy: warning: TEXT". On a terminal where lines can be overwritten, the
/// prefix of a warning or an error is coloured, unless NO_COLOR is set (https://no-color.org).
void say(Message kind, const std::string& text);

/// Asks a question on stderr and waits for a line. Returns true if the answer begins with "y", false for other answers,
/// and none if stdin or stderr is not a terminal or after an interrupt (catch_interrupts()).
std::optional<bool> asked(const std::string& question);

/// Prints a problem on stderr and returns the exit code. If a launcher started several processes, only the first one
/// prints, because all have the same problem.
int complain(const std::string& problem, ExitCode code);

/// Runs an action and returns its exit code. If the action throws, prints the message of the exception on stderr and
/// returns the code for this exception.
int exit_code_of(const std::function<int()>& action);

/// Makes Ctrl-C, SIGTERM and SIGHUP set the returned flag instead of ending the program. A Ctrl-C after any of these
/// signals ends the program as usual. Further SIGTERMs have no effect, because batch systems send several.
const std::atomic<bool>& catch_interrupts();

/// Sets the flag of catch_interrupts() as a signal would.
void interrupt();

}  // namespace poesy::app
