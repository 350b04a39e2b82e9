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

/// Solves blocks of samples with the fastest kernel that this machine has. If limbs do not deform each other,
/// Continuation solves the samples of which the kernel is not sure, and says which are not_assembled. If they do,
/// Closure decides first which samples are not_assembled among those whose errors may open a loop. Solver solves the
/// other samples that the kernel does not solve: the same equations, with the matrix of each state. Closure is also
/// asked about the samples that Solver does not solve. Owns the scratch of one thread.
class BlockSolver {
 public:
  BlockSolver(const AssemblyModel& model, const SolverOptions& options);  ///< The model must outlive this object.

  /// Computes responses, status and iterations of samples at the problem's pose, and additional outputs if the caller
  /// wants them (OutcomeBlock::details).
  /// @{
  /// Solves the equations exactly.
  void solve(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes);
  /// Solves the equations to first order.
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
  std::vector<double> values_;     ///< scratch memory for the values of those components of frames' errors that vary
  std::vector<double> responses_;  ///< [responses x stride] responses of each sample
  std::vector<KernelEnd> ends_;    ///< [stride] how the kernel ended each sample
  std::vector<double> nearing_;    ///< [count] Closure::find_nearing() of each sample
  std::vector<std::uint32_t> iterations_;  ///< [stride] iterations of each sample
  std::vector<double> states_;             ///< [rows of a state x KernelStart::kTerms] states at the Chebyshev nodes
  std::vector<double> mismatch_;           ///< [6 limbs x stride] mismatch, see KernelBlock
};

}  // namespace poesy::assembly
