#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/chain/assembly.h"
#include "models/chain/limb.h"
#include "models/chain/loops.h"
#include "models/chain/metric.h"
#include "models/chain/normal_equations.h"

namespace poesy::chain {

/// How a deformation solve ended.
struct Deformation {
  SolveStatus status;        ///< why the solve ended
  std::uint32_t iterations;  ///< number of iterations
};

/// The step and the residual of one iteration.
struct DeformationIteration {
  std::span<const double> step;      ///< [passive joints] change of the passive displacements (rad, m)
  std::span<const double> delta_mu;  ///< [6 x pairs] residual after the step (rad, m)
  double change;  ///< largest change of the residual (rad, m): c_j in the stopping rule of DeformationSolver
};
/// A function that the solver calls after each iteration.
using DeformationObserver = std::function<void(const DeformationIteration&)>;

/// The level below which a change of the residual (rad, m) may be rounding: 64 eps x max(1, reach in m). Rounding
/// errors of positions are proportional to the reach.
double rounding_level(const ParallelChain& chain);

/// Scheme I of Du et al. 2022 (Eqs. 40-44). Moves the passive joints until the poses of the limbs agree as well as
/// possible, by Gauss-Newton on J(q)^T delta_mu(q) = 0. The remaining disagreement is the deformation of the limbs.
///
/// Stopping rule: let c_j be the largest absolute component of delta_mu^j - delta_mu^(j-1). Iteration j ends the solve
/// as
///     converged      when c_j is below the tolerance;
///     stagnated      when c_j is at most rounding_level(chain), and three iterations in a row did not lower
///                    the smallest c so far: only rounding moves the iterate;
///     iteration_cap  when j is the allowed number of iterations;
///     singular       when a pivot of J^T J falls to rounding relative to its diagonal entry;
///     non_finite     when delta_mu^j is not finite.
/// If Assembly finds that the machine cannot be assembled, the status is not_assembled instead, except after
/// non_finite.
///
/// Uses plain double arithmetic, one sample at a time; tests compare BlockSolver with it. An object has scratch memory,
/// so each thread needs its own object.
class DeformationSolver {
 public:
  /// The chain must outlive the solver.
  DeformationSolver(const ParallelChain& chain, const SolverOptions& options);

  /// Solves one sample. frames: [chain.frames()] fixed frames with errors, limb by limb. displacements:
  /// [chain.joints()] (rad, m); on entry the nominal ones, at which the solve starts; on return those of the last
  /// iterate, with unchanged actuated entries. delta_mu: [6 x pairs] residual at the last iterate, [omega; v] in the
  /// base frame (rad, m), Eq. 41. observe: may be empty. held: as for BlockSolver::prepare().
  Deformation solve(std::span<const lie::Transform<double>> frames, std::span<double> displacements,
                    std::span<double> delta_mu, const DeformationObserver& observe = {}, const Metric* held = nullptr);

 private:
  Deformation iterate(std::span<const lie::Transform<double>> frames, std::span<double> displacements,
                      std::span<double> delta_mu, const DeformationObserver& observe);
  double largest_change(std::span<const double> delta_mu) const;

  const ParallelChain* chain_;
  SolverOptions options_;
  double rounding_level_;
  std::vector<std::size_t> passive_;  ///< index of each passive joint among all joints
  Loops loops_;
  std::vector<double> previous_;
  NormalEquations equations_;
  Assembly assembly_;
};

}  // namespace poesy::chain
