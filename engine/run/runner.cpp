#include "engine/run/runner.h"

#include <algorithm>
#include <thread>

#include "engine/run/evaluate_unit.h"
#include "engine/run/identification.h"
#include "engine/run/monte_carlo.h"
#include "engine/run/monte_carlo_collector.h"
#include "engine/run/pending_units.h"
#include "engine/run/run_in_order.h"
#include "engine/run/sensitivity.h"
#include "engine/run/sensitivity_collector.h"

namespace poesy {
std::size_t resolved_threads(std::size_t threads) {
  return threads != 0 ? threads : std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

std::optional<SensitivityResult> run_sensitivity(const Plan& plan, const Model& model, double conf_level,
                                                 const RunOptions& options) {
  SensitivityCollector collect(plan, model.description().responses.size());
  const auto restore = [&](std::span<const std::byte> state) {
    collect = SensitivityCollector(plan, model.description().responses.size());
    collect.restore(state);
  };
  Stage stage(options.checkpoints, options.team);
  stage.begin(restore);
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
      },
      [](std::size_t, const UnitStats& stats, ByteWriter& to) { stats.write(to); },
      [&](std::size_t, ByteReader& from) { return UnitStats::read(from, model.description().responses.size()); });
  stage.end(complete, state, restore);
  if (!complete) return std::nullopt;
  return sensitivity_result(plan, std::move(collect).cells(), background_responses(plan, model), conf_level);
}

std::optional<MonteCarloResult> run_monte_carlo(const Plan& plan, const Model& model, const Analysis& analysis,
                                                const RunOptions& options) {
  MonteCarloCollector collect(plan, model.description().responses.size(), analysis);
  const auto restore = [&](std::span<const std::byte> state) {
    collect = MonteCarloCollector(plan, model.description().responses.size(), analysis);
    collect.restore(state);
  };
  Stage stage(options.checkpoints, options.team);
  stage.begin(restore);
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
      },
      [](std::size_t, const PoseUnit& found, ByteWriter& to) { found.write(to); },
      [&](std::size_t, ByteReader& from) { return PoseUnit::read(from, model.description().responses.size()); });
  stage.end(complete, state, restore);
  if (!complete) return std::nullopt;
  return std::move(collect).result();
}

std::optional<IdentificationResult> run_identification(const Study& study, const Model& model, const PoseSet& poses,
                                                       const RunOptions& options) {
  return identify(study.analysis, model.description(), [&](const ErrorTable& errors) {
    return run_evaluation(model, study.solver, poses, errors, Pairing::every_pose_with_every_row, options,
                          Outcomes::responses);
  });
}

}  // namespace poesy
