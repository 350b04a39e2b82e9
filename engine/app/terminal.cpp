#include "engine/app/terminal.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "engine/app/mpi_ranks.h"
#include "engine/base/error.h"
#include "engine/base/printable_lines.h"
#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/report/table.h"

namespace poesy::app {
namespace {

/// The value of an environment variable; empty if it is not set.
std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::string beginning(Message kind) {
  constexpr const char* kRed = "\033[1;31m";
  constexpr const char* kYellow = "\033[1;33m";
  const std::string words = kind == Message::warning ? "poesy: warning:" : "poesy:";
  const bool coloured = shows_live_lines(STDERR_FILENO) && variable("NO_COLOR").empty();
  if (kind == Message::note || !coloured) return words;
  return (kind == Message::warning ? kYellow : kRed) + words + "\033[0m";
}

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free flags");

void on_signal(int /*signal*/) {
  interrupted = true;
  std::signal(SIGINT, SIG_DFL);
}

}  // namespace

std::size_t terminal_width(int descriptor) {
  winsize size{};
  return ioctl(descriptor, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

bool shows_live_lines(int descriptor) {
  const std::string_view term = variable("TERM");
  return isatty(descriptor) != 0 && !term.empty() && term != "dumb";
}

std::size_t output_width() {
  if (::isatty(STDOUT_FILENO) == 0) return kUnlimitedWidth;
  if (const std::size_t width = terminal_width(STDOUT_FILENO); width > 0) return width;
  const char* columns = std::getenv("COLUMNS");
  const auto width = columns != nullptr ? parse_number(columns) : std::nullopt;
  return width && *width >= 1.0 && *width < 1e6 ? static_cast<std::size_t>(*width) : kUsualWidth;
}

bool shows_signs() {
  for (const char* variable : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* value = std::getenv(variable);
    if (value == nullptr || *value == '\0') continue;
    std::string locale(value);
    std::ranges::transform(locale, locale.begin(), [](unsigned char c) { return std::tolower(c); });
    return locale.find("utf-8") != std::string::npos || locale.find("utf8") != std::string::npos;
  }
  return false;
}

void print(const std::string& text) { std::fputs(printable_lines(text).c_str(), stdout); }

void say(Message kind, const std::string& text) {
  std::fputs((beginning(kind) + " " + printable_line(text) + "\n").c_str(), stderr);
}

std::optional<bool> asked(const std::string& question) {
  constexpr int kLook = 100;  // ms between checks for an interrupt
  if (isatty(STDIN_FILENO) == 0 || isatty(STDERR_FILENO) == 0) return std::nullopt;
  std::fputs(("poesy: " + printable_line(question) + " [y/N] ").c_str(), stderr);
  std::fflush(stderr);
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  while (!interrupted) {
    if (::poll(&input, 1, kLook) <= 0) continue;
    char first = '\n';
    if (::read(STDIN_FILENO, &first, 1) < 1) return false;
    tcflush(STDIN_FILENO, TCIFLUSH);  // discards the remaining input of the line
    return first == 'y' || first == 'Y';
  }
  std::fputs("\n", stderr);
  return std::nullopt;
}

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
  } catch (const std::bad_alloc&) {
    return complain(kTooLittleMemory, kFileTrouble);
  } catch (const std::exception& error) {
    return complain(std::string("internal error: ") + error.what() + "; please report it", kInternalError);
  }
}

const std::atomic<bool>& catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  // A terminal that is closed sends SIGHUP. If nohup made the program ignore SIGHUP, it stays ignored.
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  return interrupted;
}

void interrupt() { interrupted = true; }

}  // namespace poesy::app
