#include "engine/io/result_format.h"
#include "engine/io/result_parts.h"
#include "engine/stats/moments.h"

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
  add("rms", found.rms, "Root mean square of the samples; NaN where none counts");
  result.add("/monte_carlo/count", axes, found.count,
             {"1", "Samples behind these: solved, or as not_converged has it"});
  result.add(
      "/monte_carlo/quantiles", {"response", "pose", "quantile"}, found.quantiles,
      {kUnit, "Order statistic of rank ceil(q n) of n samples, off by its part quantile_relative_error at most"});
}

constexpr const char* kIntervalRule =
    " end of an interval for the quantile of the distribution, whatever that is, from order statistics (binomial); it "
    "is "
    "wide enough for what quantile_relative_error rounds away, and infinite where the samples are too few for an end";

void add_quantile_intervals(ResultBuilder& result, const MonteCarloResult& found) {
  const Axes at_poses{"response", "pose", "quantile"};
  const Axes overall{"response", "quantile"};
  const std::string low = std::string("Lower") + kIntervalRule;
  const std::string high = std::string("Upper") + kIntervalRule;
  result.add("/monte_carlo/quantiles_ci_low", at_poses, found.quantiles_ci_low, {kUnit, low});
  result.add("/monte_carlo/quantiles_ci_high", at_poses, found.quantiles_ci_high, {kUnit, high});
  result.add("/monte_carlo/overall_quantiles_ci_low", overall, found.overall_quantiles_ci_low, {kUnit, low});
  result.add("/monte_carlo/overall_quantiles_ci_high", overall, found.overall_quantiles_ci_high, {kUnit, high});
}

void add_histogram(ResultBuilder& result, const MonteCarloResult& found) {
  const std::size_t bins = found.histogram_counts.size() / found.responses;
  result.add_axis("bin", positions(bins), {"1", "Number of the histogram's bin, from 0"});
  result.add_axis("edge", positions(bins + 1), {"1", "Number of the histogram's edge: bin k lies between k and k + 1"});
  result.show_axes("/monte_carlo", {"bin", "edge"});
  result.add("/monte_carlo/histogram_edges", {"response", "edge"}, found.histogram_edges,
             {kUnit,
              "Edges of the bins; the first and the last are the extremes; bins that are not needed have no width "
              "and stand at the end; NaN where no sample counts"});
  result.add(
      "/monte_carlo/histogram_counts", {"response", "bin"}, found.histogram_counts,
      {"1", "Samples of all poses in each bin, exact; the first and the last bin hold the outermost 0.05 % each"});
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
  add("rms", found.overall_rms, "Root mean square");
  result.add("/monte_carlo/overall_count", axes, found.overall_count, {"1", "Samples of all poses that count"});
  result.add("/monte_carlo/overall_quantiles", {"response", "quantile"}, found.overall_quantiles,
             {kUnit, "As quantiles, over the samples of all poses"});
}

/// What files of older versions do not have; their root mean squares follow from the rest.
void read_added(const h5::File& file, MonteCarloResult& found) {
  const std::size_t cells = found.responses * found.poses;
  const auto read = [&](const char* name, std::size_t count, std::vector<double>& into) {
    const std::string path = std::string("/monte_carlo/") + name;
    if (file.exists(path)) into = read_exactly<double>(file, path, count);
  };
  read("rms", cells, found.rms);
  read("overall_rms", found.responses, found.overall_rms);
  for (std::size_t k = found.rms.size(); k < cells; ++k) {
    found.rms.push_back(root_mean_square(found.mean[k], found.std[k], found.count[k]));
  }
  for (std::size_t r = found.overall_rms.size(); r < found.responses; ++r) {
    found.overall_rms.push_back(root_mean_square(found.overall_mean[r], found.overall_std[r], found.overall_count[r]));
  }
  const std::size_t levels = found.levels.size();
  read("quantiles_ci_low", cells * levels, found.quantiles_ci_low);
  read("quantiles_ci_high", cells * levels, found.quantiles_ci_high);
  read("overall_quantiles_ci_low", found.responses * levels, found.overall_quantiles_ci_low);
  read("overall_quantiles_ci_high", found.responses * levels, found.overall_quantiles_ci_high);
  read("share_magnitude", cells, found.share_magnitude);
  if (!file.exists("/monte_carlo/histogram_counts")) return;
  const std::size_t bins = axis_length(file, "bin");
  found.histogram_counts = read_exactly<std::uint64_t>(file, "/monte_carlo/histogram_counts", found.responses * bins);
  read("histogram_edges", found.responses * (bins + 1), found.histogram_edges);
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
  add_quantile_intervals(result, found);
  add_histogram(result, found);
  if (found.verdicts) add_limits(result, study.model(), *found.verdicts);
  if (!found.share_magnitude.empty()) {
    result.add("/monte_carlo/share_magnitude", {"response", "pose"}, found.share_magnitude,
               {kUnit,
                "Within this magnitude stays the share of all draws that [analysis] share asks for; draws that do "
                "not count are outside; infinite where they are too many"});
    file.set_attribute("/monte_carlo/share_magnitude", "share", study.analysis.share);
  }
  for (const char* interval : {"mean_ci_low", "mean_ci_high", "quantiles_ci_low", "quantiles_ci_high",
                               "overall_quantiles_ci_low", "overall_quantiles_ci_high"}) {
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
  read_added(file, found);
  found.verdicts = read_limits(file, result);
  if (file.exists("/convergence")) found.convergence = read_convergence(file, result.kind);
  found.solves = read_solver(file, found.poses);
  found.failures = read_failures(file, result);
}

}  // namespace poesy
