#include "engine/app/output_width.h"

#include <unistd.h>

#include <cstdlib>

#include "engine/app/terminal.h"
#include "engine/base/units.h"
#include "engine/report/text_table.h"

namespace poesy::app {
std::size_t output_width() {
  if (::isatty(STDOUT_FILENO) == 0) return kUnlimitedWidth;
  if (const std::size_t width = terminal_width(STDOUT_FILENO); width > 0) return width;
  const char* columns = std::getenv("COLUMNS");
  const auto width = columns != nullptr ? parse_number(columns) : std::nullopt;
  return width && *width >= 1.0 && *width < 1e6 ? static_cast<std::size_t>(*width) : kUsualWidth;
}

}  // namespace poesy::app
