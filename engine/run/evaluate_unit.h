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

/// The statistics of one work unit.
struct UnitStats {
  std::vector<Moments> responses;  ///< [R] over the samples that count
  SolveCounts solves;              ///< how its solves ended
  FailedSamples failed;            ///< the first failed samples

  /// Adds later samples. Precondition: the samples of `other` come after those of this object.
  void merge(const UnitStats& other);
  /// Reads or writes the statistics of samples from `first` on.
  void state(Archive& archive, std::uint64_t first);
};

/// The output of one work unit of a sensitivity study: its statistics, and indices over the first of its samples.
struct CellUnit : UnitStats {
  std::vector<LocalIndex> within;  ///< [K x R] indices over the samples of the unit up to each of points_within()

  /// Reads or writes the unit as a message, for samples from `first` on.
  void state(Archive& archive, std::uint64_t first);
};

/// One response in one work unit of a Monte Carlo study, over the samples that count.
struct ResponseUnit {
  Moments moments;     ///< mean and spread
  NumberBlock values;  ///< the same samples, prepared for a sketch

  void state(Archive& archive) { archive.objects(moments, values); }  ///< Reads or writes both.
};

/// The output of one work unit of a Monte Carlo study.
struct PoseUnit {
  std::vector<ResponseUnit> responses;    ///< [R]
  SolveCounts solves;                     ///< how its solves ended
  FailedSamples failed;                   ///< the first failed samples
  std::optional<MainEffectSums> effects;  ///< main effects, at the poses where they are summed

  /// Reads or writes the unit as a message, for samples from `first` on. errors: the number of errors that vary.
  void state(Archive& archive, std::size_t errors, std::uint64_t first);
};

/// Reads or writes how the samples of a unit or a cell, from `first` on, ended.
void ends_state(Archive& archive, SolveCounts& solves, FailedSamples& failed, std::uint64_t first);
/// Reads or writes how `count` machines with numbers in [first, end) ended, at each pose.
void ends_state(Archive& archive, std::span<SolveCounts> solves, std::span<FailedSamples> failed, std::uint64_t count,
                std::uint64_t first, std::uint64_t end);

/// The numbers of samples after which a sensitivity study with a fixed number of samples records its indices,
/// ascending: 100, 200, 500, 1000, 2000, 5000, ... up to Plan::samples(). More samples only extend the list. Numbers
/// above Plan::kUnitSamples are whole units. Empty if samples are adaptive.
std::vector<std::size_t> history_points(const Plan& plan);

/// The history points inside the unit; only the first unit of a cell has some. Refers to `points`.
std::span<const std::size_t> points_within(const WorkUnit& unit, std::span<const std::size_t> points);

/// The largest number of poses at which a sensitivity study is checked a second time.
inline constexpr std::size_t kSomePoses = 32;

/// The number of these poses in a study with `poses` poses.
constexpr std::size_t some_poses(std::size_t poses) { return std::min(kSomePoses, poses); }

/// The n-th of these poses; they are evenly spaced over the order of the study's poses. Precondition: n <
/// some_poses(poses).
constexpr PoseIndex some_pose(std::size_t n, std::size_t poses) { return PoseIndex(n * poses / some_poses(poses)); }

/// The outcomes of the samples of one work unit. Refers to the solver's scratch, and is valid until its next solve.
struct UnitOutcomes {
  std::span<const double> values;             ///< [V x B] errors that vary, SI
  std::span<const double> responses;          ///< [R x B]
  std::span<const SolveStatus> status;        ///< [B] how each ended
  std::span<const std::uint32_t> iterations;  ///< [B] iterations of each sample
};

/// The base of evaluators of work units: the model's evaluator and the scratch of one thread. Refers to the plan.
class UnitSolver {
 protected:
  /// varied: the number of errors that vary together.
  UnitSolver(const Plan& plan, const Model& model, std::size_t varied);

  /// Fills a row with the uniforms from which the errors of this slot are computed.
  void draw_uniforms(const WorkUnit& unit, std::size_t slot, std::span<double> row) const;
  /// Fills values_ with the draws of all factors, one row after the other, and returns the bins of the draws.
  EffectBins draw_in_bins(const WorkUnit& unit);
  /// Replaces, in values_ [P x B], the errors that machines draw anew at each pose by those of the unit's pose.
  void draw_per_pose(const WorkUnit& unit);
  /// Solves the first [varied x count] values at a pose. details: see OutcomeBlock.
  UnitOutcomes solve(PoseIndex pose, std::span<const FactorIndex> varied, std::size_t count, double range,
                     std::span<double> details = {});

  const Plan* plan_;            ///< the plan whose units are solved
  std::size_t responses_;       ///< R
  std::vector<double> values_;  ///< [V x B]

 private:
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> outcome_;  ///< [R x B]
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
};

/// Solves work units of a sensitivity study serially. Owns the scratch of one thread. The result of a unit depends only
/// on the plan and the unit.
class UnitEvaluator : private UnitSolver {
 public:
  /// Refers to both arguments.
  UnitEvaluator(const Plan& plan, const Model& model);

  /// Solves the whole unit.
  CellUnit operator()(const WorkUnit& unit);
  /// Solves any samples of a cell, at most Plan::kUnitSamples. The outcome of a sample does not depend on the unit.
  UnitOutcomes solve(const WorkUnit& unit);
  /// Solves the unit's draws times each of these scales, [scales x B] one after the other, at most Plan::kUnitSamples
  /// in all. Precondition: scales are between -1 and 1.
  UnitOutcomes solve(const WorkUnit& unit, std::span<const double> scales);

 private:
  std::vector<std::size_t> kept_;    ///< samples that count
  std::vector<std::size_t> points_;  ///< history points
};

/// Solves work units of a Monte Carlo study serially, in which all factors vary together. Factor f draws from the
/// address that it has in a sensitivity study. Owns the scratch of one thread. The result of a unit depends only on the
/// plan and the unit.
class PoseUnitEvaluator : private UnitSolver {
 public:
  /// Refers to both arguments.
  PoseUnitEvaluator(const Plan& plan, const Model& model);

  /// Solves the whole unit.
  PoseUnit operator()(const WorkUnit& unit);
  /// Solves any samples of a cell; see UnitEvaluator::solve().
  UnitOutcomes solve(const WorkUnit& unit);

 private:
  /// Solves the draws in values_.
  UnitOutcomes solve_drawn(const WorkUnit& unit);
  std::span<const double> only_counting(std::span<const double> outcomes, std::span<const SolveStatus> status);
  MainEffectSums effects_of(const UnitOutcomes& outcomes, const EffectBins& bins) const;

  std::vector<double> kept_;             ///< one response of the samples that count
  std::vector<PoseIndex> effect_poses_;  ///< poses at which main effects are summed
};

}  // namespace poesy
