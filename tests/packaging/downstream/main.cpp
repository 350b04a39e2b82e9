// Uses poesy as somebody else's program does: a mechanism from the registry, a small study, a look at a file.
#include <cmath>
#include <cstdio>
#include <vector>

#include "engine/base/error.h"
#include "engine/io/result_file.h"
#include "engine/run/runner.h"
#include "engine/study/plan.h"
#include "models/registry.h"

namespace {

poesy::Study small_study(const poesy::CatalogEntry& entry) {
  poesy::Study study;
  study.mechanism.entry = &entry;
  for (const poesy::GeometryParameter& parameter : entry.description.geometry) {
    study.mechanism.geometry.push_back(parameter.published);
  }
  study.poses.count = 2;
  for (std::size_t c = 0; c < entry.description.pose_coordinates.size(); ++c) {
    study.poses.workspace.push_back({entry.description.pose_lower[c], entry.description.pose_upper[c]});
  }
  study.errors.by_factor.assign(entry.description.factors.size(), poesy::Distribution::normal(1e-4));
  study.analysis.factors = entry.description.factor_sets.front().factors;
  study.analysis.samples = 10;
  return study;
}

bool some_index_is_positive(const poesy::SensitivityResult& result) {
  for (const double index : result.global) {
    if (std::isfinite(index) && index > 0.0) return true;
  }
  return false;
}

bool missing_file_is_refused() {
  try {
    poesy::verify_result("no-such-result.h5");
  } catch (const poesy::FileError&) {
    return true;
  }
  return false;
}

}  // namespace

int main() {
  for (const poesy::CatalogEntry& entry : poesy::registry()) {
    const poesy::Study study = small_study(entry);
    const auto model = poesy::build_model(study.mechanism);
    const poesy::Plan plan(study, poesy::select_poses(study.poses, *model).poses);
    const auto result = poesy::run_sensitivity(plan, *model, 0.95, {});
    if (!result || !some_index_is_positive(*result)) {
      std::fprintf(stderr, "%s: no index above zero\n", entry.description.name.c_str());
      return 1;
    }
    std::printf("%s: %zu errors at %zu poses\n", entry.description.name.c_str(), result->factors, result->poses);
  }
  return missing_file_is_refused() ? 0 : 1;
}
