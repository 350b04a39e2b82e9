#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/result.h"
#include "engine/stats/moments.h"
#include "engine/stats/quantile_sketch.h"
#include "engine/study/plan.h"

namespace poesy {

/// What some of the samples at a pose contribute to one response.
struct ResponseSamples {
  Moments moments;
  QuantileSketch sketch;

  void merge(const ResponseSamples& other);
};

/// What one work unit contributes to one response.
struct ResponseUnit {
  Moments moments;
  BucketedValues values;
};

/// What one work unit of a Monte Carlo study contributes.
struct PoseUnit {
  std::vector<ResponseUnit> responses;  ///< [R], over the samples that count
  SolveCounts solves;
};

/// Solves work units of a Monte Carlo study serially, all factors varying together. Factor f draws from the address
/// that it has in a sensitivity study. Owns the scratch of one thread; what a unit gives depends on the plan and the
/// unit.
class PoseUnitEvaluator {
 public:
  PoseUnitEvaluator(const Plan& plan, const Model& model);

  PoseUnit operator()(const WorkUnit& unit);

 private:
  void draw(const WorkUnit& unit);
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

/// Puts units together, in the order of the plan. Holds the samples of one pose, as sketches, and those of all poses
/// together: memory grows neither with the samples nor, but for the result, with the poses.
class MonteCarloCollector {
 public:
  MonteCarloCollector(const Plan& plan, std::size_t responses, const Analysis& analysis);

  /// Units of a pose come one after another.
  void add(PoseIndex pose, const PoseUnit& unit);
  /// Precondition: every unit was added.
  MonteCarloResult result() &&;

 private:
  void finish_pose();

  std::size_t samples_;
  PoseIndex pose_;
  std::vector<ResponseSamples> at_pose_;  ///< [R]
  SolveCounts solves_at_pose_;
  std::vector<ResponseSamples> overall_;  ///< [R]
  MonteCarloResult result_;
};

}  // namespace poesy
