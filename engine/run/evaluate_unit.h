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

/// What one work unit contributes.
struct UnitStats {
  std::vector<Moments> responses;  ///< [R], over the samples that count
  SolveCounts solves;              ///< how its solves ended
  FailedSamples failed;            ///< the first of them

  /// Precondition: the samples of `other` come after those of this.
  void merge(const UnitStats& other);
  /// Of samples from `first` on, for a state or a message.
  void state(Archive& archive, std::uint64_t first);
};

/// What one work unit of a sensitivity study hands on: its statistics, and the indices over the first of its samples.
struct CellUnit : UnitStats {
  std::vector<LocalIndex> within;  ///< [K x R] of the unit's first samples, up to each of points_within()

  /// For a message; of samples from `first` on.
  void state(Archive& archive, std::uint64_t first);
};

/// What one work unit of a Monte Carlo study contributes to one response, over the samples that count.
struct ResponseUnit {
  Moments moments;     ///< mean and spread
  NumberBlock values;  ///< the same samples, ready for a sketch

  void state(Archive& archive) { archive.objects(moments, values); }  ///< Both.
};

/// What one work unit of a Monte Carlo study contributes.
struct PoseUnit {
  std::vector<ResponseUnit> responses;    ///< [R]
  SolveCounts solves;                     ///< how its solves ended
  FailedSamples failed;                   ///< the first of them
  std::optional<MainEffectSums> effects;  ///< at the poses where main effects are added up

  /// For a message; of samples from `first` on. errors: that vary.
  void state(Archive& archive, std::size_t errors, std::uint64_t first);
};

/// How the samples of a unit or a cell from `first` on ended.
void ends_state(Archive& archive, SolveCounts& solves, FailedSamples& failed, std::uint64_t first);
/// How `count` machines, with numbers first .. end - 1, ended at each pose.
void ends_state(Archive& archive, std::span<SolveCounts> solves, std::span<FailedSamples> failed, std::uint64_t count,
                std::uint64_t first, std::uint64_t end);

/// The numbers of samples of a cell at which a sensitivity study with a fixed number of samples looks at its indices,
/// ascending: 100, 200, 500, 1000, 2000, 5000, ... up to Plan::samples(), which is one of them only by chance. More
/// samples only add to the list. Those above Plan::kUnitSamples are whole units. None where the samples are adaptive.
std::vector<std::size_t> history_points(const Plan& plan);

/// The history points between the unit's samples; only in the first unit of a cell there are any. Refers to the points.
std::span<const std::size_t> points_within(const WorkUnit& unit, std::span<const std::size_t> points);

/// The most poses at which a sensitivity study is checked a second time.
inline constexpr std::size_t kSomePoses = 32;

/// The number of such poses in a study with this many poses.
constexpr std::size_t some_poses(std::size_t poses) { return std::min(kSomePoses, poses); }

/// The n-th of them: evenly spaced over the order of the study's poses. Precondition: n < some_poses(poses).
constexpr PoseIndex some_pose(std::size_t n, std::size_t poses) { return PoseIndex(n * poses / some_poses(poses)); }

/// What the samples of one work unit came to. Refers to the scratch of who solved them, until it solves others.
struct UnitOutcomes {
  std::span<const double> values;             ///< [V x B] errors that vary, SI
  std::span<const double> responses;          ///< [R x B]
  std::span<const SolveStatus> status;        ///< [B] how each ended
  std::span<const std::uint32_t> iterations;  ///< [B] that each took
};

/// What evaluators of work units share: the model's evaluator and the scratch of one thread. Refers to the plan.
class UnitSolver {
 protected:
  /// varied: errors that vary at once.
  UnitSolver(const Plan& plan, const Model& model, std::size_t varied);

  /// Fills a row with the uniforms from which the errors of this slot are made.
  void draw_uniforms(const WorkUnit& unit, std::size_t slot, std::span<double> row) const;
  /// Fills values_ with the draws of all factors, one row behind the other, and gives the bins into which they fall.
  EffectBins draw_in_bins(const WorkUnit& unit);
  /// Solves the first [varied x count] of values_ at a pose. details: as of OutcomeBlock.
  UnitOutcomes solve(PoseIndex pose, std::span<const FactorIndex> varied, std::size_t count, double range,
                     std::span<double> details = {});

  const Plan* plan_;            ///< whose units are solved
  std::size_t responses_;       ///< R
  std::vector<double> values_;  ///< [V x B]

 private:
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> outcome_;  ///< [R x B]
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
};

/// Solves work units of a sensitivity study serially. Owns the scratch of one thread; stats depend on the plan and the
/// unit alone.
class UnitEvaluator : private UnitSolver {
 public:
  /// Refers to both.
  UnitEvaluator(const Plan& plan, const Model& model);

  /// Solves the whole unit.
  CellUnit operator()(const WorkUnit& unit);
  /// Any samples of a cell, at most Plan::kUnitSamples of them: what they come to is the same whatever the unit.
  UnitOutcomes solve(const WorkUnit& unit);
  /// The unit's draws times each of these scales, [scales x B] one behind the other, at most Plan::kUnitSamples in all.
  /// Precondition: scales between -1 and 1.
  UnitOutcomes solve(const WorkUnit& unit, std::span<const double> scales);

 private:
  std::vector<std::size_t> kept_;    ///< samples that count
  std::vector<std::size_t> points_;  ///< of the history
};

/// Solves work units of a Monte Carlo study serially, all factors varying together. Factor f draws from the address
/// that it has in a sensitivity study. Owns the scratch of one thread; what a unit gives depends on the plan and the
/// unit.
class PoseUnitEvaluator : private UnitSolver {
 public:
  /// Refers to both.
  PoseUnitEvaluator(const Plan& plan, const Model& model);

  /// Solves the whole unit.
  PoseUnit operator()(const WorkUnit& unit);
  /// As UnitEvaluator::solve.
  UnitOutcomes solve(const WorkUnit& unit);

 private:
  /// Of what is in values_.
  UnitOutcomes solve_drawn(const WorkUnit& unit);
  std::span<const double> only_counting(std::span<const double> outcomes, std::span<const SolveStatus> status);
  MainEffectSums effects_of(const UnitOutcomes& outcomes, const EffectBins& bins) const;

  std::vector<double> kept_;             ///< one response of the samples that count
  std::vector<PoseIndex> effect_poses_;  ///< where main effects are added up
};

}  // namespace poesy
