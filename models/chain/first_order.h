#pragma once

#include <span>
#include <vector>

#include "models/chain/limb.h"
#include "models/chain/normal_equations.h"

namespace poesy::chain {

/// The closed-form effects of small errors eps on the mismatch of pairs of limbs: delta_mu = (1 - J (J^T W J)^-1 J^T W)
/// G eps. G eps is the mismatch that errors cause if no joint moves. J is the Jacobian of the passive joints, W the
/// weight of the mismatch, and (J^T W J)^-1 J^T W G eps the reaction of the passive joints. All matrices are taken at
/// nominal displacements.
class FirstOrder {
 public:
  /// Allocates scratch memory for the chain, which must outlive this object.
  explicit FirstOrder(const ParallelChain& chain);

  /// Sets the nominal displacements [all joints] (rad, m) and the weight W (null: W = 1). Returns false if the Jacobian
  /// of the passive joints is singular; then first-order effects do not exist.
  bool prepare(std::span<const double> displacements, const lie::Matrix6<double>* W);

  /// Computes the effect per unit of one component of a frame's error (SI per rad or m): delta_mu [6 x pairs] and
  /// displacements of the passive joints [passive joints]. Precondition: prepare() returned true.
  void effect(const FrameEntry& entry, std::span<double> delta_mu, std::span<double> displacements);

  /// motion(): the twist of the limb's platform per unit of a component of a frame's error, if no joint moves.
  /// column(): the column of J of a passive joint. Both are [omega; v] at the base's origin. limb_of_...(): the limb of
  /// a frame or of a passive joint. Precondition: prepare() returned true.
  /// @{
  lie::Screw<double> motion(const FrameEntry& entry) const {
    return from_error_[entry.frame].col(static_cast<Eigen::Index>(entry.component));
  }
  std::size_t limb_of_frame(std::size_t frame) const { return limb_of_frame_[frame]; }
  const lie::Screw<double>& column(std::size_t joint) const { return columns_[joint]; }
  std::size_t limb_of_joint(std::size_t joint) const { return limb_of_joint_[joint]; }
  /// @}

  /// The sum over all limbs of the motions of their platforms. The motions are caused by a unit of the component
  /// `entry` and by the displacements [passive joints] that effect() found. Precondition: prepare() returned true.
  lie::Screw<double> sum_of_motions(const FrameEntry& entry, std::span<const double> displacements) const;

  /// Sets `part` to the part of a mismatch delta_mu [6 x pairs] that passive joints could remove: J (J^T W J)^-1 J^T W
  /// delta_mu. Precondition: prepare() returned true.
  void taken_away(std::span<const double> delta_mu, std::span<double> part);

  /// The gradient of ln det(J^T W J) with respect to errors: a screw for each frame [frames]. This determinant is small
  /// if the loops are close to opening. The product of this screw with motion() of a component is the first-order
  /// change per unit of that component, including the reaction of the passive joints. Precondition: prepare() returned
  /// true.
  void determinant_slopes(std::span<lie::Screw<double>> slopes);

  /// [idle x passive joints] The directions of idle freedoms; see NormalEquations::idle().
  std::span<const double> idle() const { return equations_.idle(); }

 private:
  void add_motion(std::size_t limb, const lie::Screw<double>& motion, std::span<double> delta_mu) const;
  void pull_of(std::span<const double> displacements);

  const ParallelChain* chain_;
  std::vector<std::size_t> limb_of_frame_;
  std::vector<std::size_t> limb_of_joint_;  ///< [passive joints] limb of each joint
  /// [frames] Matrix from a frame's error to the motion of the limb's platform, both [omega; v].
  std::vector<lie::Matrix6<double>> from_error_;
  std::vector<lie::Screw<double>> columns_;  ///< [passive joints] columns of the Jacobian J of the passive joints
  std::vector<double> no_mismatch_;          ///< [6 x pairs] zeros
  std::vector<double> unit_;                 ///< [passive joints] scratch: a unit displacement of one joint
  std::vector<double> by_joint_;             ///< [passive joints] scratch of determinant_slopes()
  std::vector<double> mismatch_;             ///< [6 x pairs] scratch of pull_of()
  std::vector<lie::Screw<double>> pull_;     ///< [limbs] result of pull_of()
  lie::Matrix6<double> W_;
  NormalEquations equations_;
};

}  // namespace poesy::chain
