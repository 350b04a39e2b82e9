#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/chain/block_problem.h"
#include "models/chain/limb.h"

namespace poesy::chain {

/// An entry of a fixed frame's error that varies from sample to sample.
struct VariedEntry {
  std::size_t frame;      ///< among all frames, limb by limb
  std::size_t component;  ///< of [omega; v]
};

/// Solves blocks of samples with the fastest kernel this machine has. Owns the scratch of one thread.
/// The methods and their guarantees are those of BlockKernel; gauss_newton is Scheme I as DeformationSolver states it.
class BlockSolver {
 public:
  /// The chain must outlive the solver.
  BlockSolver(const ParallelChain& chain, const SolverOptions& options);

  /// Fixes what the samples of the next calls have in common: nominal displacements of all joints (rad, m), constant
  /// errors [frames], and the entries that vary. With one varied entry and a range, Newton's starts are predicted.
  void prepare(std::span<const double> displacements, std::span<const FrameError<double>> errors,
               std::span<const VariedEntry> varied, double range);

  /// values: [varied x count], row-major.
  void solve(std::span<const double> values, std::size_t count);

  /// Row n of the last solve's residuals, [6 x pairs], or of its responses (angular, linear, max); each [count].
  std::span<const double> delta_mu(std::size_t row) const { return row_of(delta_mu_, row); }
  /// A row of the last block's responses: angular, linear, max.
  std::span<const double> response(std::size_t row) const { return row_of(responses_, row); }
  /// Of the last block, for each sample.
  std::span<const SolveStatus> status() const { return std::span(status_).first(count_); }
  /// Of the last block, for each sample.
  std::span<const std::uint32_t> iterations() const { return std::span(iterations_).first(count_); }

 private:
  std::span<const double> row_of(const std::vector<double>& rows, std::size_t row) const {
    return std::span(rows).subspan(row * kernel_capacity(count_), count_);
  }
  void add_piece(const lie::Transform<double>& motion);
  void add_frame(const Limb& limb, std::size_t j, std::size_t frame, const FrameError<double>& error,
                 std::span<const VariedEntry> varied);
  void close_segment();
  void predict_starts(double center, double half_width, int splits_left);
  double fit_starts(double center, double half_width);
  void run(std::span<const double> values, std::size_t count, const KernelOptions& options, double* displacements);
  KernelChain kernel_chain() const;

  const ParallelChain* chain_;
  KernelOptions options_;
  KernelSolve kernel_;
  std::vector<KernelLimb> limbs_;
  std::vector<KernelPair> pairs_;
  std::vector<KernelJoint> joints_;
  std::vector<KernelSegment> segments_;
  std::vector<KernelPiece> pieces_;
  std::size_t first_piece_ = 0;
  std::size_t varied_ = 0;
  std::vector<double> cosines_;  ///< Chebyshev polynomial n at node k
  std::vector<KernelFit> fits_;
  std::size_t fits_made_ = 0;
  std::vector<double> coefficients_;  ///< of all fits that may be, one behind the other
  std::vector<double> node_displacements_;
  std::vector<double> scratch_;
  std::vector<double> delta_mu_;
  std::vector<double> responses_;
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
  std::size_t count_ = 0;
};

}  // namespace poesy::chain
