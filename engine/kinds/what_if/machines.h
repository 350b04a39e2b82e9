#pragma once

#include <cstddef>
#include <span>

#include "engine/base/array.h"
#include "engine/kinds/limited_vectors.h"
#include "engine/model/model.h"
#include "engine/run/evaluate_unit.h"
#include "engine/study/plan.h"

namespace poesy {

/// The first machines of a study, drawn again, whose errors can be scaled. Owns the scratch memory of one thread. Keeps
/// references to the plan, the model and the vectors. Precondition: the study draws errors per machine.
class WhatIfMachines : private UnitSolver {
 public:
  /// The components of all limited vectors (LimitedVector) at a pose, for each machine; NaN if the machine is not
  /// solved.
  using Rows = Array<double, axis::VectorRow, axis::Sample>;
  /// The derivatives of the components of all limited vectors with respect to each error, SI.
  using Slopes = Array<double, axis::VectorRow, axis::Factor>;

  /// machines: the number of machines, at most Plan::kUnitSamples and Plan::samples().
  WhatIfMachines(const Plan& plan, const Model& model, const LimitedVectors& vectors, std::size_t machines);

  std::size_t machines() const { return machines_; }  ///< The number of machines.
  /// [errors x machines] The deviation of each error from its mean, SI.
  const Array<double, axis::Factor, axis::Sample>& deviations() const { return deviations_; }
  /// Solves the machines at a pose. The deviation of each error from its mean is multiplied by a factor; errors that
  /// machines draw anew at each pose keep their size. sizes: [errors] factors.
  Rows solve(PoseIndex pose, std::span<const double> sizes);
  /// The derivatives at the mean errors: central differences with a step of half a standard deviation. NaN if a solve
  /// failed.
  Slopes slopes(PoseIndex pose);

 private:
  /// Solves the sets of errors in the first `count` columns of `values_`.
  Rows rows_of(PoseIndex pose, std::size_t count);

  const LimitedVectors* vectors_;
  std::size_t machines_;
  Array<double, axis::Factor, axis::Sample> deviations_;
};

}  // namespace poesy
