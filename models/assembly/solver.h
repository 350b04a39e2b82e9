#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/equilibrium.h"

namespace poesy::assembly {

/// An assembly with errors, in equilibrium.
struct Solution {
  std::vector<Transform> bodies;                ///< [bodies] base_T_body
  std::vector<double> displacements;            ///< [joints] (rad, m)
  std::vector<LimbState> limbs;                 ///< [limbs] at these
  std::vector<Screw> mismatch;                  ///< [limbs] xi = log(T_a g_e T_b^-1)
  std::vector<Screw> wrenches;                  ///< [limbs] p
  SolveStatus status = SolveStatus::converged;  ///< how the solve ended
  std::uint32_t iterations = 0;                 ///< that it took
  std::vector<double> steps;  ///< [iterations] of each, the largest move of a body or joint over the reach
};

/// Newton's method on
///
///     C_e p_e = xi_e,     sum of wrenches on each body + load = 0,     J_e^T p_e = 0,
///
/// with C and load of the nominal pose and J where the joints are: each step solves the linear equations (Equilibrium)
/// at the present state, T_b <- exp(V_b) T_b, q <- q + dq. Plain double arithmetic: the reference.
class Solver {
 public:
  /// The assembly must outlive it. ranks: of each limb's passive columns, [limbs].
  Solver(const Assembly& assembly, std::vector<std::size_t> ranks, const SolverOptions& options);

  /// At this pose, which must outlive what follows.
  void prepare(const Nominal& pose);

  /// frames: of each limb with errors, [limbs][n + 1]. Converged when no body and no joint moves a point by more
  /// than the tolerance times the reach. Where full steps come to no end, steps of a quarter are tried once.
  Solution solve(std::span<const std::vector<Transform>> frames) const;

 private:
  Solution attempt(std::span<const std::vector<Transform>> frames, double damping) const;
  void place(std::span<const std::vector<Transform>> frames, Solution& at) const;

  const Assembly* assembly_;
  std::vector<std::size_t> ranks_;
  SolverOptions options_;
  const Nominal* pose_ = nullptr;
};

}  // namespace poesy::assembly
