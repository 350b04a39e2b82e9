// Uses poesy like a program of a user: writes a small study of each mechanism of the registry to a file, reads and runs
// it, and writes and verifies its result.
#include <cmath>
#include <cstdio>
#include <fstream>

#include "engine/base/error.h"
#include "engine/kinds/result_file.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/study_file.h"
#include "engine/kinds/study_run.h"
#include "engine/result/result_file.h"
#include "engine/study/study_file.h"
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
  study.analysis.kind = &poesy::sensitivity::kStudy;
  study.analysis.factors = entry.description.factor_sets.front().factors;
  study.analysis.samples = 10;
  return study;
}

bool some_index_is_positive(const poesy::sensitivity::Result& result) {
  for (const double index : result.global) {
    if (std::isfinite(index) && index > 0.0) return true;
  }
  return false;
}

/// Runs the study of a file and writes its result. Returns whether the result has an index above zero.
bool run_file(const std::string& path, const std::string& result_path) {
  const poesy::Study study = poesy::read_study(path, poesy::registry(), poesy::StudyUse::run);
  const auto model = poesy::build_model(study.mechanism);
  const poesy::SelectedPoses poses = poesy::select_poses(study.poses, *model);
  const auto result = poesy::run_study(study, *model, poses.poses);
  if (!result) return false;
  poesy::write_result(result_path, study, poses, result->found, {});
  const auto& found = result->as<poesy::sensitivity::Result>();
  std::printf("%s: %zu errors at %zu poses\n", path.c_str(), found.factors(), found.poses());
  return some_index_is_positive(found);
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
    const std::string name = entry.description.name;
    std::ofstream(name + ".toml") << poesy::resolved_text(small_study(entry));
    if (!run_file(name + ".toml", name + ".h5") || !poesy::verify_result(name + ".h5").matches()) {
      std::fprintf(stderr, "%s: no index above zero, or a result that is not the one written\n", name.c_str());
      return 1;
    }
  }
  return missing_file_is_refused() ? 0 : 1;
}
