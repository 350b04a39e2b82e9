#pragma once

#include <span>
#include <vector>

#include "models/assembly/error_frames.h"
#include "models/assembly/model.h"
#include "models/assembly/solver.h"

namespace poesy::assembly {

/// Solves machines whose limbs do not deform each other. Each machine is followed from the perfect one while all its
/// errors grow in proportion. A solution of the equations may belong to another way to assemble the machine (another
/// assembly mode), and large errors may lead a solver there. Here the machine stays in the mode that contains the
/// nominal pose. If the path comes to a singularity, the status is not_assembled, although a path along which the
/// errors grow in another order might avoid the singularity.
///
/// Each stride (growth of the errors) is one solve by Solver::approach(). The stride is halved if the solution may have
/// left the mode (Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 5.1.3). No load acts during the
/// strides, because loads have no influence on whether loops close. Uses plain double arithmetic. An object has scratch
/// memory, so each thread needs its own object.
class Continuation {
 public:
  /// The model must outlive this object.
  Continuation(const AssemblyModel& model, const SolverOptions& options);

  /// Solves the machine with these errors [errors of the model] at this pose. Precondition: the loops at this pose are
  /// regular (Closure::is_regular()). The status is not_assembled if the path comes to a singularity; iteration_cap if
  /// a stride took more iterations than the options allow, or if all strides together took more than 1000; non_finite
  /// if an error is not finite. Otherwise it is the status of the last solve, in which the load acts. `iterations` and
  /// `steps` of the result include those of all strides.
  Solution solve(const Nominal& pose, std::span<const double> errors);

 private:
  SolveStatus follow(const Nominal& pose, std::span<const double> errors, Solution& here);
  const std::vector<std::vector<Transform>>& frames(const Nominal& pose, std::span<const double> errors, double share);

  const AssemblyModel* model_;
  SolverOptions options_;
  Solver on_the_way_;  ///< solver of the strides, with a fixed tolerance
  Solver at_the_end_;  ///< solver of the last solve, with the tolerance of the options
  ErrorFrames frames_;
  std::vector<double> grown_;  ///< [errors of the model] errors of a stride
};

}  // namespace poesy::assembly
