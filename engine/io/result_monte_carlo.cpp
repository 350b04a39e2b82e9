#include "engine/io/result_format.h"
#include "engine/io/result_parts.h"

namespace poesy {
namespace {

const std::string kUnit = "SI: response unit, see /responses/unit";

void add_at_poses(ResultBuilder& result, const MonteCarloResult& found) {
  const Axes axes{"response", "pose"};
  const auto add = [&](const std::string& name, const std::vector<double>& values, const std::string& description) {
    result.add("/monte_carlo/" + name, axes, values, {kUnit, description});
  };
  add("mean", found.mean, "Mean over the samples; NaN where none counts");
  add("mean_ci_low", found.mean_ci_low, "Lower end of Student's interval of the mean");
  add("mean_ci_high", found.mean_ci_high, "Upper end of Student's interval of the mean");
  add("std", found.std, "Sample standard deviation");
  add("min", found.min, "Smallest sample");
  add("max", found.max, "Largest sample");
  result.add("/monte_carlo/count", axes, found.count,
             {"1", "Samples behind these: solved, or as not_converged has it"});
  result.add(
      "/monte_carlo/quantiles", {"response", "pose", "quantile"}, found.quantiles,
      {kUnit, "Order statistic of rank ceil(q n) of n samples, off by its part quantile_relative_error at most"});
}

void add_overall(ResultBuilder& result, const MonteCarloResult& found) {
  const Axes axes{"response"};
  const auto add = [&](const std::string& name, const std::vector<double>& values, const std::string& description) {
    result.add("/monte_carlo/overall_" + name, axes, values, {kUnit, description + " over the samples of all poses"});
  };
  add("mean", found.overall_mean, "Mean");
  add("std", found.overall_std, "Sample standard deviation");
  add("min", found.overall_min, "Smallest value");
  add("max", found.overall_max, "Largest value");
  result.add("/monte_carlo/overall_count", axes, found.overall_count, {"1", "Samples of all poses that count"});
  result.add("/monte_carlo/overall_quantiles", {"response", "quantile"}, found.overall_quantiles,
             {kUnit, "As quantiles, over the samples of all poses"});
}

}  // namespace

void add_monte_carlo(ResultBuilder& result, const Study& study, const MonteCarloResult& found) {
  h5::File& file = result.file();
  add_sigma(result, study);
  result.add_axis("quantile", found.levels, {"1", "Share of the samples below the quantile"});
  file.make_group("/monte_carlo");
  result.show_axes("/monte_carlo", {"response", "pose", "quantile"});
  file.set_attribute("/monte_carlo", "description",
                     std::string("Each response with all errors varying together, at each pose and over all poses"));
  file.set_attribute("/monte_carlo", "conf_level", found.conf_level);
  add_at_poses(result, found);
  add_overall(result, found);
  for (const char* interval : {"mean_ci_low", "mean_ci_high"}) {
    file.set_attribute(std::string("/monte_carlo/") + interval, "conf_level", found.conf_level);
  }
  for (const char* quantiles : {"quantiles", "overall_quantiles"}) {
    file.set_attribute(std::string("/monte_carlo/") + quantiles, "quantile_relative_error",
                       found.quantile_relative_error);
  }
  if (found.convergence) add_convergence(result, result_format::kMonteCarlo, *found.convergence);
  add_solver(result, {"pose"}, found.solves);
  add_failures(result, found.failures, {std::string(kAllFactors)}, found.total().not_converged());
}

void read_monte_carlo(const h5::File& file, StoredResult& result) {
  result.factor_sigma = read_exactly<double>(file, "/factors/sigma", result.factors.size());
  MonteCarloResult& found = result.monte_carlo;
  found.responses = result.responses.size();
  found.poses = result.poses.size();
  found.levels = file.read<double>("/quantile");
  found.conf_level = file.attribute<double>("/monte_carlo", "conf_level").at(0);
  found.quantile_relative_error = file.attribute<double>("/monte_carlo/quantiles", "quantile_relative_error").at(0);
  const std::size_t cells = found.responses * found.poses;
  const auto read = [&](const char* name, std::size_t count) {
    return read_exactly<double>(file, std::string("/monte_carlo/") + name, count);
  };
  found.mean = read("mean", cells);
  found.mean_ci_low = read("mean_ci_low", cells);
  found.mean_ci_high = read("mean_ci_high", cells);
  found.std = read("std", cells);
  found.min = read("min", cells);
  found.max = read("max", cells);
  found.count = read_exactly<std::uint64_t>(file, "/monte_carlo/count", cells);
  found.quantiles = read("quantiles", cells * found.levels.size());
  found.overall_mean = read("overall_mean", found.responses);
  found.overall_std = read("overall_std", found.responses);
  found.overall_min = read("overall_min", found.responses);
  found.overall_max = read("overall_max", found.responses);
  found.overall_count = read_exactly<std::uint64_t>(file, "/monte_carlo/overall_count", found.responses);
  found.overall_quantiles = read("overall_quantiles", found.responses * found.levels.size());
  if (file.exists("/convergence")) found.convergence = read_convergence(file, result.kind);
  found.solves = read_solver(file, found.poses);
  found.failures = read_failures(file, result);
}

}  // namespace poesy
