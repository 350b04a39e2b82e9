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

/// Levels of accuracy of a solve, in the order of ModelDescription::fidelities.
enum class Fidelity : std::size_t {
  exact,       ///< the equations are solved
  first_order  ///< linear in the errors, in closed form; see FirstOrder
};

/// Solves blocks of samples with the fastest kernel that this computer supports. BlockKernel states the methods and
/// their guarantees; the method gauss_newton is Scheme I as in DeformationSolver. With Fidelity::exact, Assembly
/// examines the samples that the kernel does not solve and those with errors for which loops may open. Their status
/// becomes not_assembled if they cannot be assembled. An object has scratch memory, so each thread needs its own
/// object.
class BlockSolver {
 public:
  /// The chain must outlive the solver.
  BlockSolver(const ParallelChain& chain, const SolverOptions& options, Fidelity fidelity = Fidelity::exact);

  /// Sets the data that the samples of the next calls share. displacements: nominal displacements of all joints (rad,
  /// m). errors: [frames] constant errors. varied: the components of frames' errors that vary. range: if only one
  /// component varies, starting points of Newton's method are predicted for values from -range to range. platform:
  /// reported points of the platform (null: none). held: the metric by which machines that cannot be assembled are
  /// found (null: 1 rad weighs as much as 1 m, as published). All pointers must outlive the solves.
  void prepare(std::span<const double> displacements, std::span<const FrameError<double>> errors,
               std::span<const FrameEntry> varied, double range, const PlatformPoints* platform = nullptr,
               const Metric* held = nullptr);

  /// Solves `count` samples. values: [varied x count], row-major, SI. With Fidelity::first_order, every sample is
  /// singular at a singular pose.
  void solve(std::span<const double> values, std::size_t count);

  /// [count] A component of the residuals (rad, m) of the last block. row: 6 n + k for component k of the n-th pair of
  /// limbs.
  std::span<const double> delta_mu(std::size_t row) const { return row_of(delta_mu_, row); }
  /// [count] A response of the last block. row: 0 angular (rad), 1 linear (m), 2 largest deformation (norm over rad and
  /// m).
  std::span<const double> response(std::size_t row) const { return row_of(responses_, row); }
  /// [count] A displacement of the platform in the last block. row: index in the list of platform_rows().
  std::span<const double> platform(std::size_t row) const { return row_of(platform_responses_, row); }
  /// [count] The status of each sample of the last block.
  std::span<const SolveStatus> status() const { return std::span(status_).first(count_); }
  /// [count] The iterations of each sample of the last block.
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
  void find_map(std::span<const double> displacements, std::span<const FrameError<double>> errors,
                std::span<const FrameEntry> varied);
  void predict_starts(double center, double half_width, int splits_left);
  double fit_starts(double center, double half_width);
  void run(std::span<const double> values, std::size_t count, const KernelOptions& options, double* displacements);
  void find_nearing(std::span<const FrameError<double>> errors, std::span<const FrameEntry> varied);
  void add_up_nearing(std::span<const double> values);
  void review(std::span<const double> values);
  void set_frames(std::span<const double> values, std::size_t sample);
  void map(std::span<const double> values, std::size_t count);
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
  /// [frames] Errors of the frames: the constant components as set by prepare(), the varied ones as last set by
  /// set_frames().
  std::vector<FrameError<double>> errors_;
  std::vector<FrameEntry> entries_;             ///< components of frames' errors that vary
  std::vector<lie::Transform<double>> frames_;  ///< [frames] fixed frames of one sample, with its errors
  std::vector<double> nearing_;                 ///< [varied] Assembly::nearing() of each varied component
  double nearing_constant_ = 0.0;               ///< sum of Assembly::nearing() x error over the constant errors
  std::vector<double> nearing_of_;  ///< [count] sum of Assembly::nearing() x error over all errors of each sample
  bool is_singular_ = false;        ///< true if no first-order map exists, because passive joints are singular
  std::vector<double> effect_;      ///< [6 x pairs] delta_mu per unit of one error
  std::vector<double> slope_;       ///< [joints] displacements of the passive joints per unit of one error
  const PlatformPoints* platform_ = nullptr;
  /// [varied x 6] First-order motion of the platform per unit of each varied component.
  std::vector<double> platform_effects_;
  std::vector<double> platform_constant_;       ///< [6] first-order motion of the platform by the constant errors
  std::vector<double> platform_displacements_;  ///< [joints x stride] solved displacements of the passive joints
  std::vector<double> platform_responses_;      ///< [platform rows x stride] platform motion of each sample
  // First-order effects, as the coordinates y of KernelMap.
  std::vector<double> map_effects_;   ///< [varied x rows] change of y per unit of each varied error
  std::vector<double> map_constant_;  ///< [rows] y of all constant errors
  std::vector<double> map_delta_mu_;  ///< [6 pairs x rows] delta_mu per unit of each coordinate of y
  std::vector<KernelLimb> limbs_;
  std::vector<KernelPair> pairs_;
  std::vector<KernelJoint> joints_;
  std::vector<KernelSegment> segments_;
  std::vector<KernelPiece> pieces_;
  std::size_t first_piece_ = 0;
  std::size_t varied_ = 0;
  std::vector<double> cosines_;  ///< [kStartTerms x kStartTerms] value of each Chebyshev polynomial at each node
  std::vector<KernelFit> fits_;
  std::size_t fits_made_ = 0;
  std::vector<double> coefficients_;  ///< coefficients of all possible fits, one fit after the other
  std::vector<double> node_displacements_;
  std::vector<double> scratch_;
  std::vector<double> delta_mu_;
  std::vector<double> responses_;
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
  std::size_t count_ = 0;
};

}  // namespace poesy::chain
