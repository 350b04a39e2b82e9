#pragma once

#include <memory>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/result.h"
#include "engine/stats/moments.h"
#include "engine/study/plan.h"

namespace poesy {

/// What one work unit contributes.
struct UnitStats {
  std::vector<Moments> responses;  ///< [R], over the samples that count
  SolveCounts solves;

  void merge(const UnitStats& other);

  void write(ByteWriter& to) const;
  static UnitStats read(ByteReader& from, std::size_t responses);
};

/// Solves work units serially. Owns the scratch of one thread; stats depend on the plan and the unit alone.
class UnitEvaluator {
 public:
  UnitEvaluator(const Plan& plan, const Model& model);

  UnitStats operator()(const WorkUnit& unit);

 private:
  const Plan* plan_;
  std::size_t responses_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> values_;
  std::vector<double> outcome_;
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
  std::vector<std::size_t> kept_;  ///< samples that count
};

}  // namespace poesy
