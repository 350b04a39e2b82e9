#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/units.h"
#include "engine/study/study.h"

namespace poesy {

/// The word for the comparison of a model's two fidelities.
inline constexpr std::string_view kBothFidelities = "both";

/// A TOML string: in quotes, with what needs it escaped.
std::string in_quotes(std::string_view text);

/// A value of this dimension as a study file has it, exact when read back: "0.001 m" in quotes, or a bare number.
std::string exact_value(double si, Dimension dimension);

/// The same in the unit in which people read it, where that is as exact and shorter: "60 mm" rather than "0.06 m".
std::string readable_value(double si, Dimension dimension);

/// A range as a TOML list, with one of the functions above for its ends.
std::string range_text(const Range& range, Dimension dimension, std::string (*value)(double si, Dimension dimension));

/// Points as a TOML list of lists, with one of the functions above for their coordinates.
std::string points_text(std::span<const PlatformPoint> points, std::string (*value)(double si, Dimension dimension));

/// The workspace of a study as a TOML inline table, with one of the functions above for its numbers.
std::string workspace_text(std::span<const Range> workspace, const ModelDescription& model,
                           std::string (*value)(double si, Dimension dimension));

/// The name of the factor set that these are, or "all"; empty when they are no set.
std::string set_name(std::span<const FactorIndex> factors, const ModelDescription& model);

}  // namespace poesy
