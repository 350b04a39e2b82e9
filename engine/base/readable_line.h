#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace poesy {

/// A line of a study's resolved_text() with the readable_text() of each quantity in quotes: 'z = "0.00015 m"' becomes
/// 'z = "0.15 mm"'.
std::string with_readable_quantities(std::string_view line);

/// Applies with_readable_quantities() to two different lines. If rounding would make them equal, returns them
/// unchanged.
std::pair<std::string, std::string> with_readable_quantities(std::pair<std::string, std::string> lines);

}  // namespace poesy
