#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

/// Output of the program to terminals, and how the program ends.
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

/// The number of columns of help, and of a terminal whose width is not known.
inline constexpr std::size_t kUsualWidth = 80;

/// The present width of a terminal in columns. descriptor: file descriptor of the terminal. 0 if it is not a terminal
/// or its width is not known.
std::size_t terminal_width(int descriptor);

/// Returns true if lines that are written to a file descriptor can be overwritten: it is a terminal, and TERM is set
/// and not "dumb".
bool shows_live_lines(int descriptor);

/// The number of characters in a line of stdout: the width of the terminal if it is known, otherwise COLUMNS, otherwise
/// 80. Unlimited if stdout is not a terminal.
std::size_t output_width();

/// Returns true if texts for people may have characters beyond ASCII, because the locale in LC_ALL, LC_CTYPE or LANG
/// has UTF-8.
bool shows_signs();

/// Prints a text on stdout. Control characters except line ends and tabs are replaced (printable_lines()), because the
/// text may quote a file.
void print(const std::string& text);

enum class Message { note, warning, error };

/// Prints one line on stderr: "poesy: TEXT", "poesy: warning: TEXT". The prefix of a warning or an error is coloured on
/// a terminal with live lines, unless NO_COLOR is set (https://no-color.org).
void say(Message kind, const std::string& text);

/// Asks a question on stderr and waits for a line. Returns true if the line begins with "y". Returns none if stdin or
/// stderr is not a terminal, or on an interrupt (catch_interrupts()).
std::optional<bool> asked(const std::string& question);

/// Prints a problem on stderr and returns the exit code. If a launcher started several processes, only the first one
/// prints, because all have the same problem.
int complain(const std::string& problem, ExitCode code);

/// Runs an action and returns its exit code. If it throws, prints the message of the exception on stderr and returns
/// the code for this exception.
int exit_code_of(const std::function<int()>& action);

/// Makes Ctrl-C, SIGTERM and SIGHUP set the returned flag from now on instead of ending the program. A Ctrl-C after any
/// of these signals ends the program as usual. Further SIGTERMs have no effect, because batch systems send several.
const std::atomic<bool>& catch_interrupts();

/// Sets the flag of catch_interrupts() as a signal would.
void interrupt();

}  // namespace poesy::app
