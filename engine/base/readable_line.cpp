#include "engine/base/readable_line.h"

#include <algorithm>
#include <cstddef>

#include "engine/base/units.h"

namespace poesy {

std::string with_readable_quantities(std::string_view line) {
  std::string text;
  for (std::size_t from = 0; from < line.size();) {
    const std::size_t open = std::min(line.find('"', from), line.size());
    const std::size_t close = line.find('"', open + 1);
    text += line.substr(from, open - from);
    if (close == std::string_view::npos) return text.append(line.substr(open));
    const std::string_view quoted = line.substr(open + 1, close - open - 1);
    try {
      text += "\"" + readable_text(parse_quantity(quoted)) + "\"";
    } catch (const QuantityError&) {
      text.append(line.substr(open, close + 1 - open));
    }
    from = close + 1;
  }
  return text;
}

std::pair<std::string, std::string> with_readable_quantities(std::pair<std::string, std::string> lines) {
  std::pair<std::string, std::string> readable{with_readable_quantities(lines.first),
                                               with_readable_quantities(lines.second)};
  return readable.first == readable.second ? lines : readable;
}

}  // namespace poesy
