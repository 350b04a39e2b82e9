#pragma once

#include <optional>
#include <string_view>

namespace poesy {

/// The size of a unit of shares: "%", "ppm", or two units of one dimension, "um/m". None for any other text.
std::optional<double> ratio_unit(std::string_view spelling);

/// Reads a share with its unit: "0.1 %", "50 um/m". None for any other text, and for a number that is not finite.
std::optional<double> parse_ratio(std::string_view text);

}  // namespace poesy
