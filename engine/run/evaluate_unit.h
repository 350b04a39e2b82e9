#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/result.h"
#include "engine/stats/indices.h"
#include "engine/stats/main_effects.h"
#include "engine/stats/moments.h"
#include "engine/stats/number_block.h"
#include "engine/study/plan.h"

namespace poesy {

/// The statistics of one work unit (consecutive samples of one slot at one pose, see Plan).
struct UnitStats {
  /// [responses] Moments of each response over the samples that count in statistics (counts()).
  std::vector<Moments> responses;
  SolveCounts solves;    ///< how the solves of the unit ended
  FailedSamples failed;  ///< the first failed samples

  /// Adds the statistics of later samples. Precondition: the samples of `other` come after those of this object.
  void merge(const UnitStats& other);
  /// Reads or writes the statistics. first: number of the first sample.
  void state(Archive& archive, std::uint64_t first);
};

/// The output of one work unit of a sensitivity study: its statistics, and the sensitivity indices over its first 100,
/// 200, ... samples.
struct CellUnit : UnitStats {
  /// [history points x responses] Local sensitivity indices over the first samples of the unit, for each number of
  /// samples in points_within().
  std::vector<LocalIndex> within;

  /// Reads or writes the unit as a message between ranks. first: number of the first sample of the unit.
  void state(Archive& archive, std::uint64_t first);
};

/// The data of one response in one work unit of a Monte Carlo study, over the samples that count in statistics
/// (counts()).
struct ResponseUnit {
  Moments moments;     ///< moments of the values
  NumberBlock values;  ///< the values, prepared for a quantile sketch

  void state(Archive& archive) { archive.objects(moments, values); }  ///< Reads or writes both members.
};

/// The output of one work unit of a Monte Carlo study.
struct PoseUnit {
  std::vector<ResponseUnit> responses;    ///< [responses] data of each response
  SolveCounts solves;                     ///< how the solves of the unit ended
  FailedSamples failed;                   ///< the first failed samples
  std::optional<MainEffectSums> effects;  ///< sums for main effects; only if the pose is one of effect_poses()

  /// Reads or writes the unit as a message between ranks. first: number of the first sample of the unit. errors: the
  /// number of errors that vary.
  void state(Archive& archive, std::size_t errors, std::uint64_t first);
};

/// Reads or writes how consecutive samples ended: their counts, and the first failures. first: number of the first
/// sample.
void ends_state(Archive& archive, SolveCounts& solves, FailedSamples& failed, std::uint64_t first);
/// Reads or writes how the solves of `count` machines ended; `solves` and `failed` have an element for each pose. The
/// numbers of the machines are in [first, end).
void ends_state(Archive& archive, std::span<SolveCounts> solves, std::span<FailedSamples> failed, std::uint64_t count,
                std::uint64_t first, std::uint64_t end);

/// The numbers of samples after which a sensitivity study with a fixed number of samples records its indices,
/// ascending: 100, 200, 500, 1000, 2000, 5000, ... up to Plan::samples(). Numbers above Plan::kUnitSamples are
/// multiples of it, so each of them is the end of a unit. Empty if the number of samples is adaptive.
std::vector<std::size_t> history_points(const Plan& plan);

/// For the unit with the first samples of an error at a pose: the elements of `points` (history_points()) below
/// unit.count. For later units: none. The result refers to `points`.
std::span<const std::size_t> points_within(const WorkUnit& unit, std::span<const std::size_t> points);

/// The largest number of poses at which a sensitivity study solves again to check an assumption, such as linearity.
inline constexpr std::size_t kSomePoses = 32;

/// The number of poses, at most kSomePoses, at which a sensitivity study with `poses` poses solves samples again to
/// check an assumption.
constexpr std::size_t some_poses(std::size_t poses) { return std::min(kSomePoses, poses); }

/// The n-th of the some_poses(poses) poses, which are evenly spaced in the list of the study's poses. Precondition: n <
/// some_poses(poses).
constexpr PoseIndex some_pose(std::size_t n, std::size_t poses) { return PoseIndex(n * poses / some_poses(poses)); }

/// The outcomes of the samples of one work unit. They refer to memory of the solver, and are valid until its next
/// solve.
struct UnitOutcomes {
  std::span<const double> values;             ///< [varied errors x samples] errors that vary, SI
  std::span<const double> responses;          ///< [responses x samples] responses, SI
  std::span<const SolveStatus> status;        ///< [samples] how each solve ended
  std::span<const std::uint32_t> iterations;  ///< [samples] iterations of each solve
};

/// The base class of the evaluators of work units. It owns the model's evaluator and the scratch memory of one thread.
/// Keeps a reference to the plan.
class UnitSolver {
 protected:
  /// varied: the number of errors that vary together.
  UnitSolver(const Plan& plan, const Model& model, std::size_t varied);

  /// Fills a row with the uniform numbers from which the errors of plan.factors()[slot] are computed.
  void draw_uniforms(const WorkUnit& unit, std::size_t slot, std::span<double> row) const;
  /// Fills values_ [factors x samples] with the errors of the unit. Returns the bins, for main effects, of the uniform
  /// numbers from which the errors were computed.
  EffectBins draw_in_bins(const WorkUnit& unit);
  /// For errors that a machine draws anew at each pose, replaces their rows in values_ [factors x samples] by the draws
  /// at the unit's pose.
  void draw_per_pose(const WorkUnit& unit);
  /// Uses the evaluator `other`, which must outlive these solves, for all further solves until the next call of this
  /// function. null: uses the model's own evaluator again.
  void solve_by(Evaluator* other) { other_ = other; }
  /// The first factors x count numbers of values_ as a block of `count` samples, in which all factors vary. Its pose is
  /// not set.
  SampleBlock drawn(std::size_t count) const;
  /// Solves the first [varied x count] numbers of values_ at a pose. range: the largest magnitude to expect of an
  /// error; 0 if not known. details: memory for the model's additional outputs, see OutcomeBlock; empty if they are not
  /// wanted.
  UnitOutcomes solve(PoseIndex pose, std::span<const FactorIndex> varied, std::size_t count, double range,
                     std::span<double> details = {});

  const Plan* plan_;            ///< the plan whose units are solved
  std::size_t responses_;       ///< number of responses
  std::vector<double> values_;  ///< [varied errors x samples] values of the errors that vary, SI

 private:
  std::unique_ptr<Evaluator> evaluator_;
  Evaluator* other_ = nullptr;
  std::vector<double> outcome_;  ///< [responses x samples] responses, SI
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
};

/// Solves work units of a sensitivity study, one after the other, and owns the scratch memory of one thread. The result
/// of a unit depends only on the plan and the unit.
class UnitEvaluator : private UnitSolver {
 public:
  /// Keeps references to both arguments.
  UnitEvaluator(const Plan& plan, const Model& model);

  /// Solves all samples of the unit, and returns their statistics.
  CellUnit operator()(const WorkUnit& unit);
  /// Solves the samples of the unit, at most Plan::kUnitSamples. The outcome of a sample does not depend on the unit in
  /// which it is solved.
  UnitOutcomes solve(const WorkUnit& unit);
  /// Multiplies the unit's draws by each of these scales, and solves the products: [scales x samples], one scale after
  /// the other. Preconditions: scales are between -1 and 1; there are at most Plan::kUnitSamples products.
  UnitOutcomes solve(const WorkUnit& unit, std::span<const double> scales);

 private:
  std::vector<std::size_t> kept_;    ///< indices in the unit of the samples that count in statistics
  std::vector<std::size_t> points_;  ///< numbers of samples after which indices are recorded
};

/// Solves work units of a Monte Carlo study, in which all factors vary together, one after the other. A factor has the
/// same draws as in a sensitivity study. Owns the scratch memory of one thread. The result of a unit depends only on
/// the plan and the unit.
class PoseUnitEvaluator : private UnitSolver {
 public:
  /// Keeps references to both arguments.
  PoseUnitEvaluator(const Plan& plan, const Model& model);

  /// Solves all samples of the unit, and returns their statistics.
  PoseUnit operator()(const WorkUnit& unit);
  /// Solves the samples of the unit; see UnitEvaluator::solve().
  UnitOutcomes solve(const WorkUnit& unit);

 private:
  /// Solves the samples whose errors are in values_.
  UnitOutcomes solve_drawn(const WorkUnit& unit);
  std::span<const double> only_counting(std::span<const double> outcomes, std::span<const SolveStatus> status);
  MainEffectSums effects_of(const UnitOutcomes& outcomes, const EffectBins& bins) const;

  std::vector<double> kept_;             ///< values of one response in the samples that count in statistics
  std::vector<PoseIndex> effect_poses_;  ///< poses at which main effects are summed
};

}  // namespace poesy
