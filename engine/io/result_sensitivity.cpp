#include "engine/io/result_format.h"
#include "engine/io/result_parts.h"

namespace poesy {
namespace {

void add_global_indices(ResultBuilder& result, const SensitivityResult& found) {
  const Axes axes{"response", "factor"};
  const std::string unit = "SI: response unit / factor unit";
  result.add(
      "/sensitivity/global", axes, found.global,
      {unit, "Global index: mean over the poses + standard deviation over the poses (Du et al. 2022, Eqs. 53-54)"});
  result.add("/sensitivity/global_ci_low", axes, found.global_ci_low, {unit, "Lower end of the interval of global"});
  result.add("/sensitivity/global_ci_high", axes, found.global_ci_high, {unit, "Upper end of the interval of global"});
  result.add("/sensitivity/global_corrected", axes, found.global_corrected,
             {unit,
              "Global index without the sampling noise that 'global' counts as spread between poses; NaN: the error is "
              "too small for its effect to be told from rounding"});
  result.add("/sensitivity/global_corrected_ci_low", axes, found.global_corrected_ci_low,
             {unit, "Lower end of the interval of global_corrected"});
  result.add("/sensitivity/global_corrected_ci_high", axes, found.global_corrected_ci_high,
             {unit, "Upper end of the interval of global_corrected"});
  result.add("/sensitivity/rounding", {"response"}, found.rounding,
             {"SI: response unit, see /responses/unit",
              "Up to this an effect, index x sigma, cannot be told from the rounding of solves"});
  if (found.index_change.empty()) return;
  result.add(
      "/sensitivity/index_change", axes, found.index_change,
      {"1",
       "Change of 'global' where the error is a tenth as large, by the same few draws at up to 32 poses: index "
       "there / index here - 1; 0: the index holds at other sizes; NaN: not known, or no effect at either size"});
}

void add_local_indices(ResultBuilder& result, const SensitivityResult& found) {
  const Axes axes{"response", "factor", "pose"};
  const std::string index_unit = "SI: response unit / factor unit";
  const std::string response_unit = "SI: response unit, see /responses/unit";
  const std::vector<std::uint64_t> count(found.count.begin(), found.count.end());
  result.add("/sensitivity/local", axes, found.local,
             {index_unit, "Index at each pose: sigma(response) / sigma(error) (Du et al. 2022, Eqs. 51-52)"});
  result.add("/sensitivity/local_ci_low", axes, found.local_ci_low, {index_unit, "Lower end of the interval of local"});
  result.add("/sensitivity/local_ci_high", axes, found.local_ci_high,
             {index_unit, "Upper end of the interval of local"});
  result.add("/sensitivity/count", axes, count, {"1", "Samples behind the index"});
  result.add("/sensitivity/mean", axes, found.mean, {response_unit, "Mean of the response over the samples"});
  result.add("/sensitivity/std", axes, found.std,
             {response_unit, "Standard deviation of the response over the samples"});
  result.add("/sensitivity/background", {"response", "pose"}, found.background,
             {response_unit, "The response with all varied errors zero; NaN where that was not solved"});
}

void add_indices(ResultBuilder& result, const SensitivityResult& found) {
  h5::File& file = result.file();
  file.make_group("/sensitivity");
  result.show_axes("/sensitivity", {"response", "factor", "pose"});
  file.set_attribute("/sensitivity", "description",
                     std::string("Sensitivity of each response to each error: sigma(response) / sigma(error), one "
                                 "error varying at a time; NaN where undefined"));
  file.set_attribute("/sensitivity", "conf_level", found.conf_level);
  add_global_indices(result, found);
  add_local_indices(result, found);
  for (const char* interval : {"global_ci_low", "global_ci_high", "global_corrected_ci_low", "global_corrected_ci_high",
                               "local_ci_low", "local_ci_high"}) {
    file.set_attribute(std::string("/sensitivity/") + interval, "conf_level", found.conf_level);
  }
}

SensitivityResult read_indices(const h5::File& file) {
  SensitivityResult found;
  found.responses = axis_length(file, "response");
  found.factors = axis_length(file, "factor");
  found.poses = axis_length(file, "pose");
  found.conf_level = file.attribute<double>("/sensitivity", "conf_level").at(0);
  const std::size_t pairs = found.responses * found.factors;
  const auto read = [&](const char* name, std::size_t count) {
    return read_exactly<double>(file, std::string("/sensitivity/") + name, count);
  };
  found.local = read("local", pairs * found.poses);
  found.local_ci_low = read("local_ci_low", pairs * found.poses);
  found.local_ci_high = read("local_ci_high", pairs * found.poses);
  found.count = read("count", pairs * found.poses);
  found.mean = read("mean", pairs * found.poses);
  found.std = read("std", pairs * found.poses);
  found.global = read("global", pairs);
  found.global_ci_low = read("global_ci_low", pairs);
  found.global_ci_high = read("global_ci_high", pairs);
  if (file.exists("/sensitivity/global_corrected")) {
    found.global_corrected = read("global_corrected", pairs);
    found.global_corrected_ci_low = read("global_corrected_ci_low", pairs);
    found.global_corrected_ci_high = read("global_corrected_ci_high", pairs);
    found.rounding = read("rounding", found.responses);
  }
  if (file.exists("/sensitivity/index_change")) found.index_change = read("index_change", pairs);
  if (file.exists("/sensitivity/background")) found.background = read("background", found.responses * found.poses);
  found.solves = read_solver(file, found.factors * found.poses);
  return found;
}

}  // namespace

void add_sensitivity(ResultBuilder& result, const Study& study, const SensitivityResult& found) {
  add_sigma(result, study);
  add_indices(result, found);
  if (found.history) add_history(result, *found.history, found.conf_level);
  add_tolerances(result, study, found);
  if (found.separation) add_separation(result, study, *found.separation);
  if (found.fidelity) add_fidelity(result, study, *found.fidelity);
  if (found.convergence) add_convergence(result, result_format::kSensitivity, *found.convergence);
  if (!found.radius_tau.empty()) add_radius_tau(result, found.radius_tau);
  add_solver(result, {"factor", "pose"}, found.solves);
  std::vector<std::string> names;
  for (const FactorIndex factor : study.analysis.factors) names.push_back(study.model().factors[factor.value].name);
  add_failures(result, found.failures, names, found.total().not_converged());
}

void read_sensitivity(const h5::File& file, StoredResult& result) {
  result.factor_sigma = read_exactly<double>(file, "/factors/sigma", result.factors.size());
  if (file.exists("/factors/distribution")) {
    result.factor_distribution = read_exactly<std::string>(file, "/factors/distribution", result.factors.size());
    check_names(result.factor_distribution, "/factors/distribution");
  }
  result.sensitivity = read_indices(file);
  result.sensitivity.radius_tau = read_radius_tau(file);
  result.sensitivity.history = read_history(file);
  result.sensitivity.failures = read_failures(file, result);
  if (file.exists("/tolerances")) read_tolerances(file, result);
  if (file.exists("/separation")) read_separation(file, result);
  if (file.exists("/fidelity")) read_fidelity(file, result);
  if (file.exists("/convergence")) result.sensitivity.convergence = read_convergence(file, result.kind);
}

}  // namespace poesy
