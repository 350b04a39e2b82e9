#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "models/chain/first_order.h"
#include "models/chain/limb.h"
#include "models/chain/loops.h"
#include "models/chain/metric.h"
#include "models/chain/normal_equations.h"

namespace poesy::chain {

/// Gauss-Newton by a metric that takes more iterations contracts too slowly for its end not to be doubted.
inline constexpr std::uint32_t kSlowIterations = 16;

/// Half of what it takes to open a machine's loops, see Assembly::nearing().
inline constexpr double kNearing = -0.5;

/// Whether the loops of a machine with errors can be closed at all. Where limbs are over-constrained the equation
/// J^T W delta_mu = 0 has a solution also for a machine that nobody can put together: the passive joints come to rest
/// where the mismatch is least.
///
/// What limbs may disagree by is what no passive joint of the perfect mechanism takes away. Of the mismatch where the
/// joints rest that is all but
///     r = J0 (J0^T W J0)^-1 J0^T W delta_mu,   J0 at nominal displacements without errors.
/// In a machine that can be assembled r is of the order of the mismatch times the errors. In one that cannot, J has
/// lost a direction x that J0 has: the loops, closed as far as they go, bend away from each other, so that N x nearly
/// vanishes while r does not. With C(r) what a residual r adds to N = J^T W J in Newton's matrix M = N + C
/// (BlockKernel), a machine cannot be assembled where
///     N - 2 C(r)
/// is not positive definite. No unit and no size enters, and the border is where the loops just close (theory.md,
/// "Machines that cannot be assembled").
///
/// Plain double arithmetic, for samples that a solver did not solve or doubts: the one place that decides. Owns the
/// scratch of one thread.
class Assembly {
 public:
  /// The chain must outlive it.
  explicit Assembly(const ParallelChain& chain);
  ~Assembly();
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  /// At these nominal displacements [all joints] (rad, m), by this metric (null: W = 1), best that of the points where
  /// the limbs hold the platform, however the solver weighs: whether parts fit together depends on no unit.
  void prepare(std::span<const double> displacements, const Metric* metric);

  /// By how much a unit of an entry of a frame's error changes ln det(J^T W J) to first order. Machines of which the
  /// errors sum up to less than kNearing may be ones that cannot be assembled: the loops of one with a single weak
  /// direction bend away from each other from -1 on. 0 where the perfect mechanism is singular.
  double nearing(const FrameEntry& entry);

  /// Whether the limbs of these fixed frames [chain.frames()] cannot be assembled, by where the passive joints come to
  /// rest if they go downhill from nominal displacements. False where they do not come to rest, and where the perfect
  /// mechanism is singular.
  bool is_impossible(std::span<const lie::Transform<double>> frames);

 private:
  class Descent;

  bool is_regular();
  bool is_open(std::span<const lie::Transform<double>> frames, std::span<const double> displacements);
  Eigen::MatrixXd bend(std::span<const double> delta_mu);

  const ParallelChain* chain_;
  std::vector<double> nominal_;  ///< [all joints]
  lie::Matrix6<double> W_ = lie::Matrix6<double>::Zero();
  double reach_ = 1.0;        ///< of the metric (m); without one 1, for lengths in m beside angles
  bool is_asked_ = false;     ///< since it was prepared
  bool is_singular_ = false;  ///< the perfect mechanism, if asked
  FirstOrder first_order_;
  NormalEquations equations_;
  Loops loops_;
  std::vector<std::size_t> passive_;      ///< position of each passive joint among all joints
  std::vector<double> delta_mu_;          ///< [6 x pairs] where the joints rest
  std::vector<double> part_;              ///< [6 x pairs] r
  std::vector<lie::Screw<double>> pull_;  ///< [limbs] scratch
  std::vector<lie::Screw<double>> slopes_;  ///< [frames] of ln det(J^T W J), if the perfect mechanism is regular
  std::unique_ptr<Descent> descent_;
};

}  // namespace poesy::chain
