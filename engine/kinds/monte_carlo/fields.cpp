#include <algorithm>

#include "engine/base/units.h"
#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/machine_fields.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/monte_carlo/yield.h"
#include "engine/result/result_parts.h"

namespace poesy::monte_carlo {
namespace {

using MonteCarlo = Result;

const std::vector<Attribute<MonteCarlo>> kInterval{{"conf_level", &MonteCarlo::conf_level}};
const std::vector<Attribute<MonteCarlo>> kSketch{{"quantile_relative_error", &MonteCarlo::quantile_relative_error}};
const std::string kEndOfInterval =
    " end of an interval for the quantile of the distribution, whatever that is, from order statistics (binomial); it "
    "is wide enough for what quantile_error rounds away, and infinite where the samples are too few for an end";
const std::string kLowerEnd = "Lower" + kEndOfInterval;
const std::string kUpperEnd = "Upper" + kEndOfInterval;

/// The fields of the group /monte_carlo: numbers at each pose and over all poses.
const Group<MonteCarlo> kMonteCarlo{
    "/monte_carlo",
    "Each response with all errors varying together, at each pose and over all poses",
    kInterval,
    {},
    {{"mean", &MonteCarlo::mean, kResponseUnit, "Mean over the samples; NaN where none counts"},
     {"mean_ci_low", &MonteCarlo::mean_ci_low, kResponseUnit, "Lower end of Student's interval of the mean",
      Presence::always, kInterval},
     {"mean_ci_high", &MonteCarlo::mean_ci_high, kResponseUnit, "Upper end of Student's interval of the mean",
      Presence::always, kInterval},
     {"std", &MonteCarlo::std, kResponseUnit, "Sample standard deviation"},
     {"min", &MonteCarlo::min, kResponseUnit, "Smallest sample"},
     {"max", &MonteCarlo::max, kResponseUnit, "Largest sample"},
     {"count", &MonteCarlo::count, "1", "Samples behind these: solved, or as not_converged has it"},
     {"quantiles", &MonteCarlo::quantiles, kResponseUnit,
      "Order statistic of rank ceil(q n) of n samples, off by quantile_error and by its part quantile_relative_error "
      "at most",
      Presence::always, kSketch},
     {"rms", &MonteCarlo::rms, kResponseUnit, "Root mean square of the samples; NaN where none counts"},
     {"quantiles_ci_low", &MonteCarlo::quantiles_ci_low, kResponseUnit, kLowerEnd, Presence::always, kInterval},
     {"quantiles_ci_high", &MonteCarlo::quantiles_ci_high, kResponseUnit, kUpperEnd, Presence::always, kInterval},
     {"overall_mean", &MonteCarlo::overall_mean, kResponseUnit, "Mean over the samples of all poses"},
     {"overall_std", &MonteCarlo::overall_std, kResponseUnit,
      "Sample standard deviation over the samples of all poses"},
     {"overall_min", &MonteCarlo::overall_min, kResponseUnit, "Smallest value over the samples of all poses"},
     {"overall_max", &MonteCarlo::overall_max, kResponseUnit, "Largest value over the samples of all poses"},
     {"overall_count", &MonteCarlo::overall_count, "1", "Samples of all poses that count"},
     {"overall_quantiles", &MonteCarlo::overall_quantiles, kResponseUnit, "As quantiles, over the samples of all poses",
      Presence::always, kSketch},
     {"overall_rms", &MonteCarlo::overall_rms, kResponseUnit, "Root mean square over the samples of all poses"},
     {"overall_quantiles_ci_low", &MonteCarlo::overall_quantiles_ci_low, kResponseUnit, kLowerEnd, Presence::always,
      kInterval},
     {"overall_quantiles_ci_high", &MonteCarlo::overall_quantiles_ci_high, kResponseUnit, kUpperEnd, Presence::always,
      kInterval},
     {"histogram_edges", &MonteCarlo::histogram_edges, kResponseUnit,
      "Edges of the bins; the first and the last are the extremes; bins that are not needed have no width and stand at "
      "the end; NaN where no sample counts"},
     {"histogram_counts", &MonteCarlo::histogram_counts, "1",
      "Samples of all poses in each bin, exact; the first and the last bin hold the outermost 0.05 % each"},
     {"share_magnitude", &MonteCarlo::share_magnitude, kResponseUnit,
      "Within this magnitude stays the share of all draws that [analysis] share asks for; draws that do not count are "
      "outside; infinite where they are too many",
      Presence::where_computed},
     {"quantile_error", &MonteCarlo::quantile_error, kResponseUnit,
      "What none of the quantiles at the pose is off by more than from its order statistic; 0 of up to 256 samples, "
      "some thousandths of std of more; NaN where none counts",
      Presence::where_computed},
     {"overall_quantile_error", &MonteCarlo::overall_quantile_error, kResponseUnit, "The same of overall_quantiles",
      Presence::where_computed},
     {"varies", &MonteCarlo::varies, "1",
      "0 where the response does not vary: what its samples scatter at any pose is rounding, so it has no indices "
      "and no main effects; left out where all vary",
      Presence::where_computed}}};

/// The arrays of numbers that a CSV table shows. The last axis of each array is the axis of the table's lines; only
/// arrays of quantiles have one more axis after it, for the quantiles.
template <class Numbers, class Quantiles, class Counts>
struct ShownNumbers {
  /// The arrays of the columns before the column `count`, each with its heading.
  std::vector<std::pair<std::string, const Numbers*>> first;
  const Counts& count;
  const Numbers& rms;
  const Quantiles& quantiles;
  const Quantiles& quantiles_ci_low;
  const Quantiles& quantiles_ci_high;
  const Numbers& quantile_error;
};

// This deduction guide is needed, because Clang 14 does not deduce the template arguments of aggregates.
template <class Numbers, class Quantiles, class Counts>
ShownNumbers(std::vector<std::pair<std::string, const Numbers*>>, const Counts&, const Numbers&, const Quantiles&,
             const Quantiles&, const Quantiles&, const Numbers&) -> ShownNumbers<Numbers, Quantiles, Counts>;

/// Appends columns with these numbers and quantiles. at: positions on the axes before the axis of the lines: the
/// response, or nothing if the lines are responses.
template <class Numbers, class Quantiles, class Counts, class... Positions>
void append_number_columns(CsvTable& table, const std::string& unit, const std::vector<double>& levels,
                           const ShownNumbers<Numbers, Quantiles, Counts>& shown, Positions... at) {
  const auto append = [&](const std::string& name, const Numbers& numbers) {
    table.columns.push_back(list_column(with_unit(name, unit), numbers.row(at...)));
  };
  const auto append_quantile = [&](std::size_t q, const std::string& rest, const Quantiles& quantiles) {
    table.columns.push_back({with_unit("q_" + shortest(levels[q]) + rest, unit),
                             [&quantiles, q, at...](std::size_t line) { return quantiles(at..., line, q); }});
  };
  for (const auto& [name, numbers] : shown.first) append(name, *numbers);
  table.columns.push_back(list_column("count", shown.count.row(at...)));
  for (std::size_t q = 0; q < levels.size(); ++q) append_quantile(q, "", shown.quantiles);
  append("rms", shown.rms);
  for (std::size_t q = 0; q < levels.size(); ++q) {
    append_quantile(q, "_ci_low", shown.quantiles_ci_low);
    append_quantile(q, "_ci_high", shown.quantiles_ci_high);
  }
  // Files of version 0.2 have no quantile_error.
  if (!shown.quantile_error.empty()) append("quantile_error", shown.quantile_error);
}

CsvTable response_table(const StoredResult& result, std::size_t r) {
  const NamedUnit& response = result.responses[r];
  const MonteCarlo& found = monte_carlo_of(result);
  CsvTable table = lines_of_poses(result, "monte_carlo_" + response.name);
  append_number_columns(table, response.unit, found.levels,
                        ShownNumbers{{{"mean", &found.mean},
                                      {"mean_ci_low", &found.mean_ci_low},
                                      {"mean_ci_high", &found.mean_ci_high},
                                      {"std", &found.std},
                                      {"min", &found.min},
                                      {"max", &found.max}},
                                     found.count,
                                     found.rms,
                                     found.quantiles,
                                     found.quantiles_ci_low,
                                     found.quantiles_ci_high,
                                     found.quantile_error},
                        r);
  return table;
}

/// A table of the numbers of each response over all poses. Each line ends with its unit, because responses have
/// different units.
CsvTable overall_table(const StoredResult& result) {
  const MonteCarlo& found = monte_carlo_of(result);
  CsvTable table{"overall",
                 {"response", [&](std::size_t r) { return result.responses[r].name; }},
                 result.responses.size(),
                 {},
                 {"unit", [&](std::size_t r) { return result.responses[r].unit; }}};
  append_number_columns(table, "1", found.levels,
                        ShownNumbers{{{"mean", &found.overall_mean},
                                      {"std", &found.overall_std},
                                      {"min", &found.overall_min},
                                      {"max", &found.overall_max}},
                                     found.overall_count,
                                     found.overall_rms,
                                     found.overall_quantiles,
                                     found.overall_quantiles_ci_low,
                                     found.overall_quantiles_ci_high,
                                     found.overall_quantile_error});
  return table;
}

/// A table of the histogram of response r. Empty bins of zero width are left out, because they only fill unused
/// elements of the result.
CsvTable histogram_table(const StoredResult& result, std::size_t r) {
  const MonteCarlo& found = monte_carlo_of(result);
  const NamedUnit& response = result.responses[r];
  const std::span counts = found.histogram_counts.row(r);
  const std::span edges = found.histogram_edges.row(r);
  return {"histogram_" + response.name,
          {"bin", [](std::size_t b) { return std::to_string(b); }},
          counts.size(),
          {list_column(with_unit("low", response.unit), edges.first(counts.size())),
           list_column(with_unit("high", response.unit), edges.subspan(1)), list_column("count", counts)},
          {},
          [counts, edges](std::size_t b) { return counts[b] > 0 || edges[b] < edges[b + 1]; }};
}

const CourseWords kConvergence = convergence_words(
    kByResponse, "mean", kResponseUnit, "Mean over the samples of all poses",
    "Every pose got samples until, at a milestone, the half-width of the mean of every response of the headline was at "
    "most relative_error of its magnitude, or max was there",
    "errors");

void write(ResultBuilder& result, const Study& study, std::any& any) {
  const auto& found = std::any_cast<const MonteCarlo&>(any);
  const std::size_t bins = found.histogram_counts.length<axis::HistogramBin>();
  add_names(result, study, study.analysis.factors);
  add_sigma(result, study);
  result.add_axis("quantile", found.levels, {"1", "Share of the samples below the quantile"});
  result.add_axis("bin", axis_numbers(bins), {"1", "Number of the histogram's bin, from 0"});
  result.add_axis("edge", axis_numbers(bins + 1),
                  {"1", "Number of the histogram's edge: bin k lies between k and k + 1"});
  write_group(result, kMonteCarlo, found);
  if (!found.share_magnitude.empty()) {
    result.file().set_attribute("/monte_carlo/share_magnitude", "share", asked_of<Options>(study.analysis).share);
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
  for (std::size_t r = 0; r < result.responses.size(); ++r) tables.push_back(response_table(result, r));
  tables.push_back(overall_table(result));
  for (std::size_t r = 0; r < result.responses.size(); ++r) tables.push_back(histogram_table(result, r));
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

std::size_t monte_carlo_bytes(const AxisLengths& lengths, bool machines) {
  return bytes_of(kMonteCarlo.fields, lengths) + effect_bytes(lengths) + (machines ? machine_bytes(lengths) : 0);
}

constinit const FileKind kFile{.write = write, .read = read, .append_tables = append_tables};

}  // namespace poesy::monte_carlo
