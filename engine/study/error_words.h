#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy {

/// Where an error of this size (SI, its sign does not matter) makes no sense, a clause that says so: "gives a_x_1 an
/// error of 300 mm, no less than the radius of the base (250 mm)"; `what` is "an error".
std::optional<std::string> beyond_bound(const Model& model, FactorIndex factor, double size, std::string_view what);

/// Which errors the study's background holds, at which size, on one line: "held constant: 30 errors of set 'benign' at
/// 1 mm and 1 deg". Empty where it holds none. Errors that vary are not held, nor are those whose size is zero.
std::string held_errors_text(const Study& study);

}  // namespace poesy
