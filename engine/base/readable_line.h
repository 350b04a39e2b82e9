#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace poesy {

/// A line of a resolved study with the quantities in quotes as readable_text(): 'z = "0.00015 m"' is 'z = "0.15 mm"'.
std::string with_readable_quantities(std::string_view line);

/// Two different lines with_readable_quantities(), or as they are if they would then be equal, because readable numbers
/// are rounded.
std::pair<std::string, std::string> with_readable_quantities(std::pair<std::string, std::string> lines);

}  // namespace poesy
