#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/chain/assembly.h"
#include "models/chain/limb.h"
#include "models/chain/loops.h"
#include "models/chain/metric.h"
#include "models/chain/normal_equations.h"

namespace poesy::chain {

/// The end of a deformation solve.
struct Deformation {
  SolveStatus status;        ///< why the solve ended
  std::uint32_t iterations;  ///< number of iterations
};

/// The results of one iteration.
struct DeformationIteration {
  std::span<const double> step;      ///< [passive joints] change of the displacements (rad, m)
  std::span<const double> delta_mu;  ///< [6 x pairs] the residual after the step
  double change;                     ///< c_j of the stopping rule (rad and m; by a metric dimensionless)
};
/// Called after each iteration.
using DeformationObserver = std::function<void(const DeformationIteration&)>;

/// Smaller changes of the residual (rad, m) may be rounding: 64 eps x max(1, reach in m), because rounding errors of
/// positions scale with the reach.
double rounding_level(const ParallelChain& chain);

/// By a metric, smaller changes relative to the reach may be rounding.
inline constexpr double kRelativeRounding = 64.0 * std::numeric_limits<double>::epsilon();

/// Root mean square over the pairs of |delta_mu|_W (m). delta_mu: [6 x pairs].
double gap(const Metric& metric, std::span<const double> delta_mu);

/// Scheme I of Du et al. 2022 (Eqs. 40-44): moves the passive joints so that the poses of the limbs agree as well as
/// possible, by Gauss-Newton on J(q)^T delta_mu(q) = 0. The remaining disagreement is the deformation of the limbs.
///
/// Stopping rule. With c_j the largest component of |delta_mu^j - delta_mu^(j-1)|, iteration j ends the solve as
///     converged      when c_j is below the tolerance;
///     stagnated      when c_j is at rounding_level(chain), and three iterations in a row did not lower the smallest
///                    c so far: only rounding moves the iterate;
///     iteration_cap  when j is the allowed number of iterations;
///     singular       when a pivot of J^T J falls to rounding relative to its diagonal entry;
///     non_finite     when delta_mu^j is not finite.
/// A solve that ends at the cap or as singular, or by a metric after more than kSlowIterations, is not_assembled
/// instead if no solution exists (Assembly). By a metric the equation is J^T W delta_mu = 0, c_j is the gap() of
/// delta_mu^j - delta_mu^(j-1) divided by the reach, and a c_j up to kRelativeRounding that is not below the tolerance
/// ends the solve as stagnated.
///
/// Plain double arithmetic, one sample at a time: the reference for BlockSolver. Owns the scratch of one thread.
class DeformationSolver {
 public:
  /// The chain must outlive the solver.
  DeformationSolver(const ParallelChain& chain, const SolverOptions& options);

  /// Solves one sample. frames [chain.frames()]: fixed frames with errors, limb by limb. displacements [chain.joints()]
  /// (rad, m): nominal on entry, where the solve starts; the last iterate on return, with unchanged actuated entries.
  /// delta_mu [6 x pairs]: the residual at the last iterate, [omega; v] in the base frame (rad, m), Eq. 41. metric:
  /// null for the published equation, W = 1 in rad and m. observe: may be empty. held: as for BlockSolver::prepare().
  Deformation solve(std::span<const lie::Transform<double>> frames, std::span<double> displacements,
                    std::span<double> delta_mu, const Metric* metric = nullptr, const DeformationObserver& observe = {},
                    const Metric* held = nullptr);

 private:
  Deformation iterate(std::span<const lie::Transform<double>> frames, std::span<double> displacements,
                      std::span<double> delta_mu, const Metric* metric, const DeformationObserver& observe);
  double largest_change(std::span<const double> delta_mu) const;
  double relative_change(const Metric& metric, std::span<const double> delta_mu);

  const ParallelChain* chain_;
  SolverOptions options_;
  double rounding_level_;
  std::vector<std::size_t> passive_;  ///< position of each passive joint among all joints
  Loops loops_;
  std::vector<double> previous_;
  NormalEquations equations_;
  Assembly assembly_;
};

}  // namespace poesy::chain
