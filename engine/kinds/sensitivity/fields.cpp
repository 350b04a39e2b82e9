#include <algorithm>

#include "engine/files/result_parts.h"
#include "engine/kinds/sensitivity/options.h"

namespace poesy {
namespace {

using Indices = SensitivityResult;

const std::vector<Attribute<Indices>> kLevel{{"conf_level", &Indices::conf_level}};

const Group<Indices> kIndices{
    "/sensitivity",
    "Sensitivity of each response to each error: sigma(response) / sigma(error), one error varying at a time; NaN "
    "where undefined",
    kLevel,
    {{"response", &Indices::responses}, {"factor", &Indices::factors}, {"pose", &Indices::poses}},
    {{"global", &Indices::global, kByResponseFactor, kIndexUnit,
      "Global index: mean over the poses + standard deviation over the poses (Du et al. 2022, Eqs. 53-54)"},
     {"global_ci_low", &Indices::global_ci_low, kByResponseFactor, kIndexUnit, "Lower end of the interval of global",
      "", kLevel},
     {"global_ci_high", &Indices::global_ci_high, kByResponseFactor, kIndexUnit, "Upper end of the interval of global",
      "", kLevel},
     {"global_corrected", &Indices::global_corrected, kByResponseFactor, kIndexUnit,
      "Global index without the sampling noise that 'global' counts as spread between poses; NaN: the error is too "
      "small for its effect to be told from rounding",
      "global_corrected"},
     {"global_corrected_ci_low", &Indices::global_corrected_ci_low, kByResponseFactor, kIndexUnit,
      "Lower end of the interval of global_corrected", "global_corrected", kLevel},
     {"global_corrected_ci_high", &Indices::global_corrected_ci_high, kByResponseFactor, kIndexUnit,
      "Upper end of the interval of global_corrected", "global_corrected", kLevel},
     {"rounding", &Indices::rounding, kByResponse, kResponseUnit,
      "Up to this an effect, index x sigma, cannot be told from the rounding of solves", "global_corrected"},
     {"index_change", &Indices::index_change, kByResponseFactor, "1",
      "Change of 'global' where the error is a tenth as large, by the same few draws at up to 32 poses: index there / "
      "index here - 1; 0: the index holds at other sizes; NaN: not known, or no effect at either size",
      "index_change"},
     {"local", &Indices::local, kByResponseFactorPose, kIndexUnit,
      "Index at each pose: sigma(response) / sigma(error) (Du et al. 2022, Eqs. 51-52)"},
     {"local_ci_low", &Indices::local_ci_low, kByResponseFactorPose, kIndexUnit, "Lower end of the interval of local",
      "", kLevel},
     {"local_ci_high", &Indices::local_ci_high, kByResponseFactorPose, kIndexUnit, "Upper end of the interval of local",
      "", kLevel},
     {"count",
      &Indices::count,
      kByResponseFactorPose,
      "1",
      "Samples behind the index",
      "",
      {},
      Stored::as_whole_numbers},
     {"mean", &Indices::mean, kByResponseFactorPose, kResponseUnit, "Mean of the response over the samples"},
     {"std", &Indices::std, kByResponseFactorPose, kResponseUnit,
      "Standard deviation of the response over the samples"},
     {"background", &Indices::background, kByResponsePose, kResponseUnit,
      "The response with all varied errors zero; NaN where that was not solved", "background"}}};

/// The index by one estimator ("global", "global_corrected") with its interval, in SI or in the units people read.
void append_index_columns(CsvTable& table, const StoredResult& result, const std::string& estimator, std::size_t r,
                          bool displayed) {
  const NamedUnit& response = result.responses[r];
  const std::string unit = displayed ? std::string(display(response).name) + " per " + display_units(result.factors)
                                     : csv_unit(kIndexUnit, result, &response);
  for (const char* end : {"", "_ci_low", "_ci_high"}) {
    const auto field = std::ranges::find(kIndices.fields, estimator + end, &FieldRow<Indices>::name);
    const auto number = [&result, &response, field, displayed, r](std::size_t p) {
      const double scale = displayed ? display(result.factors[p]).si / display(response).si : 1.0;
      return number_at(*field, result.sensitivity, r * result.factors.size() + p) * scale;
    };
    const std::string name = response.name + estimator.substr(std::string_view("global").size()) + end;
    table.columns.push_back({with_unit(name, unit), number});
  }
}

/// By the published estimator, and by the corrected one where the file has it.
CsvTable global_table(const StoredResult& result) {
  CsvTable table = lines_of_factors(result, "global");
  for (const std::string& estimator : {std::string("global"), std::string("global_corrected")}) {
    if (estimator == "global_corrected" && result.sensitivity.global_corrected.empty()) continue;
    for (std::size_t r = 0; r < result.responses.size(); ++r) {
      for (const bool displayed : {false, true}) append_index_columns(table, result, estimator, r, displayed);
    }
  }
  return table;
}

CsvTable index_change_table(const StoredResult& result) {
  CsvTable table = lines_of_factors(result, "index_change");
  const std::size_t factors = result.factors.size();
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    table.columns.push_back(list_column(result.responses[r].name, result.sensitivity.index_change, r * factors));
  }
  return table;
}

/// A table for each row along [response x factor x pose] and response.
void append_local_tables(CsvTables& tables, const StoredResult& result) {
  for (const FieldRow<Indices>& field : kIndices.fields) {
    if (field.axes != kByResponseFactorPose) continue;
    for (std::size_t r = 0; r < result.responses.size(); ++r) {
      const NamedUnit& response = result.responses[r];
      const std::size_t first = r * result.factors.size() * result.poses.size();
      CsvTable table = lines_of_factors(result, field.name + "_" + response.name);
      append_pose_columns(table, result, field, result.sensitivity, first, csv_unit(field.unit, result, &response));
      tables.push_back(std::move(table));
    }
  }
}

void append_solver_tables(CsvTables& tables, const StoredResult& result) {
  const std::size_t poses = result.poses.size();
  for (const SolveNumber& number : solve_numbers()) {
    CsvTable table = lines_of_factors(result, number.name);
    for (std::size_t m = 0; m < poses; ++m) {
      table.columns.push_back(
          list_column("pose_" + std::to_string(m), result.sensitivity.solves, m, poses, number.get));
    }
    tables.push_back(std::move(table));
  }
}

}  // namespace

void add_sensitivity(ResultBuilder& result, const Study& study, const SensitivityResult& found) {
  add_sigma(result, study);
  write_group(result, kIndices, found);
  add_history(result, found.history);
  add_tolerances(result, study, found);
  add_separation(result, study, found.separation);
  add_fidelity(result, study, found.fidelity);
  add_convergence(result, kSensitivityStudy, found.convergence);
  if (!found.radius_tau.empty()) add_radius_tau(result, found.radius_tau);
  add_solver(result, {"factor", "pose"}, found.solves);
  const auto names =
      texts(study.analysis.factors, [&](FactorIndex factor) { return study.model().factors[factor.value].name; });
  add_failures(result, found.failures, names, found.total().not_converged());
}

void read_sensitivity(const h5::File& file, StoredResult& result) {
  read_sigma(file, result);
  if (file.exists("/factors/distribution")) {
    result.factor_distribution = read_along<std::string>(file, "/factors/distribution", {"factor"});
    check_names(result.factor_distribution, "/factors/distribution");
  }
  SensitivityResult& found = result.sensitivity;
  read_group(file, kIndices, found);
  found.solves = read_solver(file, {"factor", "pose"});
  found.radius_tau = read_radius_tau(file);
  found.history = read_history(file);
  found.failures = read_failures(file, result);
  found.convergence = read_convergence(file, kSensitivityStudy);
  read_tolerances(file, result);
  read_separation(file, result);
  read_fidelity(file, result);
}

void append_sensitivity_tables(CsvTables& tables, const StoredResult& result) {
  tables.push_back(sigma_table(result));
  tables.push_back(global_table(result));
  if (!result.sensitivity.index_change.empty()) tables.push_back(index_change_table(result));
  append_local_tables(tables, result);
  append_solver_tables(tables, result);
  tables.push_back(failure_table(result));
  append_tolerance_tables(tables, result);
  append_separation_tables(tables, result);
  append_fidelity_tables(tables, result);
  append_convergence_tables(tables, result, kSensitivityStudy, result.sensitivity.convergence);
  append_history_tables(tables, result);
}

}  // namespace poesy
