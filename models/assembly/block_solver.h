#pragma once

#include <functional>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/closure.h"
#include "models/assembly/kernel_problem.h"
#include "models/assembly/model.h"

namespace poesy::assembly {

/// Fixed frames of all limbs with errors.
class ErrorFrames {
 public:
  explicit ErrorFrames(const AssemblyModel& model);  ///< The model must outlive it.

  /// With these errors [F]: [limbs][n + 1]. Stays as it is until the next call.
  const std::vector<std::vector<Transform>>& with(std::span<const double> errors);

 private:
  const AssemblyModel* model_;
  std::vector<std::vector<Transform>> frames_;
  std::vector<std::vector<chain::FrameError<double>>> errors_;
};

/// Solves blocks of samples with the fastest kernel that this machine has, and by Solver those that it leaves: the same
/// equations, with the matrix of each state. Closure decides which of those that Solver leaves are not_assembled. Owns
/// the scratch of one thread.
class BlockSolver {
 public:
  BlockSolver(const AssemblyModel& model, const SolverOptions& options);  ///< The model must outlive it.

  /// Forgets for which pose it has equations.
  void forget() { pose_ = nullptr; }

  /// Calls found(sample, solution) for each sample in order. pose: where they are; must live until the next call, or
  /// until forget().
  void solve(const Nominal& pose, const SampleBlock& samples,
             const std::function<void(std::size_t, const Solution&)>& found);

 private:
  void prepare(const Nominal& pose, const SampleBlock& samples);
  void prepare_pose(const Nominal& pose);
  void prepare_limbs(const Nominal& pose);
  void prepare_errors(const SampleBlock& samples);
  void run(std::size_t count);
  void check_closed(std::span<const double> errors, Solution& found);
  Solution solve_one(std::span<const double> errors);
  const Solution& read(const Nominal& pose, std::span<const double> errors, std::size_t sample);

  const AssemblyModel* model_;
  SolverOptions options_;
  KernelSolve kernel_;
  Solver solver_;
  Closure closure_;
  ErrorFrames frames_;
  const Nominal* pose_ = nullptr;          ///< for which the equations are
  std::vector<double> values_;             ///< [entries x stride]
  std::vector<double> rows_;               ///< [KernelProblem::rows() x stride]
  std::vector<KernelEnd> ends_;            ///< [stride]
  std::vector<std::uint32_t> iterations_;  ///< [stride]
  std::optional<Equilibrium> equations_;
  KernelProblem problem_;
  Solution solution_;
};

}  // namespace poesy::assembly
