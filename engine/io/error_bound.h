#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/model/model.h"

namespace poesy {

/// Where an error of this size (SI, its sign does not matter) makes no sense, a clause that says so: "gives a_x_1 an
/// error of 300 mm, no less than the radius of the base (250 mm)"; `what` is "an error".
std::optional<std::string> beyond_bound(const Model& model, FactorIndex factor, double size, std::string_view what);

}  // namespace poesy
