#pragma once

#include <string>
#include <string_view>

namespace poesy {

/// A line of a resolved study with the quantities in quotes as readable_text(): 'z = "0.00015 m"' is 'z = "0.15 mm"'.
std::string with_readable_quantities(std::string_view line);

}  // namespace poesy
