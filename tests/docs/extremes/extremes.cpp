#include "tests/docs/extremes/extremes.h"

#include "engine/base/nan.h"
#include "engine/report/display.h"
#include "engine/result/result_parts.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/pose_fold.h"

namespace poesy::extremes {
namespace {

const std::vector<std::string> kEnds{"smallest", "largest"};
/// The axis for the smallest and the largest value; its entries are kEnds.
using End = Axis<"end">;

/// The extreme values of the samples at some poses: at one pose for a unit, at all poses for a study.
struct Extremes {
  Array<double, axis::Response, End, axis::Pose> value;          ///< SI; NaN if no sample counts
  Array<std::uint64_t, axis::Response, End, axis::Pose> sample;  ///< the first sample with this value
  std::vector<SolveCounts> solves;                               ///< [poses] how solves ended
  std::vector<FailedSamples> failed;                             ///< [poses] the first failed samples

  Extremes() = default;
  Extremes(std::size_t responses, std::size_t poses)
      : value({responses, kEnds.size(), poses}, kNaN), sample(value.lengths()), solves(poses), failed(poses) {}

  void add(std::size_t r, std::size_t m, double y, std::uint64_t of) {
    for (const std::size_t end : {0U, 1U}) {
      const bool is_held = end == 0 ? value(r, end, m) <= y : value(r, end, m) >= y;
      if (is_held || std::isnan(y)) continue;
      value(r, end, m) = y;
      sample(r, end, m) = of;
    }
  }
  /// Adds later samples of pose m. from: position of this pose in `later`.
  void merge(std::size_t m, const Extremes& later, std::size_t from = 0) {
    for (std::size_t r = 0; r < value.length<axis::Response>(); ++r) {
      for (const std::size_t end : {0U, 1U}) add(r, m, later.value(r, end, from), later.sample(r, end, from));
    }
    solves[m].merge(later.solves[from]);
    failed[m].merge(later.failed[from]);
  }
  void merge(const Extremes& later) {
    for (std::size_t m = 0; m < solves.size(); ++m) merge(m, later, m);
  }
  void state(Archive& archive, std::size_t m, std::uint64_t first) {
    for (std::size_t r = 0; r < value.length<axis::Response>(); ++r) {
      archive.real(value(r, 0, m), value(r, 1, m));
      for (const std::size_t end : {0U, 1U}) archive.number(sample(r, end, m));
    }
    ends_state(archive, solves[m], failed[m], first);
  }
};

/// A job of PoseFold. All errors vary together, so a cell of the plan is a pose.
struct Job {
  const Plan& plan;
  const Model& model;
  static constexpr std::string_view kName = "extremes";
  std::size_t responses() const { return model.description().responses.size(); }
  std::vector<std::uint64_t> sizes() const { return {responses()}; }
  Rounds::Rule rule() const { return {responses(), all_positions(responses()), 0.0, std::vector(responses(), 0.0)}; }
  auto worker() const {
    return [this, evaluate = PoseUnitEvaluator(plan, model)](const WorkUnit& unit) mutable {
      const UnitOutcomes outcomes = evaluate.solve(unit);
      const ArrayView<const double, axis::Response, axis::Sample> y(outcomes.responses, {responses(), unit.count});
      Extremes found(responses(), 1);
      for (std::size_t b = 0; b < unit.count; ++b) {
        const SampleIndex sample(unit.first.value + b);
        found.solves[0].add(outcomes.status[b], outcomes.iterations[b]);
        found.failed[0].add(sample, outcomes.status[b]);
        if (!counts(outcomes.status[b], plan.not_converged())) continue;
        for (std::size_t r = 0; r < responses(); ++r) found.add(r, 0, y(r, b), sample.value);
      }
      return found;
    };
  }
  void unit_state(Archive& archive, const WorkUnit& unit, Extremes& found) const {
    if (archive.reads()) found = Extremes(responses(), 1);
    found.state(archive, 0, unit.first.value);
  }
  CellSums<Extremes> sums(const Plan& of, const Shard& shard) const { return {of, responses(), shard}; }
  /// The intervals are unknown (NaN), so an adaptive study draws its maximum number of samples.
  auto estimates(const auto&, std::size_t) const { return std::vector(responses(), Estimate{kNaN, {kNaN, kNaN}}); }
};

std::optional<StudyResult> run(const StudyRun& study) {
  const Plan plan(study.study, study.poses);
  const Job job{plan, study.model};
  PoseFold work(plan, job, study.options);
  if (!fold(work, study.options) || study.options.shard || !study.makes_result()) return std::nullopt;
  return StudyResult{std::move(work.sums()).cells(), std::nullopt, {}};
}

Outlook outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const auto plan = std::make_shared<const Plan>(study, poses);
  const std::size_t bytes = 32 * poses.size() * model.description().responses.size();
  const WorkOutlook all = sampling<PoseUnitEvaluator>(plan, borrowed(model), 1.0);
  return {.solves = solves_text(*plan, 1), .memory = {bytes, bytes, bytes, bytes}, .shared = {all}, .by_one = {}};
}

const Extremes& of(const StoredResult& result) { return found_of<Extremes>(result); }
const Group<Extremes> kGroup{.path = "/extremes",
                             .description = "The smallest and the largest value of each response at each pose",
                             .fields = {{"value", &Extremes::value, kResponseUnit, "NaN where no sample counts"},
                                        {"sample", &Extremes::sample, "1", "The first that has this value"}}};

void write(ResultBuilder& result, const Study& study, std::any& any) {
  const auto& found = std::any_cast<const Extremes&>(any);
  std::vector<Failure> failures;
  for (std::size_t m = 0; m < found.failed.size(); ++m) append_failures(0, PoseIndex(m), found.failed[m], failures);
  add_names(result, study, study.analysis.factors);
  result.add_axis("end", kEnds, {"1", "Which end of a response's values"});
  write_group(result, kGroup, found);
  add_solver(result, kByPose, found.solves);
  add_failures(result, failures, {std::string(kAllFactors)}, total_of(found.solves).not_converged());
}

void read(const h5::File& file, StoredResult& result) {
  Extremes found;
  read_group(file, kGroup, found);
  found.solves = read_solver(file, kByPose);
  result.varied = {std::string(kAllFactors)};  // gives each sample an address for `poesy replay`
  result.failures = read_failures(file, result);
  result.found = std::move(found);
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  const Extremes& found = of(result);
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    CsvTable& table = tables.emplace_back(lines_of_poses(result, "extremes_" + result.responses[r].name));
    for (const std::size_t end : {0U, 1U}) {
      table.columns.push_back(list_column(with_unit(kEnds[end], result.responses[r].unit), found.value.row(r, end)));
      table.columns.push_back(list_column(kEnds[end] + "_sample", found.sample.row(r, end)));
    }
  }
}

std::vector<Table> tables(const StoredResult& result, const TableOptions&) {
  const Extremes& found = of(result);
  Table table{"extremes",
              "How far responses go, with the pose and the sample that 'poesy replay' takes",
              {text_column("response", "response"), text_column("end", "end"), text_column("value", "value"),
               number_column("pose", "pose"), number_column("sample", "sample")}};
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    for (std::size_t end = 0; end < kEnds.size(); ++end) {
      const auto values = found.value.row(r, end);
      const auto at = end == 0 ? std::ranges::min_element(values) : std::ranges::max_element(values);
      const auto m = static_cast<std::size_t>(at - values.begin());
      table.rows.push_back({text_cell(result.responses[r].name), text_cell(kEnds[end]),
                            text_cell(response_text(result.responses[r], *at)), count_cell(m),
                            count_cell(found.sample(r, end, m))});
    }
  }
  return {table};
}

Comparable comparable(const StoredResult& result, const StoredResult&) {
  Comparable all = comparable_by_response(result, "end", kEnds);
  add_quantity(all, result, "at the first pose", "extremes",
               [&](std::size_t r, std::size_t end) { return of(result).value(r, end, 0); });
  return all;
}
void page(const StoredResult&, std::span<const Table> all, Page& page) {
  for (const Table& table : all) page.add_section("extremes", "How far responses go").table(table);
}

SolveTally tally(const StoredResult& result) { return {"", {"all errors"}, result.poses.size(), of(result).solves}; }
StudyWords words(const StoredResult&) { return {.draws = true}; }
Answer answer(const StoredResult&) { return {{"Answer", "how far each response goes, with the address"}}; }
ShownCells cells(const StoredResult& result) { return shown_cells(result, kEnds.size()); }
AtPose asked(const Study& study) { return {2.0, "ends", static_cast<double>(study.analysis.samples), "samples"}; }

constexpr std::string_view kKeys[] = {"factors", "samples", "background"};
const StudyKind kStudy{
    .name = "extremes", .asks = "how far responses go", .keys = kKeys, .varies = Varies::together, .at_pose = asked};
constinit const FileKind kFile{write, read, append_tables};
constinit const ReportKind kReport{.tally = tally,
                                   .tables = tables,
                                   .words = words,
                                   .answer = answer,
                                   .shown_cells = cells,
                                   .page = page,
                                   .comparable = comparable};

}  // namespace

constinit const Kind kKind{kStudy, {run, outlook, shards_by_pose}, kFile, kReport};

}  // namespace poesy::extremes
