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

/// If Gauss-Newton by a metric takes more iterations than this, it contracts so slowly that its result is doubted.
inline constexpr std::uint32_t kSlowIterations = 16;

/// Half of the change that opens a machine's loops; see Assembly::nearing().
inline constexpr double kNearing = -0.5;

/// Decides whether the loops of a machine with errors can be closed at all. Where limbs over-constrain the platform,
/// the equation J^T W delta_mu = 0 has a solution even for a machine that nobody can assemble: its passive joints rest
/// where the mismatch is least.
///
/// The limbs may keep a mismatch that no passive joint of the perfect mechanism can remove. The other part of the
/// mismatch delta_mu at rest is
///     r = J0 (J0^T W J0)^-1 J0^T W delta_mu,   J0 at nominal displacements without errors.
/// In a machine that can be assembled, r is of the order of the mismatch times the errors. In one that cannot, J has
/// lost a direction x that J0 has: the loops, closed as far as possible, bend away from each other, so that N x nearly
/// vanishes while r does not. Newton's matrix is M = N + C (BlockKernel) with N = J^T W J; C(r) is its second part for
/// a residual r. A machine cannot be assembled where
///     N - 2 C(r)
/// is not positive definite. This criterion depends on no unit and no size, and the boundary is where the loops just
/// close (theory.md, "Machines that cannot be assembled").
///
/// Plain double arithmetic, for samples that a solver did not solve or doubts. No other code makes this decision. Owns
/// the scratch of one thread.
class Assembly {
 public:
  /// The chain must outlive it.
  explicit Assembly(const ParallelChain& chain);
  ~Assembly();
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  /// Sets the nominal displacements [all joints] (rad, m) and the metric (null: W = 1). The metric should be that of
  /// the points where the limbs hold the platform, also when the solver uses another one, because it depends on no
  /// unit.
  void prepare(std::span<const double> displacements, const Metric* metric);

  /// The change of ln det(J^T W J) per unit of an entry of a frame's error, to first order (1/rad, 1/m). A machine
  /// whose errors add up to less than kNearing may be one that cannot be assembled: with a single weak direction its
  /// loops open at -1. 0 where the perfect mechanism is singular.
  double nearing(const FrameEntry& entry);

  /// Whether limbs with these fixed frames [chain.frames()] cannot be assembled. The passive joints descend from
  /// nominal displacements until they rest. False where they do not come to rest, and where the perfect mechanism is
  /// singular.
  bool is_impossible(std::span<const lie::Transform<double>> frames);

 private:
  class Descent;

  bool is_regular();
  bool is_open(std::span<const lie::Transform<double>> frames, std::span<const double> displacements);
  Eigen::MatrixXd bend(std::span<const double> delta_mu);

  const ParallelChain* chain_;
  std::vector<double> nominal_;  ///< [all joints]
  lie::Matrix6<double> W_ = lie::Matrix6<double>::Zero();
  double reach_ = 1.0;        ///< reach of the metric (m); without a metric 1, for lengths in m next to angles
  bool is_asked_ = false;     ///< whether is_regular() has been called since prepare()
  bool is_singular_ = false;  ///< whether the perfect mechanism is singular; valid if is_asked_
  FirstOrder first_order_;
  NormalEquations equations_;
  Loops loops_;
  std::vector<std::size_t> passive_;        ///< position of each passive joint among all joints
  std::vector<double> delta_mu_;            ///< [6 x pairs] where the joints rest
  std::vector<double> part_;                ///< [6 x pairs] r, see above
  std::vector<lie::Screw<double>> pull_;    ///< [limbs] scratch
  std::vector<lie::Screw<double>> slopes_;  ///< [frames] slopes of ln det(J^T W J), if the perfect mechanism is regular
  std::unique_ptr<Descent> descent_;
};

}  // namespace poesy::chain
