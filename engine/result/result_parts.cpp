#include "engine/result/result_parts.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/study/study_kind.h"

namespace poesy {
namespace {

/// How solves ended, as columns of the group /solver. A cell is a varied error at a pose, or all errors at a pose.
struct SolverColumns {
  std::vector<std::uint64_t> not_converged;   ///< [cells] number of samples whose solves did not converge
  std::vector<double> iterations_mean;        ///< [cells] mean number of iterations of a sample
  std::vector<std::uint32_t> iterations_max;  ///< [cells] largest number of iterations of a sample
  std::vector<std::uint64_t> by_status;       ///< [statuses x cells] number of samples with each status
};

double mean_iterations(const SolveCounts& cell) {
  return static_cast<double>(cell.iterations) / static_cast<double>(cell.total());
}

Fields<SolverColumns> solver_fields(const Axes& cells) {
  Axes by_status{"status"};
  by_status.insert(by_status.end(), cells.begin(), cells.end());
  return {{"not_converged", &SolverColumns::not_converged, cells, "1", "Samples that did not reach their fixed point"},
          {"iterations_mean", &SolverColumns::iterations_mean, cells, "1", "Mean number of iterations of a sample"},
          {"iterations_max", &SolverColumns::iterations_max, cells, "1", "Most iterations of a sample"},
          {"solves_by_status", &SolverColumns::by_status, by_status, "1", "Samples that ended so"}};
}

/// A failed sample, in the form in which a result file lists it.
struct FailureRow {
  std::string factor;
  std::uint64_t pose;
  std::uint64_t sample;
  std::uint8_t status;
};

const Axes kByFailure{"failure"};

const Fields<FailureRow> kFailureFields{
    {"failed_factor", &FailureRow::factor, kByFailure, "1",
     "Samples that failed, by the error that varied; \"all\": all together"},
    {"failed_pose", &FailureRow::pose, kByFailure, "1", "Their poses, by number from 0"},
    {"failed_sample", &FailureRow::sample, kByFailure, "1", "Their numbers at that error and pose, from 0"},
    {"failed_status", &FailureRow::status, kByFailure, "1",
     "How these solves ended: a position in status_names, from 0"}};

constexpr std::string_view kByRow = "row";  ///< value of the attribute `judge` if each row of an error table is judged

const Axes kLimited{"limited_response"};

/// The verdict on one limit, as a file stores it.
struct LimitRow {
  double value = 0.0;
  double limit = 0.0;
  bool passed = false;
  std::uint64_t tried = 0;
  std::uint64_t within = 0;
  std::optional<std::size_t> pose = std::nullopt;
  std::optional<std::size_t> row = std::nullopt;
  double from = 0.0;
  double pose_share = 1.0;
  bool spread = false;
};

/// The datasets of /limits, in the order of the columns of limits.csv.
const Fields<LimitRow> kLimitFields{
    {"value", &LimitRow::value, kLimited, kResponseUnit,
     "What is compared with it, a magnitude; infinite or NaN where too few samples were solved, NaN where nothing is "
     "compared"},
    {"limit", &LimitRow::limit, kLimited, kResponseUnit, "The limit"},
    {"passed", &LimitRow::passed, kLimited, "1", "1: the limit is kept; 0: it is not"},
    {"tried", &LimitRow::tried, kLimited, "1",
     "Draws at all poses together; by yield machines; of an evaluation its rows of errors"},
    {"within", &LimitRow::within, kLimited, "1",
     "Of these, those within the limit, a machine or a row at each of its poses; what was not solved is not"},
    {"pose", &LimitRow::pose, kLimited, "1", "Pose of the value, from 0; -1 where it is of all poses"},
    {"row", &LimitRow::row, kLimited, "1", "Row of errors, or case, of the value, from 0; -1 where there are none"}};

/// Further datasets of /limits. They are written if any limit of the study is not on the magnitude at each pose.
const Fields<LimitRow> kEndFields{
    {"from", &LimitRow::from, kLimited, kResponseUnit,
     "Lower end of the limit, of which /limits/limit is then the upper end: minus infinity or infinity for none, and "
     "-limit where magnitudes or spreads are limited. Otherwise /limits/value is a value with its sign. A file without "
     "this dataset has limits on magnitudes at each pose"},
    {"pose_share", &LimitRow::pose_share, kLimited, "1",
     "Share of the poses of a machine at which the limit is to be kept"},
    {"spread", &LimitRow::spread, kLimited, "1",
     "1: the limit is on the largest less the smallest value over the poses of a machine; 0: on values"}};

LimitRow limit_row(const LimitVerdict& one) {
  return {one.value, one.limit.to(), one.passed,       one.tried,         one.within,
          one.pose,  one.row,        one.limit.from(), one.limit.share(), one.limit.is_spread()};
}

std::vector<LimitRow> rows_of(const LimitVerdicts& verdicts) {
  std::vector<LimitRow> rows;
  std::ranges::transform(verdicts.limits, std::back_inserter(rows), limit_row);
  return rows;
}

bool has_ends(const LimitVerdicts& verdicts) {
  return !std::ranges::all_of(verdicts.limits, [](const LimitVerdict& one) { return one.limit.is_plain(); });
}

/// The verdict in a row of the file, with its limit as a limit on magnitudes; read_limits() replaces other limits by
/// limit_of().
LimitVerdict verdict_of(const LimitRow& row) {
  return {.limit = row.limit,
          .value = row.value,
          .passed = row.passed,
          .tried = row.tried,
          .within = row.within,
          .pose = row.pose,
          .row = row.row};
}

/// The limit in a row of the file that states both ends (kEndFields). Throws h5::Error if no limit can have these
/// numbers.
ValueLimit limit_of(const LimitRow& row) {
  const bool is_possible = row.from < row.limit && row.pose_share > 0.0 && row.pose_share <= 1.0 &&
                           !(row.spread && (row.pose_share < 1.0 || row.from != -row.limit));
  if (!is_possible) throw h5::Error("/limits has a limit that cannot be stated");
  if (row.spread) return ValueLimit::of_spread(row.limit);
  return ValueLimit::between(row.from, row.limit).at_share(row.pose_share);
}

constexpr std::string_view kLimitsMeaning =
    "How each limit of [analysis.limits] was kept. judge: what is compared with it: rms, the root mean square over the "
    "samples of all poses; share, what a share of the draws stays within at the worst pose; yield, what the share of "
    "machines that the study asks for stays within at all poses, each limit taken alone (where it asks for none, a "
    "limit "
    "is kept if every machine is within it), while /yield judges all limits together; row, the largest magnitude of "
    "any "
    "row of errors";

/// The datasets of /convergence that describe how the adaptive sampling ended, with a number for each estimated
/// quantity or for each varied error (slot). They are written after the datasets of the estimates (EstimateCourse).
Fields<ConvergenceResult> end_fields(const CourseWords& words) {
  // all: the axes of the quantities, followed by the axis of the numbers of samples.
  const Axes& all = words.group.fields.front().axes;
  const Axes quantities(all.begin(), all.end() - 1);
  const Axes slots(all.begin() + 1, all.end() - 1);
  return {{"reached", &ConvergenceResult::reached, quantities, "1",
           "1: the half-width at the end is small enough; 0: it is not"},
          {"relative_half_width", &ConvergenceResult::relative_half_width, quantities, "1",
           "Half-width at the end over the magnitude of what it is for; NaN for zero over zero"},
          {"samples", &ConvergenceResult::samples, slots, "1", "Samples at each pose at the end"}};
}

CsvTable end_table(const StoredResult& result, const CourseWords& words, const ConvergenceResult& found) {
  const std::size_t slots = found.samples.size();
  CsvTable table{"convergence", {words.csv_slot, [&](std::size_t slot) { return result.varied[slot]; }}, slots};
  table.columns.push_back(list_column("samples", found.samples));
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const std::string& response = result.responses[r].name;
    const auto of_response = [&](const auto& list) { return std::span(list).subspan(r * slots, slots); };
    table.columns.push_back(list_column(response + "_reached", of_response(found.reached)));
    table.columns.push_back(list_column(response + "_relative_half_width", of_response(found.relative_half_width)));
  }
  return table;
}

constexpr std::string_view kUncorrelated = "-";

const Axes kMeasured{"measured_error"};

const Group<MeasuredErrors> kMeasuredErrors{
    "/measured_errors",
    "Errors that are drawn as parts were measured: each value is as likely as any other, and is spread over a range "
    "around it so that mean and standard deviation are those of the parts",
    {},
    {},
    {{"parts", &MeasuredErrors::parts, kMeasured, "1", "Parts that were measured"},
     {"mean", &MeasuredErrors::mean, kMeasured, kFactorUnit, "Mean of the parts, and of the draws"},
     {"sigma_of_parts", &MeasuredErrors::sigma_of_parts, kMeasured, kFactorUnit,
      "Standard deviation of the parts, with n - 1"},
     {"sigma", &MeasuredErrors::sigma, kMeasured, kFactorUnit, "Standard deviation of the draws, as /factors/sigma"},
     {"least_part", &MeasuredErrors::least_part, kMeasured, kFactorUnit, "The smallest part"},
     {"greatest_part", &MeasuredErrors::greatest_part, kMeasured, kFactorUnit, "The largest part"},
     {"least", &MeasuredErrors::least, kMeasured, kFactorUnit, "No draw is below"},
     {"greatest", &MeasuredErrors::greatest, kMeasured, kFactorUnit, "No draw is above"},
     {"most_correlated", &MeasuredErrors::most_correlated, kMeasured, "1",
      "The error with which it is correlated most; \"-\" for none"},
     {"correlation", &MeasuredErrors::correlation, kMeasured, "1",
      "With that one, of their normal scores; 0 for none"}}};

/// Adds to `found` the name of the error with which this error is correlated most, and their correlation.
void append_correlation(const Study& study, FactorIndex factor, MeasuredErrors& found) {
  std::string name(kUncorrelated);
  double largest = 0.0;
  for (const CorrelatedErrors& block : study.errors.correlated) {
    const auto place = std::ranges::find(block.factors, factor);
    if (place == block.factors.end()) continue;
    const std::size_t size = block.factors.size();
    const auto row = static_cast<std::size_t>(place - block.factors.begin()) * size;
    for (std::size_t j = 0; j < size; ++j) {
      const double own = block.correlation[row + j];
      if (block.factors[j] == factor || !(std::abs(own) > std::abs(largest))) continue;
      largest = own;
      name = study.model().factors[block.factors[j].value].name;
    }
  }
  found.most_correlated.push_back(std::move(name));
  found.correlation.push_back(largest);
}

double sample_deviation(std::span<const double> values, double mean) {
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

/// The table measured_errors.csv, with a line for each error. Its last column is the unit of the error.
CsvTable measured_table(const StoredResult& result) {
  const MeasuredErrors& found = result.measured;
  CsvTable table{"measured_errors",
                 {"factor", [&](std::size_t e) { return found.names[e]; }},
                 found.names.size(),
                 {},
                 {"unit", [&](std::size_t e) { return result.factors[found.factors[e]].unit; }}};
  for (const FieldRow<MeasuredErrors>& field : kMeasuredErrors.fields) {
    if (field.name != "most_correlated") table.columns.push_back(field_column(field.name, field, found));
  }
  return table;
}

}  // namespace

MeasuredErrors measured_errors(const Study& study) {
  MeasuredErrors found;
  for (std::size_t p = 0; p < study.analysis.factors.size(); ++p) {
    const FactorIndex factor = study.analysis.factors[p];
    const auto& parts = study.errors.by_factor[factor.value].parts();
    if (!parts) continue;
    const auto [least, greatest] = std::ranges::minmax(parts->values());
    found.names.push_back(study.model().factors[factor.value].name);
    found.factors.push_back(p);
    found.parts.push_back(parts->values().size());
    found.mean.push_back(parts->mean());
    found.sigma_of_parts.push_back(sample_deviation(parts->values(), parts->mean()));
    found.sigma.push_back(parts->standard_deviation());
    found.least_part.push_back(least);
    found.greatest_part.push_back(greatest);
    found.least.push_back(parts->least());
    found.greatest.push_back(parts->greatest());
    append_correlation(study, factor, found);
  }
  return found;
}

std::vector<double> stated_means(const Study& study) {
  std::vector<double> mean;
  for (const FactorIndex factor : study.analysis.factors) {
    mean.push_back(study.errors.by_factor[factor.value].centre());
  }
  if (std::ranges::all_of(mean, [](double one) { return one == 0.0; })) mean.clear();
  return mean;
}

namespace {

/// Adds to the result file the means that the study states, unless all are 0. Also adds which errors machines draw anew
/// at each pose, if there are such errors.
void add_stated(ResultBuilder& result, const Study& study) {
  if (const std::vector<double> mean = stated_means(study); !mean.empty()) {
    result.add("/factors/mean", {"factor"}, mean, {kFactorUnit, "Mean of the error, as set in the study"});
  }
  const auto is_per_pose = [&](FactorIndex factor) { return study.errors.is_per_pose(factor); };
  if (study.analysis.draws != Draws::per_machine || std::ranges::none_of(study.analysis.factors, is_per_pose)) return;
  const auto draws = texts(study.analysis.factors, [&](FactorIndex factor) {
    return name(is_per_pose(factor) ? Draws::per_pose : Draws::per_machine);
  });
  result.add("/factors/draws", {"factor"}, draws,
             {"1", "Whether a machine draws the error \"per machine\" or anew \"per pose\""});
}

}  // namespace

void add_sigma(ResultBuilder& result, const Study& study) {
  result.add("/factors/sigma", {"factor"}, standard_deviations(study),
             {kFactorUnit, "Standard deviation of the error, as set in the study"});
  const auto shapes = texts(study.analysis.factors,
                            [&](FactorIndex factor) { return name(study.errors.by_factor[factor.value].shape()); });
  result.add("/factors/distribution", {"factor"}, shapes, {"1", "Distribution of the error, as set in the study"});
  add_stated(result, study);
  const MeasuredErrors measured = measured_errors(study);
  if (measured.names.empty()) return;
  result.add_axis("measured_error", measured.names, {"1", "Errors that are drawn as parts were measured"});
  write_group(result, kMeasuredErrors, measured);
}

void read_sigma(const h5::File& file, StoredResult& result) {
  result.factor_sigma = read_along<double>(file, "/factors/sigma", {"factor"});
  result.factor_distribution = read_along<std::string>(file, "/factors/distribution", {"factor"});
  check_names(result.factor_distribution, "/factors/distribution");
  if (file.exists("/factors/mean")) result.factor_mean = read_along<double>(file, "/factors/mean", {"factor"});
  if (file.exists("/factors/draws")) {
    result.factor_draws = read_along<std::string>(file, "/factors/draws", {"factor"});
    check_names(result.factor_draws, "/factors/draws");
  }
  if (!file.exists("/measured_errors")) return;
  result.measured.names = file.read<std::string>("/measured_error");
  check_names(result.measured.names, "/measured_error");
  for (const std::string& name : result.measured.names) {
    result.measured.factors.push_back(position_in(
        result.factors, name, "/measured_error has '" + name + "', which is not an error", &NamedUnit::name));
  }
  read_group(file, kMeasuredErrors, result.measured);
  check_names(result.measured.most_correlated, "/measured_errors/most_correlated");
}

void append_sigma_tables(CsvTables& tables, const StoredResult& result) {
  CsvTable table = lines_of_factors(result, "factors");
  table.columns = {list_column(with_unit("sigma", si_units(result.factors)), result.factor_sigma),
                   {with_unit("sigma", display_units(result.factors)),
                    [&](std::size_t p) { return result.factor_sigma[p] / display(result.factors[p]).si; }}};
  if (!result.factor_mean.empty()) {
    table.columns.push_back(list_column(with_unit("mean", si_units(result.factors)), result.factor_mean));
  }
  if (!result.factor_draws.empty()) {
    table.rest.push_back({"draws", [&](std::size_t p) { return result.factor_draws[p]; }});
  }
  tables.push_back(std::move(table));
  if (!result.measured.names.empty()) tables.push_back(measured_table(result));
}

std::vector<std::size_t> constant_responses(std::span<const std::uint8_t> varies) {
  std::vector<std::size_t> list;
  for (std::size_t r = 0; r < varies.size(); ++r) {
    if (varies[r] == 0) list.push_back(r);
  }
  return list;
}

std::vector<std::string> listed_statuses(const SolveCounts& solves) {
  std::size_t count = kStatusNames.size();
  while (count > kLeastStatuses && solves.by_status[count - 1] == 0) --count;
  return texts(std::span(kStatusNames).first(count), std::identity());
}

std::size_t listed_statuses(const h5::File& file) {
  const auto names = file.read<std::string>("/status");
  const bool is_length = names.size() >= kLeastStatuses && names.size() <= kStatusNames.size();
  if (!is_length || !std::ranges::equal(names, std::span(kStatusNames).first(names.size()))) {
    throw h5::Error("/status lists other endings of solves");
  }
  return names.size();
}

void add_solver(ResultBuilder& result, const Axes& axes, std::span<const SolveCounts> solves) {
  SolverColumns columns;
  for (const SolveCounts& cell : solves) {
    columns.not_converged.push_back(cell.not_converged());
    columns.iterations_mean.push_back(mean_iterations(cell));
    columns.iterations_max.push_back(cell.most_iterations);
  }
  const std::vector<std::string> statuses = listed_statuses(total_of(solves));
  for (std::size_t status = 0; status < statuses.size(); ++status) {
    for (const SolveCounts& cell : solves) columns.by_status.push_back(cell.by_status[status]);
  }
  result.add_axis("status", statuses, {"1", "How a solve ended"});
  result.file().make_group("/solver");
  const Fields<SolverColumns> fields = solver_fields(axes);
  write_fields(result, "/solver", fields, columns);
  result.show_axes("/solver", fields.back().axes);
}

std::vector<SolveCounts> read_solver(const h5::File& file, const Axes& axes) {
  const std::size_t statuses = listed_statuses(file);
  SolverColumns columns;
  read_fields(file, "/solver", solver_fields(axes), columns);
  const std::size_t cells = columns.iterations_mean.size();
  const ArrayView<const std::uint64_t, Axis<"status">, Axis<"cell">> by_status(columns.by_status, {statuses, cells});
  std::vector<SolveCounts> solves(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    SolveCounts& counts = solves[cell];
    for (std::size_t status = 0; status < statuses; ++status) {
      counts.by_status[status] = by_status(status, cell);
    }
    // The sum of iterations is not stored. The stored mean times the number of samples, rounded to a whole number,
    // gives it exactly. Without samples the mean is NaN.
    const auto total = static_cast<double>(counts.total());
    const double sum = columns.iterations_mean[cell] * total;
    if (total > 0.0) counts.iterations = static_cast<std::uint64_t>(std::llround(sum));
    counts.most_iterations = columns.iterations_max[cell];
  }
  return solves;
}

std::vector<SolveNumber> solve_numbers(std::span<const SolveCounts> solves) {
  std::vector<SolveNumber> list{
      {"not_converged", [](const SolveCounts& cell) { return to_number(cell.not_converged()); }},
      {"iterations_mean", mean_iterations},
      {"iterations_max", [](const SolveCounts& cell) { return to_number(cell.most_iterations); }}};
  const std::vector<std::string> statuses = listed_statuses(total_of(solves));
  for (std::size_t status = 0; status < statuses.size(); ++status) {
    list.push_back({"solves_" + statuses[status],
                    [status](const SolveCounts& cell) { return to_number(cell.by_status[status]); }});
  }
  return list;
}

void append_solve_columns(CsvTable& table, std::span<const SolveCounts> solves) {
  for (const SolveNumber& number : solve_numbers(solves)) {
    table.columns.push_back(list_column(number.name, solves, number.get));
  }
}

void add_failures(ResultBuilder& result, const std::vector<Failure>& failures, const std::vector<std::string>& slots,
                  std::uint64_t total) {
  std::vector<FailureRow> rows;
  for (const auto& [slot, pose, failed] : failures) {
    rows.push_back({slots[slot], pose.value, failed.sample.value, static_cast<std::uint8_t>(failed.status)});
  }
  result.add_axis("failure", axis_numbers(rows.size()), {"1", "Number of the listed failure, from 0"});
  result.show_axes("/solver", kByFailure);
  write_columns(result, "/solver", kFailureFields, rows);
  h5::File& file = result.file();
  const auto status_names = file.read<std::string>("/status");
  file.set_attribute("/solver/failed_status", "status_names", std::span(status_names));
  file.set_attribute("/solver", "failures", static_cast<std::int64_t>(total));
  file.set_attribute("/solver", "most_failures_listed", static_cast<std::int64_t>(kMostFailuresListed));
  file.set_attribute("/solver", "most_failures_of_a_cell", static_cast<std::int64_t>(FailedSamples::kMost));
}

std::vector<Failure> read_failures(const h5::File& file, const StoredResult& result) {
  std::vector<Failure> failures;
  for (const FailureRow& row : read_columns(file, "/solver", kFailureFields)) {
    if (row.pose >= result.poses.size()) throw h5::Error("/solver/failed_pose names an unknown pose");
    if (row.status >= kStatusNames.size()) throw h5::Error("/solver/failed_status holds an unknown status");
    const std::size_t slot = position_in(result.varied, row.factor, "/solver/failed_factor names an unknown error");
    failures.push_back({slot, PoseIndex(row.pose), {SampleIndex(row.sample), static_cast<SolveStatus>(row.status)}});
  }
  return failures;
}

CsvTable failure_table(const StoredResult& result) {
  const std::vector<Failure>& list = result.failures;
  return {"failures",
          {"factor", [&](std::size_t line) { return result.varied[list[line].slot]; }},
          list.size(),
          {list_column("pose", list, [](const Failure& failure) { return failure.pose.value; }),
           list_column("sample", list, [](const Failure& failure) { return failure.failed.sample.value; }),
           list_column("status", list, [](const Failure& failure) { return failure.failed.status; })}};
}

void add_limits(ResultBuilder& result, const ModelDescription& model, const std::optional<LimitVerdicts>& verdicts) {
  if (!verdicts) return;
  const auto names =
      texts(verdicts->limits, [&](const LimitVerdict& one) { return model.responses[one.response].name; });
  const Label label{"1", "Name of the response that has a limit"};
  result.add_axis("limited_response", names, label);
  h5::File& file = result.file();
  file.make_group("/limits");
  result.show_axes("/limits", kLimited);
  file.set_attribute("/limits", "description", std::string(kLimitsMeaning));
  file.set_attribute("/limits", "judge", std::string(verdicts->judge ? name(*verdicts->judge) : kByRow));
  if (verdicts->judge == Judge::share) file.set_attribute("/limits", "share", verdicts->share);
  result.add("/limits/response", kLimited, names, label);
  const std::vector<LimitRow> rows = rows_of(*verdicts);
  write_columns(result, "/limits", kLimitFields, rows);
  if (has_ends(*verdicts)) write_columns(result, "/limits", kEndFields, rows);
}

std::optional<LimitVerdicts> read_limits(const h5::File& file, const StoredResult& result) {
  if (!file.exists("/limits")) return std::nullopt;
  LimitVerdicts verdicts;
  const auto judge = file.attribute<std::string>("/limits", "judge").at(0);
  const auto word = std::ranges::find(kJudges, judge, [](Judge one) { return name(one); });
  if (word != kJudges.end()) verdicts.judge = *word;
  if (word == kJudges.end() && judge != kByRow) throw h5::Error("/limits has the unknown judge '" + judge + "'");
  if (verdicts.judge == Judge::share) verdicts.share = file.attribute<double>("/limits", "share").at(0);
  const auto names = read_along<std::string>(file, "/limits/response", kLimited);
  const std::vector<LimitRow> rows = read_columns(file, "/limits", kLimitFields);
  std::vector<LimitRow> ends;
  if (file.exists("/limits/from")) ends = read_columns(file, "/limits", kEndFields);
  for (std::size_t k = 0; k < names.size(); ++k) {
    LimitVerdict& one = verdicts.limits.emplace_back(verdict_of(rows[k]));
    if (!ends.empty()) {
      ends[k].limit = rows[k].limit;
      one.limit = limit_of(ends[k]);
    }
    one.response = position_in(result.responses, names[k], "/limits names an unknown response", &NamedUnit::name);
    if ((one.pose && *one.pose >= result.poses.size()) || (one.row && *one.row >= one.tried)) {
      throw h5::Error("/limits names a place that does not exist");
    }
  }
  return verdicts;
}

void append_limit_table(CsvTables& tables, const StoredResult& result) {
  if (!result.verdicts) return;
  const std::vector<LimitVerdict>& limits = result.verdicts->limits;
  const auto response = [&](std::size_t line) -> const NamedUnit& { return result.responses[limits[line].response]; };
  CsvTable table{"limits",
                 {"response", [response](std::size_t line) { return response(line).name; }},
                 limits.size(),
                 {},
                 {"unit", [response](std::size_t line) { return response(line).unit; }}};
  const auto add = [&](const Fields<LimitRow>& fields) {
    for (const FieldRow<LimitRow>& field : fields) {
      table.columns.push_back(list_column(
          field.name, limits, [&](const LimitVerdict& one) { return number_at(field, limit_row(one), 0); }));
    }
  };
  add(kLimitFields);
  if (has_ends(*result.verdicts)) add(kEndFields);
  tables.push_back(std::move(table));
}

CourseWords convergence_words(Axes axes, const std::string& name, const std::string& unit, const std::string& quantity,
                              const std::string& rule, const std::string& csv_slot) {
  axes.emplace_back("milestone");
  return {{"/convergence",
           rule + ". The half-width is the larger distance from the value to an end of its interval",
           kCourseLevel,
           {},
           {{name, &EstimateCourse::value, axes, unit, quantity + " at each milestone; NaN after its samples ended"},
            {"half_width", &EstimateCourse::half_width, axes, unit,
             "Half-width of its interval at each milestone; NaN after its samples ended"}}},
          "milestone",
          "Samples at each pose when the intervals were looked at",
          "convergence_",
          csv_slot,
          {name, "half_width"}};
}

void add_course(ResultBuilder& result, const CourseWords& words, const EstimateCourse& found) {
  result.add_axis(words.samples_axis, found.samples, {"1", words.samples_description});
  write_group(result, words.group, found);
}

EstimateCourse read_course(const h5::File& file, const CourseWords& words) {
  EstimateCourse found;
  found.samples = file.read<std::uint64_t>("/" + words.samples_axis);
  read_group(file, words.group, found);
  return found;
}

void append_course_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words,
                          const EstimateCourse& found, std::span<const std::uint64_t> ends) {
  const std::size_t numbers = found.samples.size();
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    const std::size_t lines = found.value.size() / result.responses.size();
    CsvTable table{words.csv + response.name,
                   {words.csv_slot, [&, numbers](std::size_t line) { return result.varied[line / numbers]; }},
                   lines};
    table.columns.push_back(
        {"samples", [&, numbers](std::size_t line) { return to_number(found.samples[line % numbers]); }});
    for (std::size_t k = 0; k < words.group.fields.size(); ++k) {
      const FieldRow<EstimateCourse>& field = words.group.fields[k];
      const std::string unit = csv_unit(field.unit, result, &response);
      table.columns.push_back(field_column(with_unit(words.csv_columns[k], unit), field, found, r * lines));
    }
    if (!ends.empty()) {
      table.has = [&found, ends, numbers](std::size_t line) {
        return found.samples[line % numbers] <= ends[line / numbers];
      };
    }
    tables.push_back(std::move(table));
  }
}

void add_convergence(ResultBuilder& result, const CourseWords& words, const std::optional<ConvergenceResult>& found) {
  if (!found) return;
  add_course(result, words, found->course);
  write_fields(result, "/convergence", end_fields(words), *found);
  h5::File& file = result.file();
  file.set_attribute("/convergence", "relative_error", found->relative_error);
  const std::vector<std::uint64_t> limits{found->min, found->max};
  file.set_attribute("/convergence", "min", std::span(limits).first(1));
  file.set_attribute("/convergence", "max", std::span(limits).last(1));
}

std::optional<ConvergenceResult> read_convergence(const h5::File& file, const CourseWords& words) {
  if (!file.exists("/convergence")) return std::nullopt;
  ConvergenceResult found;
  found.course = read_course(file, words);
  const auto number = [&](const char* name) {
    return static_cast<std::size_t>(file.attribute<std::uint64_t>("/convergence", name).at(0));
  };
  found.min = number("min");
  found.max = number("max");
  found.relative_error = file.attribute<double>("/convergence", "relative_error").at(0);
  read_fields(file, "/convergence", end_fields(words), found);
  return found;
}

void append_convergence_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words) {
  const std::optional<ConvergenceResult>& found = result.convergence;
  if (!found) return;
  tables.push_back(end_table(result, words, *found));
  append_course_tables(tables, result, words, found->course, found->samples);
}

}  // namespace poesy
