#include "engine/kinds/monte_carlo/kind.h"

#include <string_view>
#include <utility>

#include "engine/kinds/monte_carlo/collector.h"
#include "engine/kinds/monte_carlo/machine_collector.h"
#include "engine/kinds/monte_carlo/machine_table.h"
#include "engine/kinds/monte_carlo/machine_unit.h"
#include "engine/kinds/monte_carlo/outlook.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/monte_carlo/yield.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/pose_fold.h"
#include "engine/run/response_rounding.h"
#include "engine/run/rounds.h"
#include "engine/run/unit_fold.h"

namespace poesy::monte_carlo {
namespace {

/// [responses] The mean over the samples of all poses, with its interval.
std::vector<Estimate> overall_means(const Result& found) {
  std::vector<Estimate> means;
  for (std::size_t r = 0; r < found.responses(); ++r) {
    means.push_back(stratified_mean({found.count.row(r), found.mean.row(r), found.std.row(r)}, found.conf_level));
  }
  return means;
}

/// The rule by which adaptive sampling ends: it compares the intervals of the means of the responses that a summary
/// shows (the headline, or all responses if the model selects none).
Rounds::Rule rule_of(const Model& model, const Analysis& analysis) {
  const ModelDescription& description = model.description();
  const std::size_t responses = description.responses.size();
  return {responses, description.headline.empty() ? all_positions(responses) : description.headline,
          analysis.conf_level, std::vector<double>(responses, 0.0)};
}

/// The job of a PoseFold (run/pose_fold.h): solves draws of all errors together, pose by pose.
struct PoseJob {
  const Plan& plan;
  const Model& model;
  const Analysis& analysis;
  bool keeps_checkpoint;

  static constexpr std::string_view kName = "monte-carlo";
  std::size_t responses() const { return model.description().responses.size(); }
  std::vector<std::uint64_t> sizes() const { return {responses(), asked_of<Options>(analysis).quantiles.size()}; }
  Rounds::Rule rule() const { return rule_of(model, analysis); }
  PoseUnitEvaluator worker() const { return {plan, model}; }
  void unit_state(Archive& archive, const WorkUnit& unit, PoseUnit& found) const {
    if (archive.reads()) found.responses.resize(responses());
    found.state(archive, plan.factors().size(), unit.first.value);
  }
  Collector sums(const Plan& of, const Shard&) const { return {of, responses(), analysis, keeps_checkpoint}; }
  static std::vector<Estimate> estimates(const Collector& sums, std::size_t) { return overall_means(sums.finished()); }
};

/// The job of a UnitFold (run/unit_fold.h): solves units of machines at all poses, for a study that draws errors per
/// machine.
struct MachineJob {
  const Plan& plan;
  const Model& model;
  const Analysis& analysis;
  const MachineCalibration* calibration;
  bool keep_rejected;
  MachineTable table{plan, model, analysis, calibration, keep_rejected};

  static constexpr std::string_view kName = "machines";
  std::vector<std::uint64_t> sizes() const { return {table.responses(), plan.poses().size(), table.errors()}; }
  NumberRange units(const Shard& shard) const { return shard.of(table.units()); }
  std::uint64_t expected(std::size_t n) const { return std::uint64_t{table.unit(n).count} * plan.poses().size(); }
  MachineUnitEvaluator worker() const { return {table, model}; }
  MachineUnit unit(std::size_t n) const {
    const WorkUnit unit = table.unit(n);
    return {table, {unit.first.value, unit.first.value + unit.count}};
  }
  static SolveCounts solves(std::size_t, const MachineUnit& unit) { return unit.total; }
  MachineCollector sums() const { return {table, analysis}; }
  Rounds rounds() const { return {plan, rule_of(model, analysis)}; }
  std::size_t samples() const { return plan.samples(); }
  std::size_t units_for(std::size_t samples) const { return table.units_for(samples); }
  bool is_whole(std::size_t n) const { return table.is_whole(n); }
  static std::vector<Estimate> estimates(const MachineCollector& sums, const MachineUnit*) {
    return sums.overall_means();
  }
};

/// The largest number of shards. A study with draws per machine is divided into units of machines, a study with draws
/// per pose into poses.
std::size_t most_shards(const Study& study, std::size_t poses) {
  if (study.analysis.draws == Draws::per_pose) return shards_by_pose(study, poses);
  return MachineTable::units_for(study.analysis.samples, poses, MachineTable::unit_size(study.analysis));
}

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  const Plan plan(run.study, run.poses);
  const auto calibration = machine_calibration(run.study, run.model, run.poses);
  auto result =
      run_monte_carlo(plan, run.model, run.study.analysis, run.options, calibration ? &*calibration : nullptr);
  if (!result || !run.makes_result()) return std::nullopt;
  StudyResult found{{}, result->verdicts, {}};
  if (run.options.keep_rejected) found.rejected = std::move(result->rejected);
  found.found = *std::move(result);
  return found;
}

}  // namespace

std::optional<Result> run_monte_carlo(const Plan& plan, const Model& model, const Analysis& analysis,
                                      const RunOptions& options, const MachineCalibration* calibration) {
  const auto run = [&](auto work, const auto& result_of) -> std::optional<Result> {
    if (!fold(work, options) || options.shard) return std::nullopt;
    std::optional<ConvergenceResult> convergence = work.convergence();
    Result found = result_of(work);
    found.convergence = std::move(convergence);
    leave_out_constant(joint_rounding(plan, model), found);
    return found;
  };
  if (plan.draws() == Draws::per_machine) {
    const MachineJob job{plan, model, analysis, calibration, options.keep_rejected};
    return run(UnitFold(job, options), [](auto& work) { return std::move(work).sums().result(); });
  }
  const PoseJob job{plan, model, analysis, options.keep_checkpoint || plan.adaptive().has_value()};
  return run(PoseFold(plan, job, options), [](auto& work) { return std::move(work.sums()).result(); });
}

constinit const Kind kKind{
    .study = kStudy, .run = {run_study_of_kind, monte_carlo_outlook, most_shards}, .file = kFile, .report = kReport};

}  // namespace poesy::monte_carlo
