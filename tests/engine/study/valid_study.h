#pragma once

#include <string_view>

namespace poesy::test {

/// A study of the fake mechanism that uses every section.
inline constexpr std::string_view kValidStudy = R"(format = "poesy-study"
version = 1
title = "A study"

[mechanism]
model = "fake"
geometry = { arm = "60 mm" }

[poses]
select = "interior"
count = 20
workspace = { z = ["-300 mm", "-0.18 m"], beta = ["-0.5 rad", "0.5 rad"], gamma = ["-10 deg", "10 deg"] }

[errors]
linear = { distribution = "normal", sigma = "1 mm" }
angular = { distribution = "uniform", half_width = "0.5 deg" }
override = { delta_2 = { distribution = "truncated-normal", sigma = "1 mm", half_width = "2 mm" } }

[analysis]
kind = "sensitivity"
factors = ["epsilon_1", "delta_1"]
samples = 100
conf_level = 0.9
background = { factors = "benign", linear = "1 mm", angular = "1 deg" }

[solver]
method = "gauss-newton"
tolerance = 1e-14
max_iterations = 30
not_converged = "include"

[run]
seed = 5
)";

}  // namespace poesy::test
