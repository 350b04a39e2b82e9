#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/kernels.h"
#include "models/assembly/model.h"
#include "models/assembly/pose_problem.h"
#include "models/assembly/solver.h"

namespace poesy::assembly {

/// Fixed frames of all limbs with errors.
class ErrorFrames {
 public:
  explicit ErrorFrames(const AssemblyModel& model);  ///< The model must outlive it.

  /// With these errors [F] where joints are nominally so displaced: [limbs][n + 1]. Stays as it is until the next call.
  const std::vector<std::vector<Transform>>& with(std::span<const double> errors,
                                                  std::span<const double> displacements);

 private:
  const AssemblyModel* model_;
  std::vector<std::vector<Transform>> frames_;
  std::vector<std::vector<chain::FrameError<double>>> errors_;
};

/// Solves blocks of samples with the fastest kernel that this machine has, and by Solver those that it leaves: the same
/// equations, with the matrix of each state. Closure decides which samples are not_assembled, of those that Solver
/// leaves and where limbs may hold open loops, by stiffness or against each other, of those whose errors bring loops
/// near their end. Owns the scratch of one thread.
class BlockSolver {
 public:
  BlockSolver(const AssemblyModel& model, const SolverOptions& options);  ///< The model must outlive it.

  /// The model's responses, status and iterations of samples at the problem's pose.
  /// @{
  void solve(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes);  ///< Exactly.
  void map(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes);    ///< To first order.
                                                                                               /// @}

 private:
  void run(KernelWork work, PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes);
  void predict_starts(PoseProblem& problem, const SampleBlock& samples);
  void solve_one(PoseProblem& problem, std::span<const std::vector<Transform>> frames, std::size_t sample,
                 const OutcomeBlock& outcomes);

  const AssemblyModel* model_;
  Kernels kernels_;
  Solver solver_;
  ErrorFrames frames_;
  std::vector<double> values_;             ///< scratch of the problem
  std::vector<double> responses_;          ///< [responses x stride]
  std::vector<KernelEnd> ends_;            ///< [stride]
  std::vector<double> nearing_;            ///< [count] see Closure
  std::vector<std::uint32_t> iterations_;  ///< [stride]
  std::vector<double> states_;             ///< [rows of a state x KernelStart::kTerms] of nodes
};

}  // namespace poesy::assembly
