#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/equilibrium.h"

namespace poesy::assembly {

/// The equilibrium of an assembly with errors.
struct Solution {
  std::vector<Transform> bodies;      ///< [bodies] base_T_body
  std::vector<double> displacements;  ///< [joints] displacements (rad, m)
  std::vector<LimbState> limbs;       ///< [limbs] states of the limbs
  std::vector<Screw> mismatch;  ///< [limbs] mismatch xi = log(g T^-1); g: pose of the end, T: pose of the body there
  std::vector<Screw> wrenches;  ///< [limbs] wrench p of each limb on the body at its end
  SolveStatus status = SolveStatus::converged;  ///< how the solve ended
  std::uint32_t iterations = 0;                 ///< number of iterations
  /// [iterations] Largest move of a body or joint in each iteration, divided by the reach.
  std::vector<double> steps;
};

/// The places of bodies and joints at which a solve begins.
struct SolverStart {
  std::span<const Transform> bodies;      ///< [bodies] base_T_body
  std::span<const double> displacements;  ///< [joints] (rad, m)
};

/// Newton's method on
///
///     C_e p_e = xi_e,     sum of wrenches on each body + load = 0,     J_e^T p_e = 0,
///
/// for each limb e, with the symbols of Equilibrium, C and load of the nominal pose, and J in the present state. Each
/// step solves the linear equations (Equilibrium) in the present state. Then it changes the pose T_b of each body b to
/// exp(V_b) T_b, and the displacements q of the joints to q + dq. Uses plain double arithmetic, one sample at a time;
/// tests compare the kernels with it.
class Solver {
 public:
  /// The assembly must outlive this object. ranks: [limbs] rank of the columns of each limb's passive joints.
  Solver(const Assembly& assembly, std::vector<std::size_t> ranks, const SolverOptions& options);

  /// Sets the nominal pose, which must outlive the solves.
  void prepare(const Nominal& pose);

  /// Solves for these fixed frames of each limb, with errors. The solve has converged if no body and no joint moves a
  /// point by more than the tolerance times the reach. If full steps do not converge, quarter steps are tried once.
  Solution solve(std::span<const std::vector<Transform>> frames) const;

  /// Solves for frames with errors like the function above, but begins at `start` instead of the nominal pose.
  Solution solve(std::span<const std::vector<Transform>> frames, const SolverStart& start) const;

  /// Solves for frames with errors from `start`, without load and only by full steps. Gives up, with the status
  /// iteration_cap, if the first step is long, or if a later step is not much shorter than the step before, because the
  /// solution may then belong to another way to assemble the machine.
  Solution approach(std::span<const std::vector<Transform>> frames, const SolverStart& start) const;

 private:
  /// How attempt() makes its steps.
  struct Manner {
    double damping = 1.0;      ///< factor of each step
    bool is_loaded = true;     ///< true if the load acts
    bool must_shrink = false;  ///< true: gives up at a long first step, or if steps do not shrink
  };

  Solution attempt(std::span<const std::vector<Transform>> frames, const SolverStart& start,
                   const Manner& manner) const;
  void place(std::span<const std::vector<Transform>> frames, Solution& at) const;

  const Assembly* assembly_;
  std::vector<std::size_t> ranks_;
  SolverOptions options_;
  const Nominal* pose_ = nullptr;
};

}  // namespace poesy::assembly
