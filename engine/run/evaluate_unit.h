#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/failed_samples.h"
#include "engine/run/result.h"
#include "engine/stats/indices.h"
#include "engine/stats/moments.h"
#include "engine/study/plan.h"

namespace poesy {

/// What one work unit contributes.
struct UnitStats {
  std::vector<Moments> responses;  ///< [R], over the samples that count
  SolveCounts solves;              ///< how its solves ended
  FailedSamples failed;            ///< the first of them

  /// Precondition: the samples of `other` come after those of this.
  void merge(const UnitStats& other);

  /// Moments, counts and failures, for a state or a message.
  void write(ByteWriter& to) const;
  /// Of samples from `first` on.
  static UnitStats read(ByteReader& from, std::size_t responses, std::uint64_t first);
};

/// What one work unit of a sensitivity study hands on: besides, how the indices stood within it.
struct CellUnit : UnitStats {
  std::vector<LocalIndex> within;  ///< [K x R] of the unit's first samples, up to each of points_within()

  /// As UnitStats, then `within`.
  void write(ByteWriter& to) const;
  /// points: K
  static CellUnit read(ByteReader& from, std::size_t responses, std::uint64_t first, std::size_t points);
};

/// Those of the history points (engine/run/history_points.h) that lie between the unit's samples; only in the first
/// unit of a cell there are any. Refers to the points.
std::span<const std::size_t> points_within(const WorkUnit& unit, std::span<const std::size_t> points);

/// What the samples of one work unit came to. Refers to the scratch of who solved them, until it solves others.
struct UnitOutcomes {
  std::span<const double> values;             ///< [V x B] errors that vary, SI
  std::span<const double> responses;          ///< [R x B]
  std::span<const SolveStatus> status;        ///< [B] how each ended
  std::span<const std::uint32_t> iterations;  ///< [B] that each took
};

/// Solves work units serially. Owns the scratch of one thread; stats depend on the plan and the unit alone.
class UnitEvaluator {
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
  const Plan* plan_;
  std::size_t responses_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> values_;
  std::vector<double> outcome_;
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
  std::vector<std::size_t> kept_;    ///< samples that count
  std::vector<std::size_t> points_;  ///< of the history
};

}  // namespace poesy
