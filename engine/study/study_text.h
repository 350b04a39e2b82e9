#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/schema/keys.h"
#include "engine/study/study.h"

namespace poesy {

/// The word for the comparison of a model's two fidelities.
inline constexpr std::string_view kBothFidelities = "both";

/// exact_value or readable_value.
using ValueText = std::string (*)(double si, Dimension dimension);

/// A range as a TOML list, with one of these functions for its ends.
std::string range_text(const Range& range, Dimension dimension, ValueText value);

/// Points as a TOML list of lists, likewise.
std::string points_text(std::span<const PlatformPoint> points, ValueText value);

/// The workspace of a study as a TOML inline table, likewise.
std::string workspace_text(std::span<const Range> workspace, const ModelDescription& model, ValueText value);

/// The name of the factor set that these are, or "all"; empty when they are no set.
std::string set_name(std::span<const FactorIndex> factors, const ModelDescription& model);

/// The name of their set in quotes, or the factors as a TOML list of names.
std::string factors_text(std::span<const FactorIndex> factors, const ModelDescription& model);

}  // namespace poesy
