#pragma once

#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/result/result_file.h"
#include "tests/engine/kinds/stored.h"

namespace poesy::sensitivity {

/// A sensitivity result with four errors, one of them without an index, and three responses. The published index and
/// the corrected index rank the errors differently.
inline StoredResult ranked_result() {
  StoredResult result;
  result.kind = "sensitivity";
  result.model = "some model";
  result.study_text = "format = \"poesy-study\"\n\n[run]\nseed = 9223372036854775807\n";
  result.content_sha256 = "abc";
  result.factors = {{"delta_b", "m"}, {"epsilon_a", "rad"}, {"delta_c", "m"}, {"delta_a", "m"}};
  result.factor_sigma = {1e-3, 0.5 * display({"", "rad"}).si, 2e-3, 1e-3};
  result.factor_distribution.assign(4, "normal");
  result.responses = {{"x", "m"}, {"tilt", "rad"}, {"ratio", "1"}};
  result.headline = {0, 1, 2};
  Result& found = sensitivity_in(result);
  found.global_corrected = {{3, 4}, {0.4, 0.1, 0.3, kNaN, 1e-13, 0.7, 0.0, kNaN, 1.0, 1.0, 1.0, kNaN}};
  found.global_corrected_ci_low = {{3, 4}, {0.3, 0.09, 0.2, kNaN, 0.0, 0.6, 0.0, kNaN, 1.0, 1.0, 1.0, kNaN}};
  found.global_corrected_ci_high = {{3, 4}, {0.5, 0.2, 0.35, kNaN, 1e-13, 0.8, 0.0, kNaN, 1.0, 1.0, 1.0, kNaN}};
  found.global = {{3, 4}, {0.6, 0.15, 0.8, kNaN, 1e-13, 0.9, 0.0, kNaN, 1.5, 1.5, 1.5, kNaN}};
  found.global_ci_low = {{3, 4}, {0.5, 0.14, 0.7, kNaN, 0.0, 0.8, 0.0, kNaN, 1.5, 1.5, 1.5, kNaN}};
  found.global_ci_high = {{3, 4}, {0.7, 0.25, 0.85, kNaN, 1e-13, 1.0, 0.0, kNaN, 1.5, 1.5, 1.5, kNaN}};
  found.rounding = {{3}, {1e-15, 1e-15, 0.0}};
  found.index_change = {{3, 4}, {0.0, 0.0, 0.0, kNaN, 0.0, 0.0, 0.0, kNaN, 0.0, 0.0, 0.0, kNaN}};
  found.limb = {{4}, {1, 1, 2, 3}};
  found.mean_square_bound = {{3}, {1.0, 1.0, 1.0}};
  found.solves = Array<SolveCounts, axis::Factor, axis::Pose>({4, 1});
  for (std::size_t p = 0; p < 4; ++p) {
    found.solves(p, 0).by_status[0] = 1000 - p;
    found.solves(p, 0).by_status[2] = p;
  }
  return result;
}

}  // namespace poesy::sensitivity
