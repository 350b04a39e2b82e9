#include "engine/study/study.h"

#include <stdexcept>

#include "engine/base/contract.h"
#include "engine/base/units.h"

namespace poesy {

namespace {

/// In the order of the enumerations.
/// @{
constexpr std::array<std::string_view, 5> kSelectNames{"interior", "file", "boundary", "grid", "trajectory"};
constexpr std::array<std::string_view, 2> kJudgeNames{"rms", "share"};
constexpr std::array<std::string_view, 2> kNotConvergedNames{"exclude", "include"};
constexpr std::array<std::string_view, 2> kMethodNames{"newton", "gauss-newton"};
/// @}

template <class Enum, std::size_t kCount>
std::string_view name_among(const std::array<std::string_view, kCount>& names, Enum value) {
  return names.at(static_cast<std::size_t>(value));
}

}  // namespace

std::string_view name(PoseSelection::Select select) { return name_among(kSelectNames, select); }
std::string_view name(Judge judge) { return name_among(kJudgeNames, judge); }
std::string_view name(NotConverged policy) { return name_among(kNotConvergedNames, policy); }
std::string_view name(SolverOptions::Method method) { return name_among(kMethodNames, method); }

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
  if (mechanism.points.empty()) {
    try {
      return entry.build(mechanism.geometry, mechanism.fidelity);
    } catch (const std::invalid_argument& reason) {
      throw InputError(mechanism.place, std::string("impossible geometry: ") + reason.what(),
                       "correct it, or leave it out to keep the published value");
    }
  }
  try {
    return entry.build_with_points(mechanism.geometry, mechanism.fidelity, mechanism.points);
  } catch (const std::invalid_argument& reason) {
    MechanismChoice without_points = mechanism;
    without_points.points.clear();
    static_cast<void>(build_model(without_points));  // throws where the geometry is impossible by itself
    throw InputError(
        mechanism.points_place, reason.what(),
        "name points around the platform, such as its joints' centres, or leave the key out to take these");
  }
}

}  // namespace poesy
