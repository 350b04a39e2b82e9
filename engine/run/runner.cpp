#include "engine/run/runner.h"

#include <algorithm>
#include <numeric>
#include <thread>
#include <utility>

#include "engine/run/evaluate_unit.h"
#include "engine/kinds/identification/identification.h"
#include "engine/run/pose_unit.h"
#include "engine/kinds/monte_carlo/collector.h"
#include "engine/run/pending_units.h"
#include "engine/run/rounds.h"
#include "engine/run/run_in_order.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/collector.h"
#include "engine/stats/mean_interval.h"
#include "engine/kinds/sensitivity/history_points.h"

namespace poesy {
namespace {

std::vector<std::size_t> all_positions(std::size_t count) {
  std::vector<std::size_t> positions(count);
  std::iota(positions.begin(), positions.end(), std::size_t{0});
  return positions;
}

/// Into rounds and a collector that are at their beginning.
void restore(std::span<const std::byte> state, const Plan& plan, Rounds& rounds, SensitivityCollector& collect) {
  ByteReader from(state);
  rounds.restore(from);
  collect.restore(state.last(from.left()));
  for (std::size_t cell = 0; cell < plan.cells(); ++cell) {
    if (!rounds.may_hold(cell / plan.poses().size(), collect.units_done(cell))) {
      throw BytesError("has a cell of another round");
    }
  }
}

/// Of each response over the samples of all poses, [R].
std::vector<Estimate> overall_means(const MonteCarloResult& found) {
  std::vector<Estimate> means;
  for (std::size_t first = 0; first < found.mean.size(); first += found.poses) {
    means.push_back(stratified_mean(
        {std::span(found.count).subspan(first, found.poses), std::span(found.mean).subspan(first, found.poses),
         std::span(found.std).subspan(first, found.poses)},
        found.conf_level));
  }
  return means;
}

/// Below which the index of each error is rounding, [R x P].
std::vector<double> index_roundings(const Plan& plan, const Model& model) {
  std::vector<double> list;
  for (const double rounding : response_rounding(model)) {
    for (const Distribution& error : plan.distributions()) {
      list.push_back(index_rounding(rounding, error.standard_deviation()));
    }
  }
  return list;
}

/// Solves after those that were done, as far as that is known.
std::uint64_t expected_left(const Plan& plan, const Rounds& rounds, const SolveCounts& done,
                            const PendingUnits& pending) {
  return plan.adaptive() ? rounds.expected_solves() - done.total() : pending.samples();
}

}  // namespace

std::size_t resolved_threads(std::size_t threads) {
  return threads != 0 ? threads : std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

std::optional<SensitivityResult> run_sensitivity(const Plan& plan, const Model& model, double conf_level,
                                                 const RunOptions& options) {
  const std::size_t responses = model.description().responses.size();
  const std::size_t poses = plan.poses().size();
  const Rounds::Rule rule{responses, all_positions(responses), conf_level, index_roundings(plan, model)};
  SensitivityCollector collect(plan, responses, conf_level);
  Rounds rounds(plan, rule);
  const auto take_up = [&](std::span<const std::byte> state) {
    collect = SensitivityCollector(plan, responses, conf_level);
    rounds = Rounds(plan, rule);
    restore(state, plan, rounds, collect);
  };
  const std::vector<std::size_t> points = history_points(plan);
  Stage stage(options.checkpoints, options.team);
  stage.begin(take_up);
  const NumberRange cells = options.shard.value_or(Shard()).of(plan.cells());
  ProgressCounter counter(plan.solves(), collect.total(), options);
  const auto state = [&] { return rounds.state_before(collect.state()); };
  const auto indices = [&](std::size_t slot) {
    return global_indices(collect.cells_of(slot), plan.distributions()[slot].standard_deviation(), conf_level);
  };
  for (;;) {
    const PendingUnits pending(
        plan, [&](std::size_t cell) { return collect.units_done(cell); },
        [&](std::size_t cell) { return cells.holds(cell) ? rounds.units(cell / poses) : 0; });
    counter.expect_left(expected_left(plan, rounds, collect.total(), pending));
    const bool complete = run_in_order(
        pending.size(), options, [&] { return UnitEvaluator(plan, model); },
        [&](UnitEvaluator& evaluate, std::size_t n) { return evaluate(pending[n]); },
        [&](std::size_t n, const SensitivityUnit& found) {
          collect.add(pending[n], found);
          counter.add(found.solves);
          stage.merged(state);
        },
        [](std::size_t, const SensitivityUnit& found, ByteWriter& to) { found.write(to); },
        [&](std::size_t n, ByteReader& from) {
          const WorkUnit unit = pending[n];
          return SensitivityUnit::read(from, responses, unit.first.value, points_within(unit, points).size());
        });
    stage.end(
        complete, [&] { return collect.total(); }, state, take_up);
    if (!complete) return std::nullopt;
    if (!rounds.go_on(indices)) break;
    stage.next_round();
  }
  if (options.shard) return std::nullopt;
  auto result = sensitivity_result(plan, std::move(collect).cells(), background_responses(plan, model),
                                   response_rounding(model), conf_level);
  result.convergence = rounds.result();
  if (!plan.adaptive()) result.history = collect.history(result);
  return result;
}

std::optional<MonteCarloResult> run_monte_carlo(const Plan& plan, const Model& model, const Analysis& analysis,
                                                const RunOptions& options) {
  const ModelDescription& description = model.description();
  const std::size_t responses = description.responses.size();
  const Rounds::Rule rule{responses, description.headline.empty() ? all_positions(responses) : description.headline,
                          analysis.conf_level, std::vector<double>(responses, 0.0)};
  Rounds rounds(plan, rule);
  Bytes before;  // the collector's state at the end of the round before this one, or of an earlier run
  Stage stage(options.checkpoints, options.team);
  stage.begin([&](std::span<const std::byte> state) {
    ByteReader from(state);
    rounds.restore(from);
    const auto rest = state.last(from.left());
    if (rest.empty()) throw BytesError("is cut off");
    before.assign(rest.begin(), rest.end());
  });
  const bool keep_checkpoint = options.keep_checkpoint || plan.adaptive();
  std::optional<ProgressCounter> counter;
  for (;;) {
    const Plan part = plan.with_samples(rounds.samples(0));
    MonteCarloCollector collect(part, responses, analysis, keep_checkpoint);
    if (!before.empty()) collect.restore(std::exchange(before, {}));
    if (!counter) counter.emplace(plan.solves(), collect.total(), options);
    const PendingUnits pending(part, options.shard.value_or(Shard()),
                               [&](std::size_t pose) { return collect.units_done(PoseIndex(pose)); });
    counter->expect_left(expected_left(plan, rounds, collect.total(), pending));
    const auto state = [&] { return rounds.state_before(collect.state()); };
    const bool complete = run_in_order(
        pending.size(), options, [&] { return PoseUnitEvaluator(part, model); },
        [&](PoseUnitEvaluator& evaluate, std::size_t n) { return evaluate(pending[n]); },
        [&](std::size_t n, const PoseUnit& found) {
          collect.add(pending[n].pose, found);
          counter->add(found.solves);
          stage.merged(state);
        },
        [](std::size_t, const PoseUnit& found, ByteWriter& to) { found.write(to); },
        [&](std::size_t n, ByteReader& from) { return PoseUnit::read(from, responses, pending[n].first.value); });
    stage.end(
        complete, [&] { return collect.total(); }, state,
        [&](std::span<const std::byte> end) {
          ByteReader from(end);
          Rounds(plan, rule).restore(from);  // what was decided before this round is known here
          collect = MonteCarloCollector(part, responses, analysis, keep_checkpoint);
          collect.restore(end.last(from.left()));
        });
    if (!complete || options.shard) return std::nullopt;
    if (!rounds.go_on([&](std::size_t) { return overall_means(collect.finished()); })) {
      MonteCarloResult result = std::move(collect).result();
      result.convergence = rounds.result();
      return result;
    }
    before = collect.state();
    stage.next_round();
  }
}

std::optional<IdentificationResult> run_identification(const Study& study, const Model& model, const PoseSet& poses,
                                                       const RunOptions& options) {
  return identify(study.analysis, model.description(), [&](const ErrorTable& errors) {
    return run_evaluation(model, study.solver, poses, errors, Pairing::every_pose_with_every_row, options,
                          Outcomes::responses);
  });
}

}  // namespace poesy
