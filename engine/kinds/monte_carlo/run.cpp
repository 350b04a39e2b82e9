#include "engine/kinds/monte_carlo/kind.h"

#include <utility>

#include "engine/kinds/monte_carlo/collector.h"
#include "engine/kinds/monte_carlo/machine_collector.h"
#include "engine/kinds/monte_carlo/machine_table.h"
#include "engine/kinds/monte_carlo/machine_unit.h"
#include "engine/kinds/monte_carlo/outlook.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/monte_carlo/yield.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/fold.h"
#include "engine/run/response_rounding.h"
#include "engine/run/rounds.h"
#include "engine/stats/moments.h"

namespace poesy {
namespace {

/// Of each response over the samples of all poses.
std::vector<Estimate> overall_means(const MonteCarloResult& found) {
  std::vector<Estimate> means;
  for (std::size_t r = 0; r < found.responses(); ++r) {
    means.push_back(stratified_mean({found.count.row(r), found.mean.row(r), found.std.row(r)}, found.conf_level));
  }
  return means;
}

/// Adaptive samples are for the means of the headline.
Rounds::Rule rule_of(const Model& model, const Analysis& analysis) {
  const ModelDescription& description = model.description();
  const std::size_t responses = description.responses.size();
  return {responses, description.headline.empty() ? all_positions(responses) : description.headline,
          analysis.conf_level, std::vector<double>(responses, 0.0)};
}

/// The draws of all errors together, pose by pose, in rounds: the work of fold(). Each round has a collector of its
/// own, which begins with what the one before kept.
class PoseWork {
 public:
  PoseWork(const Plan& plan, const Model& model, const Analysis& analysis, const RunOptions& options)
      : plan_(plan),
        model_(model),
        analysis_(analysis),
        responses_(model.description().responses.size()),
        shard_(options.shard.value_or(Shard())),
        keep_checkpoint_(options.keep_checkpoint || plan.adaptive()),
        rule_(rule_of(model, analysis)),
        rounds_(plan, rule_) {
    collect({});
  }

  std::size_t begin_round() {
    pending_.emplace(*part_, shard_, [&](std::size_t pose) { return collect_->units_done(PoseIndex(pose)); });
    return pending_->size();
  }
  PoseUnitEvaluator worker() const { return {*part_, model_}; }
  PoseUnit solve(PoseUnitEvaluator& evaluate, std::size_t n) const { return evaluate((*pending_)[n]); }
  const SolveCounts& merge(std::size_t n, const PoseUnit& found) {
    collect_->add((*pending_)[n].pose, found);
    return found.solves;
  }
  static void write(std::size_t, const PoseUnit& found, ByteWriter& to) { found.write(to); }
  PoseUnit read(std::size_t n, ByteReader& from) const {
    return PoseUnit::read(from, responses_, plan_.factors().size(), (*pending_)[n].first.value);
  }
  SolveCounts solved() const { return collect_->total(); }
  std::uint64_t left() const { return rounds_.expected_left(solved(), pending_->samples()); }
  void write_state(ByteWriter& to) const {
    rounds_.write_state(to);
    collect_->write_state(to);
  }
  void restore(std::span<const std::byte> state) {
    rounds_ = Rounds(plan_, rule_);
    ByteReader from(state);
    rounds_.restore(from);
    if (from.left() == 0) throw BytesError("is cut off");
    collect(state.last(from.left()));
  }
  bool next_round() {
    if (!rounds_.go_on([&](std::size_t) { return overall_means(collect_->finished()); })) return false;
    const Bytes kept = bytes_of([&](ByteWriter& to) { collect_->write_state(to); });
    collect_.reset();
    collect(kept);
    return true;
  }

  /// Precondition: every unit was merged, and no round follows.
  MonteCarloResult result() && {
    MonteCarloResult result = std::move(*collect_).result();
    result.convergence = rounds_.result();
    return result;
  }

 private:
  /// Begins the round with these samples.
  void collect(std::span<const std::byte> kept) {
    part_.emplace(plan_.with_samples(rounds_.samples(0)));
    collect_.emplace(*part_, responses_, analysis_, keep_checkpoint_);
    if (!kept.empty()) collect_->restore(kept);
  }

  const Plan& plan_;
  const Model& model_;
  const Analysis& analysis_;
  std::size_t responses_;
  Shard shard_;
  bool keep_checkpoint_;
  Rounds::Rule rule_;
  Rounds rounds_;
  std::optional<Plan> part_;  ///< the plan with this round's samples
  std::optional<MonteCarloCollector> collect_;
  std::optional<PendingUnits> pending_;  ///< of this round
};

/// The machines of a study that draws errors per machine, unit by unit at all poses, in rounds: the work of fold().
class MachineWork {
 public:
  MachineWork(const Plan& plan, const Model& model, const Analysis& analysis, const RunOptions& options)
      : plan_(plan),
        model_(model),
        analysis_(analysis),
        table_(plan, model, analysis),
        units_(options.shard.value_or(Shard()).of(table_.units())),
        rule_(rule_of(model, analysis)),
        rounds_(plan, rule_),
        collect_(table_, analysis, units_) {}

  MachineWork(const MachineWork&) = delete;
  MachineWork& operator=(const MachineWork&) = delete;

  std::size_t begin_round() {
    first_ = collect_.next();
    const std::size_t wanted = MachineTable::units_for(rounds_.samples(0), plan_.poses().size());
    end_ = std::max(first_, std::min(wanted, units_.end));
    return end_ - first_;
  }
  MachineUnitEvaluator worker() const { return {table_, model_}; }
  MachineUnit solve(MachineUnitEvaluator& evaluate, std::size_t n) const { return evaluate(first_ + n); }
  SolveCounts merge(std::size_t n, MachineUnit&& found) {
    const SolveCounts solves = found.total;
    collect_.add(first_ + n, std::move(found));
    return solves;
  }
  static void write(std::size_t, const MachineUnit& found, ByteWriter& to) { found.write(to); }
  MachineUnit read(std::size_t n, ByteReader& from) const {
    const WorkUnit unit = table_.unit(first_ + n);
    return MachineUnit::read(from, table_, {unit.first.value, unit.first.value + unit.count});
  }
  SolveCounts solved() const { return collect_.total(); }
  std::uint64_t left() const {
    if (first_ == end_) return rounds_.expected_left(solved(), 0);
    const WorkUnit last = table_.unit(end_ - 1);
    const std::size_t machines = last.first.value + last.count - table_.unit(first_).first.value;
    return rounds_.expected_left(solved(), std::uint64_t{machines} * plan_.poses().size());
  }
  void write_state(ByteWriter& to) const {
    rounds_.write_state(to);
    collect_.write_state(to);
  }
  void restore(std::span<const std::byte> state) {
    rounds_ = Rounds(plan_, rule_);
    ByteReader from(state);
    rounds_.restore(from);
    if (from.left() == 0) throw BytesError("is cut off");
    collect_ = MachineCollector(table_, analysis_, units_);
    collect_.restore(state.last(from.left()));
  }
  bool next_round() {
    return rounds_.go_on([&](std::size_t) { return collect_.overall_means(); });
  }

  /// Precondition: every unit was merged, and no round follows.
  MonteCarloResult result() && {
    MonteCarloResult result = std::move(collect_).result();
    result.convergence = rounds_.result();
    return result;
  }

 private:
  const Plan& plan_;
  const Model& model_;
  const Analysis& analysis_;
  MachineTable table_;
  NumberRange units_;  ///< of the shard, or all
  Rounds::Rule rule_;
  Rounds rounds_;
  MachineCollector collect_;
  std::size_t first_ = 0;  ///< unit of this round
  std::size_t end_ = 0;    ///< of this round
};

/// A study of machines divides between its units, any other at its poses.
std::size_t most_shards(const Study& study, std::size_t poses) {
  if (study.analysis.draws == Draws::per_pose) return shards_by_pose(study, poses);
  return MachineTable::units_for(study.analysis.samples, poses);
}

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  const Plan plan(run.study, run.poses);
  auto result = run_monte_carlo(plan, run.model, run.study.analysis, run.options);
  if (!result || !run.makes_result()) return std::nullopt;
  StudyResult found{{}, result->verdicts, {}};
  found.found = *std::move(result);
  return found;
}

}  // namespace

std::optional<MonteCarloResult> run_monte_carlo(const Plan& plan, const Model& model, const Analysis& analysis,
                                                const RunOptions& options) {
  const auto run = [&](auto work) -> std::optional<MonteCarloResult> {
    if (!fold(work, options) || options.shard) return std::nullopt;
    MonteCarloResult found = std::move(work).result();
    leave_out_constant(joint_rounding(plan, model), found);
    return found;
  };
  if (plan.draws() == Draws::per_machine) return run(MachineWork(plan, model, analysis, options));
  return run(PoseWork(plan, model, analysis, options));
}

constinit const Kind kMonteCarloKind{.study = kMonteCarloStudy,
                                     .run = {run_study_of_kind, monte_carlo_outlook, most_shards},
                                     .file = kMonteCarloFile,
                                     .report = kMonteCarloReport};

}  // namespace poesy
