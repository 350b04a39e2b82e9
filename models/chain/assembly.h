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

/// A bound on the first-order change of ln det(J^T W J) that the errors of a machine cause. If the change is below this
/// negative number, the loops of the machine may open. The loops open at a change of about -1. J: Jacobian of the
/// passive joints; W: metric; see Assembly::nearing().
inline constexpr double kNearing = -0.5;

/// Decides whether the loops of a machine with errors can be closed at all. If limbs over-constrain the platform, the
/// published equation J^T delta_mu = 0 (J: columns of the passive joints) has a solution even for a machine that nobody
/// can assemble: the displacements with the least mismatch. Here a metric W weighs the mismatch, and the joints descend
/// to the least sum of |delta_mu|_W^2.
///
/// Passive joints of the perfect mechanism can remove only a part of the mismatch; the remainder may deform the limbs.
/// Of the mismatch delta_mu at which the joints come to rest, the removable part is
///     r = J0 (J0^T W J0)^-1 J0^T W delta_mu,   J0: J at nominal displacements without errors.
/// In a machine that can be assembled, r is small: of the order of the mismatch times the errors. In a machine that
/// cannot be assembled, r does not vanish: the joints rest although the loops are open. There is a motion x of the
/// joints that changes the mismatch at nominal displacements (J0 x), but hardly at the displacements at which the
/// joints rest (J x). So N x nearly vanishes, where N = J^T W J. Newton's matrix is the negative derivative of J^T W
/// delta_mu, M = N + C(delta_mu), where C(y) is the term that a mismatch y adds to N (C - R in
/// block_kernel_equations.h). A machine cannot be assembled if, with the removable part r as the mismatch y,
///     N - 2 C(r)
/// is not positive definite. This criterion does not depend on units or on the size of the machine. At its boundary the
/// loops just close (theory.md, "Machines that cannot be assembled").
///
/// Uses plain double arithmetic, one sample at a time. The class is meant for two sorts of samples: those that a solver
/// did not solve, and those with errors for which the loops may open (nearing()). An object has scratch memory, so each
/// thread needs its own object.
class Assembly {
 public:
  /// The chain must outlive this object.
  explicit Assembly(const ParallelChain& chain);
  ~Assembly();
  Assembly(const Assembly&) = delete;
  Assembly& operator=(const Assembly&) = delete;

  /// Sets the nominal displacements [all joints] (rad, m) and the metric (null: W = 1). Use the metric of the points at
  /// which the limbs are joined to the platform, even if the solver uses another metric, because with the metric of
  /// points the decision depends on no unit.
  void prepare(std::span<const double> displacements, const Metric* metric);

  /// The first-order change of ln det(J^T W J) per unit of a component of a frame's error (1/rad, 1/m). If the sum of
  /// the changes by all errors of a machine is below kNearing, the machine may be impossible to assemble. Close to a
  /// singular pose, the loops open at a sum of -1. The result is 0 if the perfect mechanism is singular.
  double nearing(const FrameEntry& entry);

  /// Returns true if limbs with these fixed frames [chain.frames()] cannot be assembled. A descent from
  /// nominal displacements minimises the mismatch of the limbs over the passive joints. Returns false if it does not
  /// converge, or if the perfect mechanism is singular.
  bool is_impossible(std::span<const lie::Transform<double>> frames);

 private:
  class Descent;

  bool is_regular();
  bool is_open(std::span<const lie::Transform<double>> frames, std::span<const double> displacements);
  Eigen::MatrixXd bend(std::span<const double> delta_mu);

  const ParallelChain* chain_;
  std::vector<double> nominal_;  ///< [all joints] nominal displacements
  lie::Matrix6<double> W_ = lie::Matrix6<double>::Zero();
  double reach_ = 1.0;        ///< reach of the metric (m); 1 without a metric, so that 1 m weighs as much as 1 rad
  bool is_asked_ = false;     ///< true if is_regular() has been called for the present data of prepare()
  bool is_singular_ = false;  ///< true if the perfect mechanism is singular; valid if is_asked_
  FirstOrder first_order_;
  NormalEquations equations_;
  Loops loops_;
  std::vector<std::size_t> passive_;        ///< index of each passive joint among all joints
  std::vector<double> delta_mu_;            ///< [6 x pairs] mismatch at the displacements at which the joints rest
  std::vector<double> part_;                ///< [6 x pairs] removable part r of the mismatch
  std::vector<lie::Screw<double>> pull_;    ///< [limbs] scratch of bend(): sums of W delta_mu over the pairs of a limb
  std::vector<lie::Screw<double>> slopes_;  ///< [frames] gradient of ln det(J^T W J) by the errors of each frame
                                            ///< (FirstOrder::determinant_slopes()), if the perfect mechanism is regular
  std::unique_ptr<Descent> descent_;
};

}  // namespace poesy::chain
