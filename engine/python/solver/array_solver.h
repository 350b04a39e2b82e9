#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "engine/base/index.h"
#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy::python {

/// Arrays in the caller's memory: M poses with B samples of P errors each, SI. They do not overlap.
struct ArrayJob {
  std::span<const double> poses;  ///< [M x pose coordinates], row-major, checked (ArraySolver::check_poses)
  const double* errors;           ///< [P x B] at the first pose, all samples of the first error first
  std::size_t step;               ///< numbers from one pose's errors to the next; 0: all poses have the same errors
  std::size_t samples;            ///< B
  double* responses;              ///< [M x R x B], row-major; NaN if a sample was not solved
  SolveStatus* status;            ///< [M x B]; null: not wanted
};

/// Solves arrays of errors of one mechanism in place. Threads may call it at the same time: each call has its own
/// scratch, which is reused by later calls.
class ArraySolver {
 public:
  /// Uses the study's mechanism, its solver, and the errors that it varies. Throws InputError as build_model() does.
  explicit ArraySolver(Study study);

  const ModelDescription& description() const { return model_->description(); }  ///< The description of the mechanism.
  const std::vector<FactorIndex>& factors() const { return study_.analysis.factors; }  ///< [P] The errors.

  /// Throws InputError for the first of the poses [M x coordinates] that is not finite or out of reach.
  void check_poses(std::span<const double> poses) const;

  /// Solves a whole job. between() is called from time to time, and may throw to end it.
  void solve(const ArrayJob& job, const std::function<void()>& between) const;

 private:
  /// The scratch of one call, in addition to the caller's arrays.
  struct Scratch {
    std::unique_ptr<Evaluator> evaluator;
    std::vector<double> errors;     ///< [P x block], if a call has more samples than a block
    std::vector<double> responses;  ///< [R x block], if a call has more samples than a block
    std::vector<SolveStatus> status;
    std::vector<std::uint32_t> iterations;
  };

  std::unique_ptr<Scratch> take_scratch() const;
  void solve_in_place(Scratch& scratch, std::span<const double> pose, const double* errors, std::size_t count,
                      double* responses, SolveStatus* status) const;
  void solve_block(Scratch& scratch, std::span<const double> pose, const ArrayJob& job, std::size_t m,
                   std::size_t first, std::size_t count) const;

  Study study_;
  std::unique_ptr<Model> model_;
  std::vector<double> zeros_;  ///< [F]
  mutable std::mutex mutex_;   ///< protects the members below
  mutable std::vector<std::unique_ptr<Scratch>> idle_;
};

}  // namespace poesy::python
