#include <algorithm>

#include "engine/kinds/sensitivity/fidelity.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/kinds/sensitivity/points_radius.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/sensitivity/separation.h"
#include "engine/kinds/sensitivity/tolerances.h"
#include "engine/result/result_parts.h"

namespace poesy::sensitivity {
namespace {

using Indices = Result;

const std::vector<Attribute<Indices>> kLevel{{"conf_level", &Indices::conf_level}};

const Group<Indices> kIndices{
    "/sensitivity",
    "Sensitivity of each response to each error: sigma(response) / sigma(error), one error varying at a time; NaN "
    "where undefined",
    kLevel,
    {},
    {{"global", &Indices::global, kIndexUnit,
      "Global index: mean over the poses + standard deviation over the poses (Du et al. 2022, Eqs. 53-54)"},
     {"global_ci_low", &Indices::global_ci_low, kIndexUnit, "Lower end of the interval of global", Presence::always,
      kLevel},
     {"global_ci_high", &Indices::global_ci_high, kIndexUnit, "Upper end of the interval of global", Presence::always,
      kLevel},
     {"global_corrected", &Indices::global_corrected, kIndexUnit,
      "Global index without the sampling noise that 'global' counts as spread between poses; NaN: the error is too "
      "small for its effect to be told from rounding"},
     {"global_corrected_ci_low", &Indices::global_corrected_ci_low, kIndexUnit,
      "Lower end of the interval of global_corrected", Presence::always, kLevel},
     {"global_corrected_ci_high", &Indices::global_corrected_ci_high, kIndexUnit,
      "Upper end of the interval of global_corrected", Presence::always, kLevel},
     {"rounding", &Indices::rounding, kResponseUnit,
      "Up to this an effect, index x sigma, cannot be told from the rounding of solves"},
     {"index_change", &Indices::index_change, "1",
      "Change of 'global' where the error is a tenth as large, by the same few draws at up to 32 poses: index there / "
      "index here - 1; 0: the index holds at other sizes; NaN: not known, or no effect at either size"},
     {"local", &Indices::local, kIndexUnit,
      "Index at each pose: sigma(response) / sigma(error) (Du et al. 2022, Eqs. 51-52)"},
     {"local_ci_low", &Indices::local_ci_low, kIndexUnit, "Lower end of the interval of local", Presence::always,
      kLevel},
     {"local_ci_high", &Indices::local_ci_high, kIndexUnit, "Upper end of the interval of local", Presence::always,
      kLevel},
     {"count", &Indices::count, "1", "Samples behind the index"},
     {"mean", &Indices::mean, kResponseUnit, "Mean of the response over the samples"},
     {"std", &Indices::std, kResponseUnit, "Standard deviation of the response over the samples"},
     {"background", &Indices::background, kResponseUnit,
      "The response with all varied errors zero; NaN where that was not solved"}}};

/// The field that states how much the ranking of errors depends on the points of the platform's metric.
const FieldRow<Indices> kRadiusTau{
    "radius_tau", &Indices::radius_tau, "1",
    "Kendall's tau of the errors' effects with the metric's points so far from their middle and as they are, to first "
    "order, without the background's errors, at up to 32 of the poses",
    Presence::where_computed};

const Axes kHistoryAxes{"response", "factor", "samples"};

const CourseWords kHistory{
    {"/sensitivity/history",
     "The global indices after the first samples of each pose: what a study with so many samples finds; NaN where "
     "undefined",
     kCourseLevel,
     {},
     {{"global", &EstimateCourse::value, kHistoryAxes, kIndexUnit, "Global index after so many samples at each pose"},
      {"global_ci_low", &EstimateCourse::ci_low, kHistoryAxes, kIndexUnit, "Lower end of the interval of global",
       kCourseLevel},
      {"global_ci_high", &EstimateCourse::ci_high, kHistoryAxes, kIndexUnit, "Upper end of the interval of global",
       kCourseLevel}}},
    "samples",
    "Samples at each pose; the last is the study's number",
    "history_",
    "factor",
    {"index", "index_ci_low", "index_ci_high"}};

const CourseWords kConvergence = convergence_words(
    {"response", "factor"}, "index", kIndexUnit, "Global index",
    "An error got samples until, at a milestone, the half-width of every response's global index was at most "
    "relative_error of the index, or the index rounding (below 1e-10), or max was there",
    "factor");

void add_radius_tau(ResultBuilder& result, const Indices& found) {
  if (found.radius_tau.empty()) return;
  result.add_axis("radius_multiple", std::vector<double>(kPointsRadii.begin(), kPointsRadii.end()),
                  {"1", "Distance of the metric's points from their middle, over that in /metric/points"});
  write_fields(result, "/metric", {kRadiusTau}, found);
}

void read_radius_tau(const h5::File& file, Indices& found) {
  read_fields(file, "/metric", {kRadiusTau}, found);
  const std::size_t radii = found.radius_tau.length<axis::RadiusMultiple>();
  if (!found.radius_tau.empty() && radii != kPointsRadii.size()) throw h5::Error("/radius_multiple is of other radii");
}

/// Appends three columns to the table: the index by one estimator ("global" or "global_corrected"), and both ends of
/// its interval. displayed: whether the columns are in display units instead of SI.
void append_index_columns(CsvTable& table, const StoredResult& result, const std::string& estimator, std::size_t r,
                          bool displayed) {
  const NamedUnit& response = result.responses[r];
  const std::string unit = displayed ? std::string(display(response).name) + " per " + display_units(result.factors)
                                     : csv_unit(kIndexUnit, result, &response);
  for (const char* end : {"", "_ci_low", "_ci_high"}) {
    const auto field = std::ranges::find(kIndices.fields, estimator + end, &FieldRow<Indices>::name);
    const auto number = [&result, &response, field, displayed, r](std::size_t p) {
      const double scale = displayed ? display(result.factors[p]).si / display(response).si : 1.0;
      return to_double(field->member->number_in_row(sensitivity_of(result), r, p)) * scale;
    };
    const std::string name = response.name + estimator.substr(std::string_view("global").size()) + end;
    table.columns.push_back({with_unit(name, unit), number});
  }
}

/// The table of global indices by the published estimator and by the corrected one.
CsvTable global_table(const StoredResult& result) {
  CsvTable table = lines_of_factors(result, "global");
  for (const std::string& estimator : {std::string("global"), std::string("global_corrected")}) {
    for (std::size_t r = 0; r < result.responses.size(); ++r) {
      for (const bool displayed : {false, true}) append_index_columns(table, result, estimator, r, displayed);
    }
  }
  return table;
}

CsvTable index_change_table(const StoredResult& result) {
  CsvTable table = lines_of_factors(result, "index_change");
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    table.columns.push_back(list_column(result.responses[r].name, sensitivity_of(result).index_change.row(r)));
  }
  return table;
}

/// Adds to `tables` a table for each response and each field with the axes response, factor and pose.
void append_local_tables(CsvTables& tables, const StoredResult& result) {
  for (const FieldRow<Indices>& field : kIndices.fields) {
    if (field.axes != Indices::Cells<double>::axis_names()) continue;
    for (std::size_t r = 0; r < result.responses.size(); ++r) {
      tables.push_back(response_table(result, r, field, sensitivity_of(result)));
    }
  }
}

void append_solver_tables(CsvTables& tables, const StoredResult& result) {
  const auto& solves = sensitivity_of(result).solves;
  for (const SolveNumber& number : solve_numbers(solves)) {
    CsvTable table = lines_of_factors(result, number.name);
    table.at_poses = {result.poses.size(), "1",
                      [&solves, get = number.get](std::size_t p, std::size_t m) { return get(solves(p, m)); }};
    tables.push_back(std::move(table));
  }
}

void write(ResultBuilder& result, const Study& study, std::any& any) {
  const auto& found = std::any_cast<const Result&>(any);
  const std::vector<FactorIndex>& factors = study.analysis.factors;
  POESY_EXPECTS(found.factors() == factors.size());
  add_names(result, study, factors);
  add_sigma(result, study);
  write_group(result, kIndices, found);
  if (found.history) add_course(result, kHistory, *found.history);
  write_tolerance_group(result, study, found);
  write_separation(result, found.separation);
  write_fidelity(result, found.fidelity);
  add_convergence(result, kConvergence, found.convergence);
  add_radius_tau(result, found);
  add_solver(result, found.solves);
  const auto names = texts(factors, [&](FactorIndex factor) { return study.model().factors[factor.value].name; });
  add_failures(result, found.failures, names, found.total().not_converged());
}

void read(const h5::File& file, StoredResult& result) {
  Result found;
  read_sigma(file, result);
  read_group(file, kIndices, found);
  found.solves = read_solver<decltype(found.solves)>(file);
  read_radius_tau(file, found);
  result.varied = texts(result.factors, &NamedUnit::name);
  result.failures = read_failures(file, result);
  result.convergence = read_convergence(file, kConvergence);
  if (!result.convergence) found.history = read_course(file, kHistory);
  read_tolerance_group(file, result.factors, found);
  found.separation = read_separation(file);
  found.fidelity = read_fidelity(file);
  result.found = std::move(found);
  result.constant = responses_without_effect(result);
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  const Indices& found = sensitivity_of(result);
  append_sigma_tables(tables, result);
  tables.push_back(global_table(result));
  tables.push_back(index_change_table(result));
  append_local_tables(tables, result);
  append_solver_tables(tables, result);
  tables.push_back(failure_table(result));
  append_tolerance_tables(tables, result);
  append_separation_tables(tables, result);
  append_fidelity_tables(tables, result);
  append_convergence_tables(tables, result, kConvergence);
  if (found.history) append_course_tables(tables, result, kHistory, *found.history, {});
}

}  // namespace

std::size_t sensitivity_bytes(const AxisLengths& lengths) { return bytes_of(kIndices.fields, lengths); }

constinit const FileKind kFile{.write = write, .read = read, .append_tables = append_tables};

}  // namespace poesy::sensitivity
