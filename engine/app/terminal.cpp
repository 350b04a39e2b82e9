#include "engine/app/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace poesy::app {
namespace {

/// Empty where it is unset.
std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
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

}  // namespace poesy::app
