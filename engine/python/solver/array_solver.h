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

/// Arrays in the caller's memory for M poses with B samples of P errors each, SI. The arrays do not overlap.
struct ArrayJob {
  std::span<const double> poses;  ///< [M x pose coordinates], row-major, checked (ArraySolver::check_poses)
  const double* errors;           ///< [P x B] errors at the first pose; all samples of the first error come first
  /// Number of elements from the errors of one pose to those of the next; 0: all poses have the same errors.
  std::size_t step;
  std::size_t samples;  ///< number of samples, B
  double* responses;    ///< [M x R x B], row-major; NaN if a sample was not solved
  SolveStatus* status;  ///< [M x B] how each sample ended; null: not wanted
};

/// Solves arrays of errors of one mechanism, directly in the caller's memory. Threads may call it at the same time.
/// Each call has its own scratch memory, which later calls reuse.
class ArraySolver {
 public:
  /// Uses the study's mechanism, its solver settings, and the errors that it varies. Throws InputError as build_model()
  /// does, and if a response is relative to the previous pose.
  explicit ArraySolver(Study study);

  const ModelDescription& description() const { return model_->description(); }  ///< The description of the mechanism.
  /// [P] The errors that arrays contain.
  const std::vector<FactorIndex>& factors() const { return study_.analysis.factors; }

  /// Throws InputError for the first pose that is not finite or out of reach. poses: [M x coordinates], SI.
  void check_poses(std::span<const double> poses) const;

  /// Solves all poses and samples of a job. between(): called from time to time; may throw to end the job.
  void solve(const ArrayJob& job, const std::function<void()>& between) const;

 private:
  /// The scratch memory of one call. It is needed in addition to the caller's arrays.
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
  std::vector<double> zeros_;  ///< [F] zero errors of all factors
  mutable std::mutex mutex_;   ///< protects the list of unused scratch memory
  mutable std::vector<std::unique_ptr<Scratch>> idle_;
};

}  // namespace poesy::python
