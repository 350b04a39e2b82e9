#include "engine/study/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "engine/model/calibrated.h"
#include "engine/study/calibration.h"
#include "engine/study/mechanism_doubts.h"
#include "engine/study/study_kind.h"

namespace poesy {

namespace {

/// The words for values of enumerations in a study file, in the order of the enumerations.
/// @{
constexpr std::array<std::string_view, 5> kSelectNames{"interior", "file", "boundary", "grid", "trajectory"};
constexpr std::array<std::string_view, 2> kDrawsNames{"per pose", "per machine"};
constexpr std::array<std::string_view, 3> kJudgeNames{"rms", "share", "yield"};
constexpr std::array<std::string_view, 2> kNotConvergedNames{"exclude", "include"};
constexpr std::array<std::string_view, 2> kMethodNames{"newton", "gauss-newton"};
/// @}

template <class Enum, std::size_t kCount>
std::string_view name_among(const std::array<std::string_view, kCount>& names, Enum value) {
  return names.at(static_cast<std::size_t>(value));
}

/// The errors of the background that the study does not vary and that are not zero. Precondition: the study has a
/// background.
std::vector<FactorIndex> held_errors(const Study& study) {
  const std::vector<double> errors = background_errors(study.analysis.background, study.model());
  std::vector<FactorIndex> held;
  for (const FactorIndex factor : study.analysis.background->factors) {
    const bool varies = std::ranges::find(study.analysis.factors, factor) != study.analysis.factors.end();
    if (!varies && errors[factor.value] != 0.0) held.push_back(factor);
  }
  return held;
}

/// The constant errors `held` in words: "30 errors of set 'benign'", "2 of the 30 errors of set 'benign'", "delta_1 and
/// delta_2", "12 errors".
std::string owners_text(const std::vector<FactorIndex>& held, const Study& study) {
  const std::vector<FactorIndex>& named = study.analysis.background->factors;
  const std::string all = held.size() == named.size() ? "" : fmt::format("{} of the ", held.size());
  if (const std::string set = set_name(named, study.model()); !set.empty()) {
    return fmt::format("{}{} {} of set '{}'", all, named.size(), named.size() == 1 ? "error" : "errors", set);
  }
  constexpr std::size_t kMostNames = 3;
  if (held.size() > kMostNames) return fmt::format("{} errors", held.size());
  std::vector<std::string> names;
  for (const FactorIndex factor : held) names.push_back(study.model().factors[factor.value].name);
  return fmt::format("{}", fmt::join(names, " and "));
}

/// The sizes of the constant errors in words, one for each dimension that these errors have: "1 mm and 1 deg".
std::string sizes_text(const std::vector<FactorIndex>& held, const Study& study) {
  const Background& background = *study.analysis.background;
  std::vector<std::string> sizes;
  for (const Dimension dimension : kErrorDimensions) {
    const auto has_it = [&](FactorIndex factor) { return study.model().factors[factor.value].dimension == dimension; };
    if (std::ranges::any_of(held, has_it)) sizes.push_back(readable_text({background.of(dimension), dimension}, 6));
  }
  return fmt::format("{}", fmt::join(sizes, " and "));
}

}  // namespace

std::string_view name(PoseSelection::Select select) { return name_among(kSelectNames, select); }
std::string_view name(Draws draws) { return name_among(kDrawsNames, draws); }
std::string_view name(Judge judge) { return name_among(kJudgeNames, judge); }
std::string_view name(NotConverged policy) { return name_among(kNotConvergedNames, policy); }
std::string_view name(SolverOptions::Method method) { return name_among(kMethodNames, method); }

bool ErrorModel::is_per_pose(FactorIndex factor) const { return std::ranges::binary_search(per_pose, factor); }

std::vector<double> background_errors(const std::optional<Background>& background, const ModelDescription& model) {
  std::vector<double> errors(model.factors.size(), 0.0);
  if (!background) return errors;
  for (const FactorIndex factor : background->factors) {
    errors[factor.value] = background->of(model.factors[factor.value].dimension);
  }
  return errors;
}

std::vector<ValueLimit> limits_by_response(std::span<const ResponseLimit> limits, std::size_t responses) {
  std::vector<ValueLimit> list(responses);
  for (const ResponseLimit& limit : limits) list[limit.response] = limit.allowed;
  return list;
}

bool any_over_poses(std::span<const ResponseLimit> limits) {
  return std::ranges::any_of(limits, [](const ResponseLimit& limit) { return limit.allowed.is_over_poses(); });
}

double error_size(const Distribution& distribution) {
  if (std::isfinite(distribution.half_width())) return distribution.largest();
  return distribution.standard_deviation() + std::abs(distribution.centre());
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

namespace {

/// Builds the mechanism without the study's points. If the mechanism's file does not allow the geometry, the message
/// begins with what is doubtful in the study's geometry (geometry_doubts()), because that may be the mistake.
std::unique_ptr<Model> build_without_points(const MechanismChoice& mechanism) {
  try {
    return mechanism.entry->build(mechanism.geometry, mechanism.fidelity);
  } catch (const std::invalid_argument& reason) {
    throw InputError(mechanism.place, std::string("impossible geometry: ") + reason.what(),
                     "correct it, or leave it out to keep the published value");
  } catch (const InputError& reason) {
    const std::vector<std::string> doubts = geometry_doubts(mechanism);
    if (doubts.empty()) throw;
    throw InputError(mechanism.place, fmt::format("{}", fmt::join(doubts, " ")),
                     std::string("the mechanism is refused with it: ") + reason.what());
  }
}

/// Builds the mechanism like build_model(), but ignores MechanismChoice::calibrated.
std::unique_ptr<Model> build_uncorrected(const MechanismChoice& mechanism) {
  const CatalogEntry& entry = *mechanism.entry;
  if (mechanism.points.empty()) return build_without_points(mechanism);
  try {
    return entry.build_with_points(mechanism.geometry, mechanism.fidelity, mechanism.points);
  } catch (const std::invalid_argument& reason) {
    MechanismChoice without_points = mechanism;
    without_points.points.clear();
    // This call throws if the geometry is impossible even without the study's points. If it does not, the points are
    // the problem.
    static_cast<void>(build_uncorrected(without_points));
    throw InputError(
        mechanism.points_place, reason.what(),
        "name points around the platform, such as its joints' centres, or leave the key out to take these");
  }
}

}  // namespace

std::unique_ptr<Model> build_model(const MechanismChoice& mechanism) {
  std::unique_ptr<Model> model = build_uncorrected(mechanism);
  if (!mechanism.calibrated) return model;
  try {
    return calibrated(std::move(model));
  } catch (const std::invalid_argument& reason) {
    throw InputError(mechanism.calibrated_place, std::string("analysis.calibrated is true, but ") + reason.what(),
                     "leave it out; it is for mechanisms of which sensitivity studies say what calibration can remove");
  }
}

std::string set_name(std::span<const FactorIndex> factors, const ModelDescription& model) {
  for (const FactorSet& set : model.factor_sets) {
    if (std::equal(factors.begin(), factors.end(), set.factors.begin(), set.factors.end())) return set.name;
  }
  if (model.find_set("all") != nullptr || factors.size() != model.factors.size()) return {};
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].value != f) return {};
  }
  return "all";
}

std::optional<std::string> beyond_bound(const Model& model, FactorIndex factor, double size, std::string_view what) {
  const ErrorBound bound = model.error_bound(factor);
  if (std::abs(size) < bound.size) return std::nullopt;
  const Factor& named = model.description().factors[factor.value];
  return "gives " + named.name + " " + std::string(what) + " of " + readable_text({size, named.dimension}) +
         ", no less than " + bound.part + " (" + readable_text({bound.size, named.dimension}) + ")";
}

std::string held_errors_text(const Study& study) {
  if (!study.analysis.background) return {};
  const std::vector<FactorIndex> held = held_errors(study);
  if (held.empty()) return {};
  const std::string_view overrides = study.analysis.kind->overrides;
  const std::string unless = overrides.empty() ? "" : fmt::format(", unless {} another value", overrides);
  return fmt::format("held constant{}: {} at {}", unless, owners_text(held, study), sizes_text(held, study));
}

/// The first eight names as a list, and the number of the others: "a, b, c, d, e, f, g, h and 3 more".
static std::string first_names(std::span<const std::string_view> names) {
  const std::size_t shown = std::min<std::size_t>(names.size(), 8);
  const std::string more = names.size() == shown ? "" : fmt::format(" and {} more", names.size() - shown);
  return fmt::format("{}{}", fmt::join(names.first(shown), ", "), more);
}

std::string left_out_text(const Study& study) {
  const Analysis& analysis = study.analysis;
  if (!study.mechanism.file || analysis.limits.empty() || analysis.kind->varies != Varies::together) return {};
  std::vector<FactorIndex> present = analysis.factors;
  if (analysis.background) std::ranges::copy(held_errors(study), std::back_inserter(present));
  const std::vector<Factor>& all = study.model().factors;
  std::vector<std::string_view> names;
  for (std::size_t f = 0; f < all.size(); ++f) {
    if (std::ranges::find(present, FactorIndex(f)) == present.end()) names.push_back(all[f].name);
  }
  if (names.empty()) return {};
  return fmt::format("left out: {} of the {} errors of the mechanism {} zero: {}", names.size(), all.size(),
                     names.size() == 1 ? "does not vary and is" : "do not vary and are", first_names(names));
}

std::string calibration_text(const Study& study) {
  if (study.mechanism.calibrated) return fmt::format("calibrated: responses are {}", kLeftByCalibration);
  if (study.analysis.calibration == nullptr) return {};
  const CalibrationTable& table = *study.analysis.calibration;
  std::vector<std::string_view> fitted;
  for (const FittedErrors& one : table.fit) fitted.push_back(one.name);
  return fmt::format(
      "calibrated: {} of each machine {} fitted to measured {} at {}; responses are what its controller leaves",
      first_names(fitted), table.fit.size() == 1 ? "is" : "are", fmt::join(table.measured, ", "),
      table.poses ? "separate poses" : "the study's poses");
}

}  // namespace poesy
