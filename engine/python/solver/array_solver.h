#pragma once

#include <atomic>
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

/// Arrays in the caller's memory with the errors and responses of samples at some poses, SI. The arrays do not overlap.
struct ArrayJob {
  std::span<const double> poses;  ///< [poses x pose coordinates], row-major, checked (ArraySolver::check_poses)
  /// [errors x samples] The errors at the first pose; all samples of the first error come first.
  const double* errors;
  /// Number of elements from the errors at one pose to the errors at the next; 0 if all poses have the same errors.
  std::size_t step;
  std::size_t samples;  ///< number of samples at each pose
  double* responses;    ///< [poses x responses x samples], row-major; NaN if a sample was not solved
  SolveStatus* status;  ///< [poses x samples] how the solve of each sample ended; null if this is not wanted
};

/// Computes responses for arrays of errors of one mechanism, directly in the caller's memory. Several threads may use
/// the same object at the same time. Each call has its own scratch memory, which later calls reuse.
class ArraySolver {
 public:
  /// Uses the study's mechanism, solver settings and varied errors. Throws InputError as build_model() does, and if a
  /// response is relative to the previous pose.
  explicit ArraySolver(Study study);

  const ModelDescription& description() const { return model_->description(); }  ///< The description of the mechanism.
  /// The errors that arrays contain, in this order.
  const std::vector<FactorIndex>& factors() const { return study_.analysis.factors; }

  /// Throws InputError for the first pose that is not finite or out of reach. poses: [poses x coordinates], SI.
  void check_poses(std::span<const double> poses) const;

  /// Warnings of geometry that may be a mistake (mechanism_doubts()), one line each.
  std::vector<std::string> doubts() const;

  /// A warning of poses that are farther outside the workspace than the workspace is wide; empty if there are no such
  /// poses, or if an earlier call returned a warning. poses: [poses x coordinates], SI.
  std::string far_poses(std::span<const double> poses) const;

  /// Solves all samples of a job. between: is called from time to time, and may throw to end the job.
  void solve(const ArrayJob& job, const std::function<void()>& between) const;

 private:
  /// The scratch memory of one call. A call with more than kBlock samples solves them in blocks of at most kBlock
  /// samples. It copies the errors of a block from the caller's array to `errors`, and after the solve the responses
  /// from `responses` to the caller's array.
  struct Scratch {
    std::unique_ptr<Evaluator> evaluator;
    std::vector<double> errors;     ///< [errors x kBlock] errors of a block
    std::vector<double> responses;  ///< [responses x kBlock] responses of a block
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
  std::vector<double> zeros_;                     ///< [factors] zero errors of all factors
  mutable std::atomic<bool> has_warned_ = false;  ///< whether far_poses() has returned a warning
  mutable std::mutex mutex_;                      ///< protects the list of unused scratch memory
  mutable std::vector<std::unique_ptr<Scratch>> idle_;
};

}  // namespace poesy::python
