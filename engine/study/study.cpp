#include "engine/study/study.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/units.h"
#include "engine/random/low_discrepancy.h"

namespace poesy {
namespace {

PoseSet interior_poses(const PoseSelection& selection) {
  const std::size_t coordinates = selection.workspace.size();
  std::vector<double> values = sobol_points(selection.count, coordinates);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Range& range = selection.workspace[k % coordinates];
    values[k] = std::lerp(range.lower, range.upper, values[k]);
  }
  return PoseSet(coordinates, std::move(values));
}

std::string described(std::span<const double> pose, const ModelDescription& model) {
  std::string text;
  for (std::size_t c = 0; c < pose.size(); ++c) {
    if (c > 0) text += ", ";
    text += model.pose_coordinates[c].name + " = " + to_text({pose[c], model.pose_coordinates[c].dimension});
  }
  return text;
}

[[noreturn]] void refuse(const PoseSelection& selection, PoseIndex pose, const std::string& values,
                         const std::string& reason) {
  const std::string problem = "pose " + std::to_string(pose.value + 1) + " (" + values + ") is out of reach: " + reason;
  if (selection.select != PoseSelection::Select::file) {
    throw InputError(selection.place, problem, "make the workspace smaller");
  }
  Place line = selection.place;
  line.line += pose.value;
  throw InputError(line, problem, "correct or remove this pose");
}

}  // namespace

std::string_view name(PoseSelection::Select select) {
  switch (select) {
    case PoseSelection::Select::interior:
      return "interior";
    case PoseSelection::Select::file:
      return "file";
    case PoseSelection::Select::boundary:
      return "boundary";
    case PoseSelection::Select::grid:
      return "grid";
    case PoseSelection::Select::trajectory:
      break;
  }
  return "trajectory";
}

std::string_view name(Analysis::Kind kind) {
  switch (kind) {
    case Analysis::Kind::sensitivity:
      return "sensitivity";
    case Analysis::Kind::identification:
      return "identification";
    case Analysis::Kind::evaluate:
      return "evaluate";
    case Analysis::Kind::monte_carlo:
      break;
  }
  return "monte-carlo";
}

std::string_view name(NotConverged policy) {
  switch (policy) {
    case NotConverged::exclude:
      return "exclude";
    case NotConverged::include:
      return "include";
    case NotConverged::fail:
      break;
  }
  return "fail";
}

std::string_view name(SolverOptions::Method method) {
  switch (method) {
    case SolverOptions::Method::newton:
      return "newton";
    case SolverOptions::Method::gauss_newton:
      break;
  }
  return "gauss-newton";
}

std::vector<double> background_errors(const std::optional<Background>& background, const ModelDescription& model) {
  std::vector<double> errors(model.factors.size(), 0.0);
  if (!background) return errors;
  for (const FactorIndex factor : background->factors) {
    const bool is_length = model.factors[factor.value].dimension == Dimension::length;
    errors[factor.value] = is_length ? background->linear : background->angular;
  }
  return errors;
}

std::unique_ptr<Model> build_model(const MechanismChoice& mechanism) {
  try {
    return mechanism.entry->build(mechanism.geometry);
  } catch (const std::invalid_argument& reason) {
    throw InputError(mechanism.place, std::string("impossible geometry: ") + reason.what(),
                     "correct it, or leave it out to keep the published value");
  }
}

PoseSet select_poses(const PoseSelection& selection, const Model& model) {
  POESY_EXPECTS(selection.select == PoseSelection::Select::interior || selection.select == PoseSelection::Select::file);
  PoseSet poses = selection.select == PoseSelection::Select::file ? selection.from_file : interior_poses(selection);
  for (std::size_t m = 0; m < poses.size(); ++m) {
    const PoseIndex pose(m);
    if (const auto reason = model.unreachable(poses[pose])) {
      refuse(selection, pose, described(poses[pose], model.description()), *reason);
    }
  }
  return poses;
}

}  // namespace poesy
