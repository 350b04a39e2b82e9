#include "engine/study/study.h"

#include <stdexcept>

#include "engine/base/contract.h"
#include "engine/base/units.h"

namespace poesy {

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
      return "monte-carlo";
    case Analysis::Kind::coupling:
      break;
  }
  return "coupling";
}

std::string_view name(Judge judge) {
  switch (judge) {
    case Judge::rms:
      return "rms";
    case Judge::share:
      break;
  }
  return "share";
}

std::string_view name(NotConverged policy) {
  switch (policy) {
    case NotConverged::exclude:
      return "exclude";
    case NotConverged::include:
      break;
  }
  return "include";
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

std::vector<double> standard_deviations(const Study& study) {
  std::vector<double> sigma;
  for (const FactorIndex factor : study.analysis.factors) {
    sigma.push_back(study.errors.by_factor[factor.value].standard_deviation());
  }
  return sigma;
}

MechanismChoice at_compared_fidelity(MechanismChoice mechanism) {
  POESY_EXPECTS(mechanism.compared.has_value());
  mechanism.fidelity = *mechanism.compared;
  mechanism.compared.reset();
  return mechanism;
}

std::unique_ptr<Model> build_model(const MechanismChoice& mechanism) {
  const CatalogEntry& entry = *mechanism.entry;
  std::unique_ptr<Model> model;  // first without the study's points, so that each message names the right key
  try {
    model = entry.build(mechanism.geometry, mechanism.fidelity);
  } catch (const std::invalid_argument& reason) {
    throw InputError(mechanism.place, std::string("impossible geometry: ") + reason.what(),
                     "correct it, or leave it out to keep the published value");
  }
  if (mechanism.points.empty()) return model;
  try {
    return entry.build_with_points(mechanism.geometry, mechanism.fidelity, mechanism.points);
  } catch (const std::invalid_argument& reason) {
    throw InputError(
        mechanism.points_place, reason.what(),
        "name points around the platform, such as its joints' centres, or leave the key out to take these");
  }
}

}  // namespace poesy
