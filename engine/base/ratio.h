#pragma once

#include <optional>
#include <string_view>

namespace poesy {

/// The value of a unit for ratios: 0.01 for "%", 1e-6 for "ppm", and the quotient for two units of one dimension, such
/// as 1e-6 for "um/m". None for any other text.
std::optional<double> ratio_unit(std::string_view spelling);

/// Reads a ratio with its unit, such as "0.1 %" or "50 um/m". None for any other text, and for a number that is not
/// finite.
std::optional<double> parse_ratio(std::string_view text);

}  // namespace poesy
