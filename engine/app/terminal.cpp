#include "engine/app/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "engine/base/units.h"
#include "engine/report/table.h"

namespace poesy::app {
namespace {

/// Empty where it is unset.
std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

constexpr const char* kRed = "\033[1;31m";
constexpr const char* kYellow = "\033[1;33m";
constexpr const char* kPlain = "\033[0m";

std::string beginning(Message kind) {
  const std::string words = kind == Message::warning ? "poesy: warning:" : "poesy:";
  if (kind == Message::note || !shows_colour(STDERR_FILENO)) return words;
  return (kind == Message::warning ? kYellow : kRed) + words + kPlain;
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

bool shows_colour(int descriptor) { return shows_live_lines(descriptor) && variable("NO_COLOR").empty(); }

std::size_t output_width() {
  if (::isatty(STDOUT_FILENO) == 0) return kUnlimitedWidth;
  if (const std::size_t width = terminal_width(STDOUT_FILENO); width > 0) return width;
  const char* columns = std::getenv("COLUMNS");
  const auto width = columns != nullptr ? parse_number(columns) : std::nullopt;
  return width && *width >= 1.0 && *width < 1e6 ? static_cast<std::size_t>(*width) : kUsualWidth;
}

void say(Message kind, const std::string& text) { std::fputs((beginning(kind) + " " + text + "\n").c_str(), stderr); }

}  // namespace poesy::app
