#include "engine/study/mechanism_doubts.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "engine/base/units.h"
#include "engine/study/calibration.h"
#include "engine/study/poses/unusual_workspace.h"

namespace poesy {
namespace {

/// A value is far from another one if it is more than this many times larger or smaller.
constexpr double kFar = 10.0;

bool is_far(double value, double own) {
  if (value == 0.0 || own == 0.0) return false;
  const double ratio = value / own;
  return ratio < 1.0 / kFar || ratio > kFar;  // also if the signs differ
}

}  // namespace

std::string asked_back(std::string_view clause) { return fmt::format("{}; is that meant?", clause); }

std::vector<std::string> geometry_doubts(const MechanismChoice& mechanism) {
  std::vector<std::string> list;
  const std::vector<GeometryParameter>& parameters = mechanism.entry->description.geometry;
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const double value = mechanism.geometry[p];
    if (!is_far(value, parameters[p].published)) continue;
    const auto text = [&](double si) { return readable_text({si, parameters[p].dimension}); };
    list.push_back(asked_back(fmt::format("{} = {}; {} {}", parameters[p].name, text(value),
                                          mechanism.file ? "the mechanism's file has" : "the published value is",
                                          text(parameters[p].published))));
  }
  return list;
}

std::vector<std::string> mechanism_doubts(const MechanismChoice& mechanism, const Model& model) {
  std::vector<std::string> list = geometry_doubts(mechanism);
  for (const std::string& unusual : model.unusual_geometry()) list.push_back(asked_back(unusual));
  return list;
}

std::vector<std::string> workspace_doubts(const Study& study, const PoseSet& poses) {
  std::vector<std::string> list;
  const auto add = [&](std::string_view table, const PoseSelection& selection, const PoseSet& selected) {
    const std::string clause = unusual_workspace(selection, selected, study.model());
    if (!clause.empty()) list.push_back(asked_back(fmt::format("[{}] workspace: {}", table, clause)));
  };
  add("poses", study.poses, poses);
  if (!study.analysis.calibration) return list;
  const CalibrationTable& calibration = *study.analysis.calibration;
  if (calibration.poses) add("analysis.calibration.poses", *calibration.poses, {});
  if (calibration.candidates) add("analysis.calibration.candidates", *calibration.candidates, {});
  return list;
}

}  // namespace poesy
