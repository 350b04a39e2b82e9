#include <algorithm>
#include <cmath>

#include "engine/base/nan.h"
#include "engine/io/result_parts.h"
#include "engine/run/sensitivity.h"

namespace poesy {
namespace {

/// Tolerances of all responses, side by side.
struct Columns {
  std::vector<double> equal_effect;         ///< [R x P]
  std::vector<double> mean_square_share;    ///< [R x P]
  std::vector<double> rms_effect;           ///< [R x P]
  std::vector<double> background_rms;       ///< [R]
  std::vector<std::string> reference;       ///< [R] names; empty where there is none
  std::vector<double> reference_tolerance;  ///< [R] NaN where there is none
  std::vector<double> mean_square_bound;    ///< [R] Response::mean_square_bound
};

/// The study's reference, or the error of smallest effect at one unit of those in which people read it.
std::optional<ReferenceError> reference_for(const Study& study, const ResponseStudy& response) {
  const std::vector<FactorIndex>& factors = study.analysis.factors;
  if (const auto& chosen = study.analysis.reference) {
    const auto at = std::ranges::find(factors, chosen->factor);
    return ReferenceError{static_cast<std::size_t>(at - factors.begin()), chosen->tolerance};
  }
  const auto smallest = smallest_effect(response.index, response.sigma);
  if (!smallest) return std::nullopt;
  return ReferenceError{*smallest, display_unit(study.model().factors[factors[*smallest].value].dimension).si};
}

Columns columns_of(const Study& study, const SensitivityResult& found) {
  const std::vector<double> sigma = standard_deviations(study);
  Columns columns;
  for (std::size_t r = 0; r < found.responses; ++r) {
    const ResponseStudy response = response_study(found, sigma, r);
    const Tolerances all = tolerances(response, reference_for(study, response));
    columns.equal_effect.insert(columns.equal_effect.end(), all.equal_effect.begin(), all.equal_effect.end());
    columns.mean_square_share.insert(columns.mean_square_share.end(), all.mean_square_share.begin(),
                                     all.mean_square_share.end());
    for (const double effect : all.mean_square.effects) columns.rms_effect.push_back(std::sqrt(effect));
    columns.background_rms.push_back(std::sqrt(all.mean_square.background));
    const auto& reference = all.reference;
    columns.reference.push_back(reference ? study.model().factors[study.analysis.factors[reference->factor].value].name
                                          : "");
    columns.reference_tolerance.push_back(reference ? reference->tolerance : kNaN);
    columns.mean_square_bound.push_back(study.model().responses[r].mean_square_bound);
  }
  return columns;
}

void add_factors(ResultBuilder& result, const Study& study) {
  std::vector<std::string> kinds;
  std::vector<std::string> units;
  std::vector<std::uint64_t> limbs;
  for (const FactorIndex index : study.analysis.factors) {
    const Factor& factor = study.model().factors[index.value];
    kinds.emplace_back(error_kind(factor.dimension));
    units.push_back(unit_of(factor));
    limbs.push_back(factor.limb);
  }
  result.add("/tolerances/kind", {"factor"}, kinds, {"1", "Kind of the error: linear or angular"});
  result.add("/tolerances/limb", {"factor"}, limbs, {"1", "Limb of the error, from 1"});
  result.add("/tolerances/unit", {"factor"}, units, {"1", "SI unit of the error and of its tolerance"});
}

void add_indices(ResultBuilder& result, const SensitivityResult& found) {
  const auto add = [&](const std::string& name, const std::vector<double>& values, const std::string& description) {
    result.add("/tolerances/" + name, {"response", "factor"}, values, {"SI: response unit / factor unit", description});
    if (name != "index") result.file().set_attribute("/tolerances/" + name, "conf_level", found.conf_level);
  };
  add("index", found.global,
      "Global sensitivity index as published, /sensitivity/global: tolerances are counted from it");
  add("index_ci_low", found.global_ci_low, "Lower end of the interval of index");
  add("index_ci_high", found.global_ci_high, "Upper end of the interval of index");
}

void add_columns(ResultBuilder& result, const Columns& columns) {
  const Axes axes{"response", "factor"};
  const std::string factor_unit = "SI: factor unit, see /tolerances/unit";
  result.add(
      "/tolerances/equal_effect", axes, columns.equal_effect,
      {factor_unit,
       "Tolerance that gives every error the reference's effect: index(reference) / index x "
       "reference_tolerance (Du et al. 2022, Section 6.3, Table 10); infinity: no effect on its own; NaN: unknown"});
  result.add("/tolerances/mean_square_share", axes, columns.mean_square_share,
             {"1",
              "Share of what all errors add to the response's mean square over samples and poses, with sigma as set "
              "in the study: (rms_effect x sigma)^2 over its sum; NaN: unknown"});
  result.add("/tolerances/rms_effect", axes, columns.rms_effect,
             {"SI: response unit / factor unit",
              "Growth of the response's mean square over samples and poses per tolerance^2, square root of it: mean "
              "square = background_rms^2 + sum of (rms_effect x tolerance)^2"});
  result.add("/tolerances/background_rms", {"response"}, columns.background_rms,
             {"SI: response unit, see /responses/unit",
              "Root mean square over the poses of the response with all varied errors zero"});
  result.add("/tolerances/reference_factor", {"response"}, columns.reference,
             {"1", "The error from which equal_effect is counted; empty when no error has an effect"});
  result.add("/tolerances/reference_tolerance", {"response"}, columns.reference_tolerance,
             {"SI: unit of reference_factor", "Tolerance of reference_factor"});
  result.add("/tolerances/mean_square_bound", {"response"}, columns.mean_square_bound,
             {"1",
              "To first order, the mean square of all errors together is at most this times the sum of those of each "
              "error alone; 1: they add exactly"});
}

}  // namespace

void add_tolerances(ResultBuilder& result, const Study& study, const SensitivityResult& found) {
  result.file().make_group("/tolerances");
  result.show_axes("/tolerances", {"response", "factor"});
  result.file().set_attribute("/tolerances", "description",
                              std::string("Tolerances from the indices; a tolerance is the standard deviation of a "
                                          "normal error"));
  add_factors(result, study);
  add_indices(result, found);
  add_columns(result, columns_of(study, found));
}

void read_tolerances(const h5::File& file, StoredResult& result) {
  const std::size_t responses = result.responses.size();
  result.factor_limb = read_exactly<std::uint64_t>(file, "/tolerances/limb", result.factors.size());
  const auto names = read_exactly<std::string>(file, "/tolerances/reference_factor", responses);
  const auto tolerances = read_exactly<double>(file, "/tolerances/reference_tolerance", responses);
  for (std::size_t r = 0; r < responses; ++r) {
    const auto at = std::ranges::find(result.factors, names[r], &NamedUnit::name);
    const auto factor = static_cast<std::size_t>(at - result.factors.begin());
    if (at == result.factors.end() && !names[r].empty()) throw h5::Error("its reference error is none of its factors");
    result.tolerance_reference.push_back(names[r].empty() ? std::nullopt
                                                          : std::optional(ReferenceError{factor, tolerances[r]}));
  }
  if (!file.exists("/tolerances/mean_square_bound")) return;
  result.mean_square_bound = read_exactly<double>(file, "/tolerances/mean_square_bound", responses);
}

}  // namespace poesy
