#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/continuation.h"
#include "models/assembly/error_frames.h"
#include "models/assembly/kernels.h"
#include "models/assembly/model.h"
#include "models/assembly/pose_problem.h"
#include "models/assembly/solver.h"

namespace poesy::assembly {

/// Solves blocks of samples with the fastest kernel that this machine supports. Other solvers treat the samples that
/// the kernel does not solve, or for which it may have found a wrong solution. If limbs do not deform each other,
/// Continuation solves such a sample or finds that it is not_assembled. If limbs deform each other, Closure first
/// decides which samples are not_assembled among those with errors that may open a loop. Solver then solves the
/// remaining samples that the kernel left; it uses the same equations, but a new matrix in each step. Closure also
/// judges the samples that Solver does not solve. An object has scratch memory, so each thread needs its own object.
class BlockSolver {
 public:
  BlockSolver(const AssemblyModel& model, const SolverOptions& options);  ///< The model must outlive this object.

  /// Computes responses, status and iterations of samples at the problem's pose, and additional outputs if the caller
  /// wants them (OutcomeBlock::details).
  /// @{
  /// Exact solution of the equations.
  void solve(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes);
  /// First-order solution, in closed form.
  void map(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes);
  /// @}

 private:
  void run(KernelWork work, PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes);
  void predict_starts(PoseProblem& problem, const SampleBlock& samples);
  bool is_sure(std::size_t sample) const;
  void solve_one(PoseProblem& problem, std::span<const double> errors, std::size_t sample,
                 const OutcomeBlock& outcomes);
  void put(const PoseProblem& problem, const Solution& found, std::size_t sample, const OutcomeBlock& outcomes) const;
  void find_details(const PoseProblem& problem, chain::Fidelity fidelity, const OutcomeBlock& outcomes);

  const AssemblyModel* model_;
  Kernels kernels_;
  Solver solver_;
  Continuation continuation_;
  ErrorFrames frames_;
  std::vector<double> values_;     ///< scratch of PoseProblem::with()
  std::vector<double> responses_;  ///< [responses x stride] responses of each sample
  std::vector<KernelEnd> ends_;    ///< [stride] how the kernel ended each sample
  /// [count] First-order change of ln det N of each sample, from Closure::find_nearing(). A value far below zero means
  /// that a loop may be impossible to close.
  std::vector<double> nearing_;
  std::vector<std::uint32_t> iterations_;  ///< [stride] iterations of each sample
  std::vector<double> states_;             ///< [rows of a state x KernelStart::kTerms] states at the Chebyshev nodes
  std::vector<double> mismatch_;           ///< [6 limbs x stride] KernelBlock::mismatch
};

}  // namespace poesy::assembly
