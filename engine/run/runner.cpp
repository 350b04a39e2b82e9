#include "engine/run/runner.h"

#include <algorithm>
#include <thread>

#include "engine/run/evaluate_unit.h"
#include "engine/run/evaluation_state.h"
#include "engine/run/identification.h"
#include "engine/run/monte_carlo.h"
#include "engine/run/monte_carlo_collector.h"
#include "engine/run/pending_units.h"
#include "engine/run/run_in_order.h"
#include "engine/run/sensitivity.h"
#include "engine/run/sensitivity_collector.h"

namespace poesy {
namespace {

/// Rows that are solved in one go at one pose.
constexpr std::size_t kBlockRows = 256;

/// Solves blocks of rows of an error table and scatters what they give into the result.
class TableEvaluator {
 public:
  TableEvaluator(const Model& model, const SolverOptions& solver, const PoseSet& poses, const ErrorTable& errors,
                 EvaluationResult& result)
      : poses_(&poses),
        errors_(&errors),
        result_(&result),
        zeros_(model.description().factors.size(), 0.0),
        evaluator_(model.evaluator(solver)) {}

  /// Samples first_sample .. of pose m are the rows first_row .. of the table.
  SolveCounts operator()(PoseIndex pose, std::size_t first_sample, std::size_t first_row, std::size_t count) {
    const std::size_t varied = errors_->factors.size();
    values_.resize(varied * count);
    for (std::size_t v = 0; v < varied; ++v) {
      for (std::size_t b = 0; b < count; ++b) {
        values_[v * count + b] = errors_->values[(first_row + b) * varied + v];
      }
    }
    const std::size_t start = pose.value * result_->samples + first_sample;
    responses_.resize(result_->responses * count);
    details_.resize(result_->details * count);
    const std::span status = std::span(result_->status).subspan(start, count);
    const std::span iterations = std::span(result_->iterations).subspan(start, count);
    evaluator_->evaluate({(*poses_)[pose], zeros_, errors_->factors, values_, count},
                         {responses_, status, iterations, details_});
    scatter(start, count);
    SolveCounts solves;
    for (std::size_t b = 0; b < count; ++b) solves.add(status[b], iterations[b]);
    return solves;
  }

 private:
  void scatter(std::size_t start, std::size_t count) {
    const std::size_t all = result_->poses * result_->samples;
    for (std::size_t r = 0; r < result_->responses; ++r) {
      std::copy_n(&responses_[r * count], count, &result_->response[r * all + start]);
    }
    for (std::size_t d = 0; d < result_->details; ++d) {
      for (std::size_t b = 0; b < count; ++b) {
        result_->detail[(start + b) * result_->details + d] = details_[d * count + b];
      }
    }
  }

  const PoseSet* poses_;
  const ErrorTable* errors_;
  EvaluationResult* result_;
  std::vector<double> zeros_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> values_;
  std::vector<double> responses_;
  std::vector<double> details_;
};

EvaluationResult empty_evaluation(const Model& model, const PoseSet& poses, std::size_t samples, Outcomes outcomes) {
  const ModelDescription& description = model.description();
  EvaluationResult result;
  result.poses = poses.size();
  result.samples = samples;
  result.responses = description.responses.size();
  if (outcomes == Outcomes::with_details) {
    for (const Detail& detail : description.details) result.details += detail.components.size();
  }
  const std::size_t all = result.poses * samples;
  result.response.resize(result.responses * all);
  result.detail.resize(all * result.details);
  result.status.resize(all);
  result.iterations.resize(all);
  for (std::size_t m = 0; m < poses.size(); ++m) {
    const std::vector<double> q = model.joint_displacements(poses[PoseIndex(m)]);
    result.joint_displacement.insert(result.joint_displacement.end(), q.begin(), q.end());
  }
  return result;
}

}  // namespace

std::size_t resolved_threads(std::size_t threads) {
  return threads != 0 ? threads : std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

std::optional<SensitivityResult> run_sensitivity(const Plan& plan, const Model& model, double conf_level,
                                                 const RunOptions& options) {
  SensitivityCollector collect(plan, model.description().responses.size());
  Stage stage(options.checkpoints);
  stage.begin([&](std::span<const std::byte> state) { collect.restore(state); });
  const PendingUnits pending(plan, [&](std::size_t cell) { return collect.units_done(cell); });
  ProgressCounter counter(plan.solves(), collect.total(), options);
  const auto state = [&] { return collect.state(); };
  const bool complete = run_in_order(
      pending.size(), options, [&] { return UnitEvaluator(plan, model); },
      [&](UnitEvaluator& evaluate, std::size_t n) { return evaluate(pending[n]); },
      [&](std::size_t n, const UnitStats& stats) {
        collect.add(pending[n], stats);
        counter.add(stats.solves);
        stage.merged(state);
      });
  stage.end(complete, state);
  if (!complete) return std::nullopt;
  return sensitivity_result(plan, std::move(collect).cells(), background_responses(plan, model), conf_level);
}

std::optional<MonteCarloResult> run_monte_carlo(const Plan& plan, const Model& model, const Analysis& analysis,
                                                const RunOptions& options) {
  MonteCarloCollector collect(plan, model.description().responses.size(), analysis);
  Stage stage(options.checkpoints);
  stage.begin([&](std::span<const std::byte> state) { collect.restore(state); });
  const PendingUnits pending(plan, [&](std::size_t pose) { return collect.units_done(PoseIndex(pose)); });
  ProgressCounter counter(plan.solves(), collect.total(), options);
  const auto state = [&] { return collect.state(); };
  const bool complete = run_in_order(
      pending.size(), options, [&] { return PoseUnitEvaluator(plan, model); },
      [&](PoseUnitEvaluator& evaluate, std::size_t n) { return evaluate(pending[n]); },
      [&](std::size_t n, const PoseUnit& found) {
        collect.add(pending[n].pose, found);
        counter.add(found.solves);
        stage.merged(state);
      });
  stage.end(complete, state);
  if (!complete) return std::nullopt;
  return std::move(collect).result();
}

std::optional<EvaluationResult> run_evaluation(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                                               const ErrorTable& errors, Pairing pairing, const RunOptions& options,
                                               Outcomes outcomes) {
  const bool paired = pairing == Pairing::row_by_row;
  const std::size_t samples = paired ? 1 : errors.rows;
  EvaluationResult result = empty_evaluation(model, poses, samples, outcomes);
  const std::size_t blocks = (samples + kBlockRows - 1) / kBlockRows;
  EvaluationProgress done(result, kBlockRows);
  Stage stage(options.checkpoints);
  stage.begin([&](std::span<const std::byte> state) { done.restore(state); });
  ProgressCounter counter(poses.size() * samples, done.total(), options);
  const std::size_t first_block = done.blocks();
  const auto state = [&] { return done.state(); };
  const bool complete = run_in_order(
      poses.size() * blocks - first_block, options,
      [&] { return TableEvaluator(model, solver, poses, errors, result); },
      [&](TableEvaluator& evaluate, std::size_t n) {
        const std::size_t block = first_block + n;
        const std::size_t pose = block / blocks;
        const std::size_t first = block % blocks * kBlockRows;
        const std::size_t count = std::min(kBlockRows, samples - first);
        return evaluate(PoseIndex(pose), first, paired ? pose : first, count);
      },
      [&](std::size_t, const SolveCounts& solves) {
        done.add_block();
        counter.add(solves);
        stage.merged(state);
      });
  stage.end(complete, state);
  if (!complete) return std::nullopt;
  return result;
}

std::optional<IdentificationResult> run_identification(const Study& study, const Model& model, const PoseSet& poses,
                                                       const RunOptions& options) {
  return identify(study.analysis, model.description(), [&](const ErrorTable& errors) {
    return run_evaluation(model, study.solver, poses, errors, Pairing::every_pose_with_every_row, options,
                          Outcomes::responses);
  });
}

}  // namespace poesy
