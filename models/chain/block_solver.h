#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/chain/assembly.h"
#include "models/chain/block_kernels.h"
#include "models/chain/first_order.h"
#include "models/chain/limb.h"
#include "models/chain/metric.h"
#include "models/chain/platform_motion.h"
#include "models/chain/residual_space.h"

namespace poesy::chain {

/// Levels of accuracy, in the order of ModelDescription::fidelities.
enum class Fidelity : std::size_t {
  exact,       ///< the equations are solved
  first_order  ///< linear in the errors, in closed form; see FirstOrder
};

/// Solves blocks of samples with the fastest kernel that this machine supports. Owns the scratch of one thread.
/// BlockKernel states the methods and their guarantees. gauss_newton is Scheme I as in DeformationSolver; it starts
/// from nominal displacements as published, by a metric from those to which constant errors push the joints. Assembly
/// decides which of the samples that a kernel does not solve or doubts are not_assembled.
class BlockSolver {
 public:
  /// The chain must outlive the solver.
  BlockSolver(const ParallelChain& chain, const SolverOptions& options, Fidelity fidelity = Fidelity::exact);

  /// Sets what the samples of the next calls share: nominal displacements of all joints (rad, m), constant errors
  /// [frames], the entries that vary, the metric (null: the published weight), and the reported points of the platform
  /// (null: none). range: that of the one varied entry; starts of Newton are predicted if it is given, and by a metric
  /// always. held: the metric by which machines that cannot be assembled are found (null: that of the solves). All
  /// pointers must outlive the solves.
  void prepare(std::span<const double> displacements, std::span<const FrameError<double>> errors,
               std::span<const FrameEntry> varied, double range, const Metric* metric = nullptr,
               const PlatformPoints* platform = nullptr, const Metric* held = nullptr);

  /// Solves `count` samples. values: [varied x count], row-major, SI. To first order a singular pose makes every sample
  /// singular. By a metric residuals exist only if wanted.
  void solve(std::span<const double> values, std::size_t count, bool wants_residuals = true);

  /// Row n of the last block's residuals [6 x pairs], for each sample [count].
  std::span<const double> delta_mu(std::size_t row) const { return row_of(delta_mu_, row); }
  /// A row of the last block's responses [count]: angular, linear, max; by a metric gap, angular, linear.
  std::span<const double> response(std::size_t row) const { return row_of(responses_, row); }
  /// A row of the platform's motion in the last block [count]; see platform_rows().
  std::span<const double> platform(std::size_t row) const { return row_of(platform_responses_, row); }
  /// The status of each sample of the last block.
  std::span<const SolveStatus> status() const { return std::span(status_).first(count_); }
  /// The iterations of each sample of the last block.
  std::span<const std::uint32_t> iterations() const { return std::span(iterations_).first(count_); }

 private:
  std::span<const double> row_of(const std::vector<double>& rows, std::size_t row) const {
    return std::span(rows).subspan(row * kernel_capacity(count_), count_);
  }
  void add_piece(const lie::Transform<double>& motion);
  void add_frame(const Limb& limb, std::size_t j, std::size_t frame, const FrameError<double>& error,
                 std::span<const FrameEntry> varied);
  void close_segment();
  void find_segments(std::span<const double> displacements, std::span<const FrameError<double>> errors,
                     std::span<const FrameEntry> varied);
  void find_spread(const lie::Matrix6<double>& W);
  void find_nominal();
  void find_slopes(std::span<const FrameError<double>> errors, std::span<const FrameEntry> varied);
  void find_map(std::span<const double> displacements, std::span<const FrameError<double>> errors,
                std::span<const FrameEntry> varied);
  void predict_starts(double center, double half_width, int splits_left);
  double fit_starts(double center, double half_width);
  void run(std::span<const double> values, std::size_t count, const KernelOptions& options, double* displacements);
  void find_nearing(std::span<const FrameError<double>> errors, std::span<const FrameEntry> varied);
  void add_up_nearing(std::span<const double> values);
  void review(std::span<const double> values);
  void set_frames(std::span<const double> values, std::size_t sample);
  void map(std::span<const double> values, std::size_t count, bool wants_residuals);
  void add_platform_motion(const FrameEntry& entry, double error, std::span<double> xi);
  void find_platform_map(std::span<const FrameError<double>> errors, std::span<const FrameEntry> varied);
  void move_platform(const KernelChain& chain, const KernelSamples& samples, const KernelMap* map, double* scratch);
  double* make_room(const KernelChain& chain, const KernelSamples& samples);
  KernelOutcome outcome(double* displacements);
  KernelChain kernel_chain() const;

  const ParallelChain* chain_;
  Fidelity fidelity_;
  KernelOptions options_;
  Kernels kernels_;
  FirstOrder first_order_;
  ResidualSpace residual_space_;
  Assembly assembly_;
  std::vector<FrameError<double>> errors_;      ///< [frames] constant errors, later those of one sample
  std::vector<FrameEntry> entries_;             ///< entries that vary
  std::vector<lie::Transform<double>> frames_;  ///< [frames] of one sample
  std::vector<double> nearing_;                 ///< [varied] see Assembly::nearing(); empty with a metric
  double nearing_constant_ = 0.0;               ///< sum over the constant errors
  std::vector<double> nearing_of_;              ///< [count] of each sample; empty with a metric
  const Metric* metric_ = nullptr;
  std::array<double, 3> middle_{};  ///< of the metric's points; see KernelChain
  std::array<double, 6> spread_{};  ///< see KernelChain
  bool is_singular_ = false;        ///< whether the first order does not exist
  std::vector<double> slopes_;      ///< [varied x joints]
  std::vector<double> inverse_;     ///< [joints x joints] of J^T W J at nominal displacements
  std::vector<double> diagonal_;    ///< [joints], of J^T W J itself
  std::vector<double> effect_;      ///< [6 pairs], of one error
  std::vector<double> slope_;       ///< [joints], of one error
  const PlatformPoints* platform_ = nullptr;
  std::vector<double> platform_effects_;        ///< [varied x 6] to first order
  std::vector<double> platform_constant_;       ///< [6]
  std::vector<double> platform_displacements_;  ///< [joints x stride]
  std::vector<double> platform_responses_;      ///< [platform rows x stride]
  // First order, in coordinates of the residual space; see KernelMap.
  std::vector<double> map_effects_;   ///< [varied x rows]
  std::vector<double> map_constant_;  ///< [rows], of constant errors
  std::vector<double> map_delta_mu_;  ///< [6 pairs x rows]
  std::vector<double> map_norms_;     ///< [3 x rows x rows]
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
  std::vector<double> coefficients_;  ///< of all possible fits, one after the other
  std::vector<double> node_displacements_;
  std::vector<double> scratch_;
  std::vector<double> delta_mu_;
  std::vector<double> responses_;
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
  std::size_t count_ = 0;
};

}  // namespace poesy::chain
