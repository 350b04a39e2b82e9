#include <algorithm>

#include "engine/base/units.h"
#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/machine_fields.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/monte_carlo/yield.h"
#include "engine/result/result_parts.h"

namespace poesy {
namespace {

using MonteCarlo = MonteCarloResult;

const Axes kQuantileAtPose{"response", "pose", "quantile"};
const Axes kOverallQuantile{"response", "quantile"};
const std::vector<Attribute<MonteCarlo>> kInterval{{"conf_level", &MonteCarlo::conf_level}};
const std::vector<Attribute<MonteCarlo>> kSketch{{"quantile_relative_error", &MonteCarlo::quantile_relative_error}};
const std::string kEndOfInterval =
    " end of an interval for the quantile of the distribution, whatever that is, from order statistics (binomial); it "
    "is wide enough for what quantile_error rounds away, and infinite where the samples are too few for an end";
const std::string kLowerEnd = "Lower" + kEndOfInterval;
const std::string kUpperEnd = "Upper" + kEndOfInterval;

/// Numbers at each pose, and those over all poses, in the order of the columns of CSV.
const Group<MonteCarlo> kMonteCarlo{
    "/monte_carlo",
    "Each response with all errors varying together, at each pose and over all poses",
    kInterval,
    {{"response", &MonteCarlo::responses}, {"pose", &MonteCarlo::poses}},
    {{"mean", &MonteCarlo::mean, kByResponsePose, kResponseUnit, "Mean over the samples; NaN where none counts"},
     {"mean_ci_low", &MonteCarlo::mean_ci_low, kByResponsePose, kResponseUnit,
      "Lower end of Student's interval of the mean", kInterval},
     {"mean_ci_high", &MonteCarlo::mean_ci_high, kByResponsePose, kResponseUnit,
      "Upper end of Student's interval of the mean", kInterval},
     {"std", &MonteCarlo::std, kByResponsePose, kResponseUnit, "Sample standard deviation"},
     {"min", &MonteCarlo::min, kByResponsePose, kResponseUnit, "Smallest sample"},
     {"max", &MonteCarlo::max, kByResponsePose, kResponseUnit, "Largest sample"},
     {"count", &MonteCarlo::count, kByResponsePose, "1", "Samples behind these: solved, or as not_converged has it"},
     {"quantiles", &MonteCarlo::quantiles, kQuantileAtPose, kResponseUnit,
      "Order statistic of rank ceil(q n) of n samples, off by quantile_error and by its part quantile_relative_error "
      "at most",
      kSketch},
     {"rms", &MonteCarlo::rms, kByResponsePose, kResponseUnit,
      "Root mean square of the samples; NaN where none counts"},
     {"quantiles_ci_low", &MonteCarlo::quantiles_ci_low, kQuantileAtPose, kResponseUnit, kLowerEnd, kInterval},
     {"quantiles_ci_high", &MonteCarlo::quantiles_ci_high, kQuantileAtPose, kResponseUnit, kUpperEnd, kInterval},
     {"overall_mean", &MonteCarlo::overall_mean, kByResponse, kResponseUnit, "Mean over the samples of all poses"},
     {"overall_std", &MonteCarlo::overall_std, kByResponse, kResponseUnit,
      "Sample standard deviation over the samples of all poses"},
     {"overall_min", &MonteCarlo::overall_min, kByResponse, kResponseUnit,
      "Smallest value over the samples of all poses"},
     {"overall_max", &MonteCarlo::overall_max, kByResponse, kResponseUnit,
      "Largest value over the samples of all poses"},
     {"overall_count", &MonteCarlo::overall_count, kByResponse, "1", "Samples of all poses that count"},
     {"overall_quantiles", &MonteCarlo::overall_quantiles, kOverallQuantile, kResponseUnit,
      "As quantiles, over the samples of all poses", kSketch},
     {"overall_rms", &MonteCarlo::overall_rms, kByResponse, kResponseUnit,
      "Root mean square over the samples of all poses"},
     {"overall_quantiles_ci_low", &MonteCarlo::overall_quantiles_ci_low, kOverallQuantile, kResponseUnit, kLowerEnd,
      kInterval},
     {"overall_quantiles_ci_high", &MonteCarlo::overall_quantiles_ci_high, kOverallQuantile, kResponseUnit, kUpperEnd,
      kInterval},
     {"histogram_edges",
      &MonteCarlo::histogram_edges,
      {"response", "edge"},
      kResponseUnit,
      "Edges of the bins; the first and the last are the extremes; bins that are not needed have no width and stand at "
      "the end; NaN where no sample counts"},
     {"histogram_counts",
      &MonteCarlo::histogram_counts,
      {"response", "bin"},
      "1",
      "Samples of all poses in each bin, exact; the first and the last bin hold the outermost 0.05 % each"},
     {"share_magnitude", &MonteCarlo::share_magnitude, kByResponsePose, kResponseUnit,
      "Within this magnitude stays the share of all draws that [analysis] share asks for; draws that do not count are "
      "outside; infinite where they are too many",
      Presence::where_computed},
     {"quantile_error", &MonteCarlo::quantile_error, kByResponsePose, kResponseUnit,
      "What none of the quantiles at the pose is off by more than from its order statistic; 0 of up to 256 samples, "
      "some thousandths of std of more; NaN where none counts",
      Presence::where_computed},
     {"overall_quantile_error", &MonteCarlo::overall_quantile_error, kByResponse, kResponseUnit,
      "The same of overall_quantiles", Presence::where_computed},
     {"varies", &MonteCarlo::varies, kByResponse, "1",
      "0 where the response does not vary: what its samples scatter at any pose is rounding, so it has no indices "
      "and no main effects; left out where all vary",
      Presence::where_computed}}};

const FieldRow<MonteCarlo>& row(std::string_view name) {
  return *std::ranges::find(kMonteCarlo.fields, name, &FieldRow<MonteCarlo>::name);
}

/// Appends columns of numbers and quantiles: those of the poses of a response (prefix "", first: its first number) or
/// those of the responses (prefix "overall_", first: 0).
void append_number_columns(CsvTable& table, const StoredResult& result, const std::vector<std::string>& names,
                           const std::string& prefix, std::size_t first, const std::string& unit) {
  const MonteCarlo& found = monte_carlo_of(result);
  const std::size_t levels = found.levels.size();
  for (const std::string& name : names) {
    table.columns.push_back(
        field_column(with_unit(name, name == "count" ? "1" : unit), row(prefix + name), found, first));
  }
  const auto append_quantile = [&](std::size_t q, const std::string& rest) {
    const std::string heading = with_unit("q_" + shortest(found.levels[q]) + rest, unit);
    table.columns.push_back(field_column(heading, row(prefix + "quantiles" + rest), found, first * levels + q, levels));
  };
  for (std::size_t q = 0; q < levels; ++q) append_quantile(q, "");
  table.columns.push_back(field_column(with_unit("rms", unit), row(prefix + "rms"), found, first));
  for (std::size_t q = 0; q < levels; ++q) {
    append_quantile(q, "_ci_low");
    append_quantile(q, "_ci_high");
  }
  if (found.overall_quantile_error.empty()) return;  // of version 0.2
  table.columns.push_back(
      field_column(with_unit("quantile_error", unit), row(prefix + "quantile_error"), found, first));
}

CsvTable response_table(const StoredResult& result, std::size_t r) {
  const NamedUnit& response = result.responses[r];
  CsvTable table = lines_of_poses(result, "monte_carlo_" + response.name);
  append_number_columns(table, result, {"mean", "mean_ci_low", "mean_ci_high", "std", "min", "max", "count"}, "",
                        r * result.poses.size(), response.unit);
  return table;
}

/// Responses have units of their own, so a row ends with its unit.
CsvTable overall_table(const StoredResult& result) {
  CsvTable table{"overall",
                 {"response", [&](std::size_t r) { return result.responses[r].name; }},
                 result.responses.size(),
                 {},
                 {"unit", [&](std::size_t r) { return result.responses[r].unit; }}};
  append_number_columns(table, result, {"mean", "std", "min", "max", "count"}, "overall_", 0, "1");
  return table;
}

/// Bins of no width, which fill up the result's table, are left out.
CsvTable histogram_table(const StoredResult& result, std::size_t r) {
  const MonteCarlo& found = monte_carlo_of(result);
  const NamedUnit& response = result.responses[r];
  const std::size_t bins = found.histogram_counts.size() / found.responses;
  const std::size_t edge = r * (bins + 1);
  return {"histogram_" + response.name,
          {"bin", [](std::size_t b) { return std::to_string(b); }},
          bins,
          {field_column(with_unit("low", response.unit), row("histogram_edges"), found, edge),
           field_column(with_unit("high", response.unit), row("histogram_edges"), found, edge + 1),
           list_column("count", found.histogram_counts, r * bins)},
          {},
          [&found, edge, first = r * bins](std::size_t b) {
            return found.histogram_counts[first + b] > 0 ||
                   found.histogram_edges[edge + b] < found.histogram_edges[edge + b + 1];
          }};
}

const CourseWords kConvergence = convergence_words(
    kByResponse, "mean", kResponseUnit, "Mean over the samples of all poses",
    "Every pose got samples until, at a milestone, the half-width of the mean of every response of the headline was at "
    "most relative_error of its magnitude, or max was there",
    "errors");

void write(ResultBuilder& result, const Study& study, std::any& any) {
  const auto& found = std::any_cast<const MonteCarlo&>(any);
  const std::size_t bins = found.histogram_counts.size() / found.responses;
  add_names(result, study, study.analysis.factors);
  add_sigma(result, study);
  result.add_axis("quantile", found.levels, {"1", "Share of the samples below the quantile"});
  result.add_axis("bin", axis_numbers(bins), {"1", "Number of the histogram's bin, from 0"});
  result.add_axis("edge", axis_numbers(bins + 1),
                  {"1", "Number of the histogram's edge: bin k lies between k and k + 1"});
  write_group(result, kMonteCarlo, found);
  if (!found.share_magnitude.empty()) {
    result.file().set_attribute("/monte_carlo/share_magnitude", "share",
                                asked_of<MonteCarloOptions>(study.analysis).share);
  }
  write_effects(result, found.effects);
  if (found.machines) write_machines(result, *found.machines);
  add_limits(result, study.model(), found.verdicts);
  if (found.verdicts && found.verdicts->yield) {
    result.file().set_attribute("/limits", "yield", found.verdicts->yield->asked);
  }
  add_convergence(result, kConvergence, found.convergence);
  add_solver(result, kByPose, found.solves);
  add_failures(result, found.failures, {std::string(kAllFactors)}, found.total().not_converged());
}

void read(const h5::File& file, StoredResult& result) {
  MonteCarlo found;
  read_sigma(file, result);
  found.levels = file.read<double>("/quantile");
  found.quantile_relative_error = file.attribute<double>("/monte_carlo/quantiles", "quantile_relative_error").at(0);
  read_group(file, kMonteCarlo, found);
  result.constant = constant_responses(found.varies);
  const std::size_t bins = axis_length(file, "bin");
  if (bins == 0 || axis_length(file, "edge") != bins + 1) {
    throw h5::Error("/edge does not have one position more than /bin, or there is no bin");
  }
  result.verdicts = read_limits(file, result);
  found.solves = read_solver(file, kByPose);
  found.effects = read_effects(file);
  found.machines = read_machines(file);
  if (result.verdicts && result.verdicts->judge == Judge::yield) {
    if (!found.machines || !found.machines->yield) throw h5::Error("/limits judges a yield that is not there");
    result.verdicts->yield =
        judge_yield(*found.machines->yield, found.total(), file.attribute<double>("/limits", "yield").at(0));
  }
  result.convergence = read_convergence(file, kConvergence);
  result.varied = {std::string(kAllFactors)};
  result.failures = read_failures(file, result);
  result.found = std::move(found);
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  const MonteCarlo& found = monte_carlo_of(result);
  append_sigma_tables(tables, result);
  for (std::size_t r = 0; r < found.responses; ++r) tables.push_back(response_table(result, r));
  tables.push_back(overall_table(result));
  for (std::size_t r = 0; r < found.responses; ++r) tables.push_back(histogram_table(result, r));
  append_effect_tables(tables, result);
  if (found.machines) append_machine_tables(tables, result);
  append_limit_table(tables, result);
  CsvTable solves = lines_of_poses(result, "not_converged");
  append_solve_columns(solves, found.solves);
  tables.push_back(std::move(solves));
  tables.push_back(failure_table(result));
  append_convergence_tables(tables, result, kConvergence);
}

}  // namespace

constinit const FileKind kMonteCarloFile{.write = write, .read = read, .append_tables = append_tables};

}  // namespace poesy
