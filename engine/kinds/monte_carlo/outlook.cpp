#include "engine/kinds/monte_carlo/outlook.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "engine/kinds/monte_carlo/collector.h"
#include "engine/kinds/monte_carlo/columns.h"
#include "engine/kinds/monte_carlo/machine_collector.h"
#include "engine/kinds/monte_carlo/machine_table.h"
#include "engine/kinds/monte_carlo/machine_unit.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/run/effect_poses.h"
#include "engine/run/evaluate_unit.h"
#include "engine/stats/merge_tree.h"
#include "engine/stats/moments.h"

namespace poesy::monte_carlo {
namespace {

/// The additional memory with draws per machine: a quantile sketch of each response at each pose, the sums in the nodes
/// of the merge tree, and the units that are being solved.
MemoryOutlook machine_memory(const Study& study, const Model& model, const Plan& plan) {
  constexpr std::size_t kSketch = 20'000;
  constexpr std::size_t kPackedSketch = 6000;
  constexpr std::size_t kInFlight = 8;
  const std::size_t responses = study.model().responses.size();
  const std::size_t errors = plan.factors().size();
  const std::size_t cells = plan.poses().size() * responses;
  const MachineTable table(plan, model, study.analysis);
  const std::size_t fit = plan.poses().size() * table.vectors().rows() * (errors + 3) * sizeof(double);
  const std::size_t sums = cells * sizeof(Moments) + table.effects() * (responses + 3) / 4 * errors * 4 * 512 + fit;
  const std::size_t nodes = MergeTree<MachineSums>::most_nodes(table.units()) * sums;
  const std::size_t piece = sums + cells * table.unit_machines() * sizeof(double);
  return {cells * kSketch + nodes + kInFlight * piece + table.kept(), cells * kPackedSketch + nodes + table.kept(),
          3 * fit, 0};
}

MemoryOutlook sum_of(const MemoryOutlook& a, const MemoryOutlook& b) {
  return {a.accumulators + b.accumulators, a.state + b.state, a.result + b.result, a.file + b.file};
}

MemoryOutlook monte_carlo_memory(const Study& study, const Model& model, const Plan& plan) {
  const std::size_t responses = study.model().responses.size();
  // Numbers that are computed from the quantile sketch of a response at a pose: quantiles with both ends of their
  // intervals, and for Judge::share the share_magnitude.
  const Options& asked = asked_of<Options>(study.analysis);
  const std::size_t of_sketch = 3 * asked.quantiles.size() + (asked.judge == Judge::share ? 1 : 0);
  const MemoryOutlook of_pose{responses * sizeof(Moments) + sizeof(FailedSamples) + sizeof(SolveCounts) + sizeof(Bytes),
                              responses * (kStoredMoments + (3 + of_sketch) * sizeof(double)) + kStoredSolves,
                              sizeof(SolveCounts), kSolverColumns};
  MemoryOutlook memory = times(plan.poses().size(), of_pose);
  const std::size_t errors = plan.factors().size();
  const std::size_t effects = effect_poses(plan.poses().size(), responses, errors).size() * (responses + 3) / 4 * 4 *
                              errors * kEffectBins * 2 * sizeof(double);
  memory.accumulators += effects;
  memory.state += effects;
  const bool machines = plan.draws() == Draws::per_machine;
  const std::size_t numbers = monte_carlo_bytes({{"response", responses},
                                                 {"factor", errors},
                                                 {"pose", plan.poses().size()},
                                                 {"quantile", asked.quantiles.size()},
                                                 {"bin", kHistogramBins},
                                                 {"edge", kHistogramBins + 1},
                                                 {"effect_bin", kEffectBins}},
                                                machines);
  memory.result += numbers;
  memory.file += numbers;
  if (machines) return sum_of(memory, machine_memory(study, model, plan));
  if (!plan.adaptive()) return memory;
  // The next round of adaptive sampling continues from packed quantile sketches (QuantileSketch), one for each response
  // at each finished pose. kPackedSketch: size of one of them in bytes.
  constexpr std::size_t kPackedSketch = 6000;
  const std::size_t kept = std::min(plan.poses().size() * responses * kPackedSketch, Collector::kMostKeptBytes);
  memory.accumulators += kept;
  memory.state += kept;
  return memory;
}

/// The first poses of a study, at most this many.
PoseSet first_of(const PoseSet& poses, std::size_t most) {
  std::vector<double> some;
  for (std::size_t m = 0; m < std::min(most, poses.size()); ++m) {
    const auto pose = poses[PoseIndex(m)];
    some.insert(some.end(), pose.begin(), pose.end());
  }
  return PoseSet(poses.coordinates(), std::move(some));
}

/// A small version of a study that draws per pose, with a few of its poses and units. Its work is timed to estimate the
/// time of the whole study.
class PoseTrial {
 public:
  PoseTrial(const Study& study, const Model& model, const PoseSet& poses)
      : analysis_(study.analysis),
        model_(model),
        solves_(static_cast<double>(poses.size()) * static_cast<double>(study.analysis.samples)),
        plan_(Plan(study, first_of(poses, kPoses)).with_samples(samples(study.analysis.samples))) {}

  /// Solves one unit, which merge() then merges repeatedly. It lists no failed samples, because lists are merged only
  /// in the order of the samples.
  void prepare() {
    unit_ = PoseUnitEvaluator(plan_, model_)(plan_.unit(0));
    unit_.failed = {};
    effects_ = std::exchange(unit_.effects, std::nullopt);
    fill();
  }
  /// Merges the unit at all poses of the trial. Returns the number of merged samples, as a share of all samples of the
  /// study.
  double merge() {
    fill();
    return static_cast<double>(plan_.solves()) / solves_;
  }
  void finish() {
    unit_.effects = effects_;
    fill();
    static_cast<void>(std::move(*collect_).result());
  }

 private:
  static constexpr std::size_t kPoses = 8;

  /// The number of samples at each pose of the trial: up to kMostUnits full units, so that the work of finishing a pose
  /// takes little of the time. A study with less than one unit has all its samples.
  static std::size_t samples(std::size_t of_study) {
    constexpr std::size_t kMostUnits = 8;
    if (of_study < Plan::kUnitSamples) return of_study;
    return std::min(of_study / Plan::kUnitSamples, kMostUnits) * Plan::kUnitSamples;
  }
  void fill() {
    collect_.emplace(plan_, model_.description().responses.size(), analysis_, plan_.adaptive().has_value());
    for (std::size_t m = 0; m < plan_.poses().size(); ++m) {
      for (std::size_t u = 0; u < plan_.units_per_cell(); ++u)
        collect_->add(plan_.unit(m * plan_.units_per_cell() + u), unit_);
    }
  }

  const Analysis& analysis_;
  const Model& model_;
  double solves_;
  Plan plan_;
  PoseUnit unit_;
  std::optional<MainEffectSums> effects_;
  std::optional<Collector> collect_;
};

/// A small version of a study with draws per machine, at up to kPoses of its poses. Its work is timed to estimate the
/// time of the whole study. Some work is done once for each machine, or only at the few poses of main effects; with
/// many poses it takes about the same share of the time as in the study.
class MachineTrial {
 public:
  MachineTrial(const Study& study, const Model& model, const PoseSet& poses)
      : analysis_(study.analysis),
        model_(model),
        poses_(poses.size()),
        responses_(model.description().responses.size()),
        plan_(study, first_of(poses, kPoses)),
        calibration_(machine_calibration(study, model, poses)),
        table_(plan_, model, study.analysis),
        unit_plan_(plan_.with_samples(std::min(
            plan_.samples(), MachineTable::unit_machines(poses.size(), MachineTable::unit_size(study.analysis))))),
        unit_table_(unit_plan_, model, study.analysis, calibration_ ? &*calibration_ : nullptr),
        evaluate_(unit_table_, model) {}
  MachineTrial(const MachineTrial&) = delete;
  MachineTrial& operator=(const MachineTrial&) = delete;

  /// Solves as many machines as a unit of the study has. Returns the number of solves, as a share of all solves of the
  /// study.
  double solve() {
    static_cast<void>(evaluate_(0));
    return share_of(unit_table_.unit(0).count);
  }
  /// Solves one unit, which merge() then merges repeatedly; it lists no failed samples, as in PoseTrial.
  void prepare() {
    unit_ = MachineUnitEvaluator(table_, model_)(0);
    std::ranges::fill(unit_.failed, FailedSamples());
    begin();
    sketches_.clear();
    sketches_.resize(responses_);
    for (std::size_t r = 0; r < responses_; ++r) sketches_[r].add(unit_.at_pose(0, r));
  }
  double merge() {
    if (next_ == table_.units() || !table_.is_whole(next_)) begin();
    collect_->add(next_++, MachineUnit(unit_));
    return share_of(table_.unit(0).count);
  }
  /// Computes the result at one pose. Returns one pose as a share of the poses of the study.
  double read_pose() {
    MonteCarloColumns columns(1, responses_, analysis_);
    for (std::size_t r = 0; r < responses_; ++r) {
      columns.set_moments(r, 0, unit_.sums->at_pose(0, r));
      columns.set_quantiles(r, 0, sketches_[r], unit_.solves.front().total());
    }
    return 1.0 / static_cast<double>(poses_);
  }
  void finish() {
    begin();
    merge();
    static_cast<void>(std::move(*collect_).result());
  }

 private:
  static constexpr std::size_t kPoses = 150;

  void begin() {
    collect_.emplace(table_, analysis_);
    next_ = 0;
  }
  /// The samples of this many machines at the poses of the trial, as a share of the study's samples.
  double share_of(std::size_t machines) const {
    const double tried = static_cast<double>(machines) * static_cast<double>(plan_.poses().size());
    return tried / (static_cast<double>(plan_.samples()) * static_cast<double>(poses_));
  }

  const Analysis& analysis_;
  const Model& model_;
  std::size_t poses_;  ///< number of poses of the study
  std::size_t responses_;
  Plan plan_;
  std::optional<MachineCalibration> calibration_;
  MachineTable table_;  ///< all machines, for merging; without calibration, because merging does not depend on it
  Plan unit_plan_;
  MachineTable unit_table_;  ///< the machines of one unit of the study
  MachineUnitEvaluator evaluate_;
  MachineUnit unit_;
  std::vector<QuantileSketch> sketches_;  ///< quantile sketch of each response at one pose
  std::optional<MachineCollector> collect_;
  std::size_t next_ = 0;  ///< number of the next unit to merge
};

void add_pose_works(const Study& study, const Model& model, const PoseSet& poses,
                    const std::shared_ptr<const Plan>& plan, Outlook& expected) {
  expected.shared = {sampling<PoseUnitEvaluator>(plan, borrowed(model), 1.0)};
  const auto trial = std::make_shared<PoseTrial>(study, model, poses);
  const auto prepare = [trial] { trial->prepare(); };
  expected.merging = {{[trial](double) { return trial->merge(); }, 1.0, prepare}};
  expected.by_one = {{[trial](double) {
                        trial->finish();
                        return 1.0;
                      },
                      1.0, prepare}};
}

void add_machine_works(const Study& study, const Model& model, const PoseSet& poses, Outlook& expected) {
  const auto trial = std::make_shared<MachineTrial>(study, model, poses);
  const auto prepare = [trial] { trial->prepare(); };
  expected.shared = {{[trial](double) { return trial->solve(); }}};
  expected.merging = {{[trial](double) { return trial->merge(); }, 1.0, prepare}};
  expected.by_one = {{[trial](double) { return trial->read_pose(); }, 1.0, prepare},
                     {[trial](double) {
                        trial->finish();
                        return 1.0;
                      },
                      1.0, prepare}};
}

}  // namespace

Outlook monte_carlo_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const auto plan = std::make_shared<const Plan>(study, poses);
  const bool machines = plan->draws() == Draws::per_machine;
  Outlook expected{.solves = counted_things(poses.size(), "poses x ") + samples_text(*plan) +
                             (machines ? " machines with " : " samples of ") +
                             counted_things(plan->factors().size(), machines ? "errors = " : "errors together = ") +
                             solves_text(*plan, 1),
                   .memory = monte_carlo_memory(study, model, *plan),
                   .shared = {},
                   .by_one = {},
                   .least = least_share(*plan)};
  if (study.analysis.calibration != nullptr) {
    expected.solves += calibration_cost_text(machine_calibration(study, model, poses).value(), "machine");
  }
  if (machines) {
    add_machine_works(study, model, poses, expected);
  } else {
    add_pose_works(study, model, poses, plan, expected);
  }
  return expected;
}

}  // namespace poesy::monte_carlo
