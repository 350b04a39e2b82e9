#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/stats/moments.h"
#include "engine/stats/quantile_sketch.h"
#include "engine/study/plan.h"

namespace poesy {

/// What one work unit contributes to one response.
struct ResponseUnit {
  Moments moments;        ///< over the samples that count
  BucketedValues values;  ///< the same samples, ready for a sketch
};

/// What one work unit of a Monte Carlo study contributes.
struct PoseUnit {
  std::vector<ResponseUnit> responses;  ///< [R], over the samples that count
  SolveCounts solves;                   ///< how its solves ended
  FailedSamples failed;                 ///< the first of them

  /// For a message.
  void write(ByteWriter& to) const;
  /// Of samples from `first` on.
  static PoseUnit read(ByteReader& from, std::size_t responses, std::uint64_t first);
};

/// Solves work units of a Monte Carlo study serially, all factors varying together. Factor f draws from the address
/// that it has in a sensitivity study. Owns the scratch of one thread; what a unit gives depends on the plan and the
/// unit.
class PoseUnitEvaluator {
 public:
  /// Refers to both.
  PoseUnitEvaluator(const Plan& plan, const Model& model);

  /// Solves the whole unit.
  PoseUnit operator()(const WorkUnit& unit);
  /// As UnitEvaluator::solve.
  UnitOutcomes solve(const WorkUnit& unit);

 private:
  std::span<const double> draw(const WorkUnit& unit);
  std::span<const double> only_counting(std::span<const double> outcomes, std::span<const SolveStatus> status);

  const Plan* plan_;
  std::size_t responses_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> values_;   ///< [V x B]
  std::vector<double> outcome_;  ///< [R x B]
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
  std::vector<double> kept_;  ///< one response of the samples that count
};

}  // namespace poesy
