#pragma once

#include <limits>

#include "engine/files/result_file.h"
#include "engine/kinds/sensitivity/result.h"
#include "tests/engine/kinds/stored.h"

namespace poesy {

/// A sensitivity result of four errors, one of which has no index, and two responses.
inline StoredResult ranked_result() {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  StoredResult result;
  result.kind = "sensitivity";
  result.model = "some model";
  result.study_text = "format = \"poesy-study\"\n\n[run]\nseed = 18446744073709551615\n";
  result.content_sha256 = "abc";
  result.factors = {{"delta_b", "m"}, {"epsilon_a", "rad"}, {"delta_c", "m"}, {"delta_a", "m"}};
  result.factor_sigma = {1e-3, 0.5 * display({"", "rad"}).si, 2e-3, 1e-3};
  result.responses = {{"x", "m"}, {"tilt", "rad"}, {"ratio", "1"}};
  result.headline = {0, 1, 2};
  SensitivityResult& found = sensitivity_in(result);
  found.responses = 3;
  found.factors = 4;
  found.poses = 1;
  found.global = {0.4, 0.1, 0.3, kNaN, 1e-13, 0.7, 0.0, kNaN, 1.0, 1.0, 1.0, kNaN};
  found.global_ci_low = {0.3, 0.09, 0.2, kNaN, 0.0, 0.6, 0.0, kNaN, 1.0, 1.0, 1.0, kNaN};
  found.global_ci_high = {0.5, 0.2, 0.35, kNaN, 1e-13, 0.8, 0.0, kNaN, 1.0, 1.0, 1.0, kNaN};
  found.solves.resize(4);
  for (std::size_t p = 0; p < 4; ++p) {
    found.solves[p].by_status[0] = 1000 - p;
    found.solves[p].by_status[2] = p;
  }
  return result;
}

}  // namespace poesy
