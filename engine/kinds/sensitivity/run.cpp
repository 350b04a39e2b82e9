#include "engine/kinds/sensitivity/kind.h"

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include "engine/kinds/calibrated_model.h"
#include "engine/kinds/sensitivity/collector.h"
#include "engine/kinds/sensitivity/fidelity.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/linearity.h"
#include "engine/kinds/sensitivity/points_radius.h"
#include "engine/kinds/sensitivity/separation.h"
#include "engine/kinds/sensitivity/tolerances.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/pose_fold.h"
#include "engine/run/response_rounding.h"
#include "engine/run/rounds.h"
#include "engine/run/series_model.h"

namespace poesy::sensitivity {
namespace {

/// [responses x errors] The magnitude below which the index of each error is rounding.
std::vector<double> index_roundings(const Plan& plan, const Model& model) {
  std::vector<double> list;
  for (const double rounding : response_rounding(model)) {
    for (const Distribution& error : plan.distributions()) {
      list.push_back(index_rounding(rounding, error.standard_deviation()));
    }
  }
  return list;
}

/// The job of a PoseFold (run/pose_fold.h): solves the draws of one error at a time, at one pose after the other.
struct SensitivityJob {
  const Plan& plan;
  const Model& model;
  double conf_level;
  std::vector<std::size_t> points = history_points(plan);

  static constexpr std::string_view kName = "sensitivity";
  std::size_t responses() const { return model.description().responses.size(); }
  std::vector<std::uint64_t> sizes() const { return {responses()}; }
  Rounds::Rule rule() const {
    return {responses(), all_positions(responses()), conf_level, index_roundings(plan, model)};
  }
  UnitEvaluator worker() const { return {plan, model}; }
  void unit_state(Archive& archive, const WorkUnit& unit, CellUnit& found) const {
    if (archive.reads()) {
      found.responses.resize(responses());
      found.within.resize(points_within(unit, points).size() * responses());
    }
    found.state(archive, unit.first.value);
  }
  Collector sums(const Plan& of, const Shard& shard) const { return {of, responses(), conf_level, shard}; }
  std::vector<Estimate> estimates(const Collector& sums, std::size_t slot) const {
    return global_indices(sums.cells_of(slot), plan.distributions()[slot].standard_deviation(), conf_level);
  }
};

/// Returns true if Chebyshev series that were checked against solves (series_model.h) may replace solves at this
/// fidelity. They are not used to first order (fidelity 1), which costs no more than a series, nor with the metric
/// "published", whose results must stay the same to the last bit.
bool has_series(const Study& study, std::size_t fidelity) {
  return study.solver.series && fidelity == 0 && study.model().metric != "published";
}

/// The model, or a model that replaces solves by series if has_series().
std::shared_ptr<const Model> by_series(const Study& study, std::shared_ptr<const Model> model, std::size_t fidelity) {
  return has_series(study, fidelity) ? with_series(std::move(model)) : std::move(model);
}

std::vector<Dimension> response_dimensions(const ModelDescription& model) {
  std::vector<Dimension> dimensions;
  for (const Response& response : model.responses) dimensions.push_back(response.dimension);
  return dimensions;
}

/// Runs the study at both fidelities, with the same draws, and compares the results.
std::optional<Result> run_both_fidelities(const StudyRun& run, const Plan& plan) {
  const Analysis& analysis = run.study.analysis;
  const auto report = [&](const Progress& progress) {
    if (run.options.progress) run.options.progress(progress);
  };
  // The progress of both fidelities is reported as that of one run. If the first fidelity reports no progress, the
  // checkpoint already contained all its samples.
  std::optional<std::uint64_t> before;
  RunOptions options = run.options;
  options.progress = [&](const Progress& half) {
    before = half.before;
    report({half.solves, 2 * half.total, half.not_converged, half.before});
  };
  const MechanismChoice& choice = run.study.mechanism;
  const auto model = by_series(run.study, borrowed(run.model), choice.fidelity);
  auto first = run_sensitivity(plan, *model, analysis.conf_level, options);
  if (!run.checkpoints().complete()) return std::nullopt;
  const SolveCounts solves = run.checkpoints().solves();
  options.progress = [&](const Progress& half) {
    report({solves.total() + half.solves, solves.total() + half.total, solves.not_converged() + half.not_converged,
            before.value_or(solves.total()) + half.before});
  };
  const auto other = by_series(run.study, build_model(at_compared_fidelity(choice)), *choice.compared);
  const auto second = run_sensitivity(plan, *other, analysis.conf_level, options);
  if (!first || !second) return std::nullopt;
  first->fidelity = compare_fidelities(*first, *second, response_dimensions(run.study.model()),
                                       standard_deviations(run.study), asked_of<Options>(analysis).linearity);
  for (const std::size_t fidelity : {choice.fidelity, choice.compared.value()}) {
    first->fidelity->fidelities.push_back(run.study.model().fidelities[fidelity]);
  }
  return first;
}

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  const Plan plan(run.study, run.poses);
  const std::shared_ptr<const Model> model = studied_model(run.study, run.model, run.poses);
  auto result = run.study.mechanism.compared
                    ? run_both_fidelities(run, plan)
                    : run_sensitivity(plan, *by_series(run.study, model, run.study.mechanism.fidelity),
                                      run.study.analysis.conf_level, run.options);
  if (!result) return std::nullopt;
  auto changes = index_changes(plan, *model, run.options);
  if (!changes) {
    run.checkpoints().stopped_after_stages();
    return std::nullopt;
  }
  if (!run.makes_result()) return std::nullopt;
  result->index_change = *std::move(changes);
  if (run.study.analysis.calibration == nullptr) result->radius_tau = radius_rank_correlations(run.study, plan);
  set_references(run.study, *result);
  if (run.model.description().separation) {
    result->separation = separate_errors(run.model, plan.poses(), plan.factors(), standard_deviations(run.study));
  }
  return StudyResult{*std::move(result), std::nullopt, {}};
}

std::size_t cells(const Study& study, std::size_t poses) { return study.analysis.factors.size() * poses; }

/// The expected work of separating the effects of errors (SeparationResult). The work is divided into one piece for
/// each pose.
WorkOutlook separating(const Study& study, const Model& model, const PoseSet& poses) {
  return {[&](double at) {
    const auto pose = poses[PoseIndex(static_cast<std::size_t>(at * static_cast<double>(poses.size())))];
    const PoseSet one(poses.coordinates(), std::vector<double>(pose.begin(), pose.end()));
    static_cast<void>(separate_errors(model, one, study.analysis.factors, standard_deviations(study)));
    return 1.0 / static_cast<double>(poses.size());
  }};
}

/// The memory of a study. While the result is computed, the accumulators are freed one response at a time, so that the
/// result takes their place.
MemoryOutlook sensitivity_memory(const Study& study, const Plan& plan, std::size_t fidelities) {
  const std::size_t responses = study.model().responses.size();
  const AxisLengths lengths{{"response", responses}, {"factor", plan.factors().size()}, {"pose", plan.poses().size()}};
  const std::size_t numbers = sensitivity_bytes(lengths);
  const std::size_t separated = study.model().separation ? separation_bytes(lengths) : 0;
  const std::size_t result = numbers + plan.cells() * sizeof(SolveCounts);
  const std::size_t ends = plan.cells() * (sizeof(SolveCounts) + sizeof(FailedSamples));
  const std::size_t moments = plan.cells() * sizeof(Moments);  // bytes for one response
  // If the last unit of a cell has fewer samples, it is kept apart from the full units.
  const bool both = plan.samples() > Plan::kUnitSamples && plan.samples() % Plan::kUnitSamples != 0;
  const std::size_t parts = both ? 2 : 1;
  const std::size_t at_once = parts * (responses * moments + ends);
  return {at_once - std::min(at_once, result + separated) + moments + ends,
          fidelities * parts * plan.cells() * (responses * kStoredMoments + kStoredSolves),
          fidelities * result + separated,
          numbers + separated + plan.cells() * (kSolverColumns + (fidelities - 1) * sizeof(double))};
}

Outlook sensitivity_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const auto plan = std::make_shared<const Plan>(study, poses);
  const std::size_t fidelities = study.mechanism.compared ? 2 : 1;
  const auto calibration = machine_calibration(study, model, poses);
  const double with_changes = 1.0 + index_change_solves(*plan) / static_cast<double>(plan->solves());
  Outlook expected{
      .solves = counted_things(plan->factors().size(), "errors x ") + counted_things(poses.size(), "poses x ") +
                samples_text(*plan) + " samples" + (fidelities == 2 ? " x 2 fidelities" : "") + " = " +
                solves_text(*plan, fidelities) +
                (has_series(study, study.mechanism.fidelity) ? ", fewer where series replace them" : "") +
                (calibration ? calibration_cost_text(*calibration, "sample") : ""),
      .memory = sensitivity_memory(study, *plan, fidelities),
      .shared = {sampling<UnitEvaluator>(
          plan, by_series(study, studied_model(study, model, poses), study.mechanism.fidelity), with_changes)},
      .by_one = {},
      .least = least_share(*plan)};
  if (model.description().separation) expected.by_one.push_back(separating(study, model, poses));
  if (fidelities == 2) {
    const auto other = by_series(study, build_model(at_compared_fidelity(study.mechanism)), *study.mechanism.compared);
    expected.shared.push_back(sampling<UnitEvaluator>(plan, other, 1.0));
  }
  return expected;
}

}  // namespace

std::optional<Result> run_sensitivity(const Plan& plan, const Model& model, double conf_level,
                                      const RunOptions& options) {
  const SensitivityJob job{plan, model, conf_level};
  PoseFold work(plan, job, options);
  if (!fold(work, options) || options.shard) return std::nullopt;
  Result result = sensitivity_result(plan, std::move(work.sums()).cells(), background_responses(plan, model),
                                     response_rounding(model), conf_level);
  result.convergence = work.convergence();
  if (!plan.adaptive()) result.history = work.sums().history(result);
  return result;
}

constinit const Kind kKind{.study = kStudy,
                           .run = {run_study_of_kind, sensitivity_outlook, cells},
                           .file = kFile,
                           .report = kReport,
                           .set_tolerances = set_sensitivity_tolerances};

}  // namespace poesy::sensitivity
