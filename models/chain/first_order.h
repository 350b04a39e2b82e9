#pragma once

#include <span>
#include <vector>

#include "models/chain/limb.h"
#include "models/chain/normal_equations.h"

namespace poesy::chain {

/// The closed-form effects of small errors: delta_mu = (1 - J (J^T W J)^-1 J^T W) G eps, where G eps is the mismatch by
/// errors if no joint moves, and (J^T W J)^-1 J^T W G eps is the reaction of the passive joints to it. All matrices are
/// taken at nominal displacements.
class FirstOrder {
 public:
  /// Allocates scratch for the chain, which must outlive it.
  explicit FirstOrder(const ParallelChain& chain);

  /// Sets the nominal displacements [all joints] (rad, m) and the weight W (null: W = 1). Returns false if the passive
  /// joints' Jacobian is singular; then the first order does not exist.
  bool prepare(std::span<const double> displacements, const lie::Matrix6<double>* W);

  /// The effect per unit of one entry of a frame's error (SI per rad or m): delta_mu [6 x pairs] and the displacements
  /// of the passive joints [passive joints]. Precondition: prepare() returned true.
  void effect(const FrameEntry& entry, std::span<double> delta_mu, std::span<double> displacements);

  /// The twist of the limb's platform per unit of an entry of a frame's error if no joint moves, the column of J of a
  /// passive joint, and the limb of either; [omega; v] at the base's origin. Precondition: as above.
  /// @{
  lie::Screw<double> motion(const FrameEntry& entry) const {
    return from_error_[entry.frame].col(static_cast<Eigen::Index>(entry.component));
  }
  std::size_t limb_of_frame(std::size_t frame) const { return limb_of_frame_[frame]; }
  const lie::Screw<double>& column(std::size_t joint) const { return columns_[joint]; }
  std::size_t limb_of_joint(std::size_t joint) const { return limb_of_joint_[joint]; }
  /// @}

  /// The sum of the motions of all limbs' platforms by a unit of that entry and these displacements [passive joints] of
  /// effect(). Precondition: as above.
  lie::Screw<double> sum_of_motions(const FrameEntry& entry, std::span<const double> displacements) const;

  /// The part of a mismatch delta_mu [6 x pairs] that passive joints could remove: J (J^T W J)^-1 J^T W delta_mu.
  /// Precondition: as above.
  void taken_away(std::span<const double> delta_mu, std::span<double> part);

  /// The gradient of ln det(J^T W J) with respect to errors, a screw for each frame [frames]: its product with motion()
  /// of an entry is the first-order change per unit of that entry, including the reaction of the passive joints.
  /// Precondition: as above.
  void determinant_slopes(std::span<lie::Screw<double>> slopes);

  /// See NormalEquations::idle().
  std::span<const double> idle() const { return equations_.idle(); }

  /// (J^T W J)^-1 [passive joints x passive joints] and the diagonal of J^T W J [passive joints]. Precondition: as
  /// above.
  void matrix(std::span<double> inverse, std::span<double> diagonal);

 private:
  void add_motion(std::size_t limb, const lie::Screw<double>& motion, std::span<double> delta_mu) const;
  void pull_of(std::span<const double> displacements);

  const ParallelChain* chain_;
  std::vector<std::size_t> limb_of_frame_;
  std::vector<std::size_t> limb_of_joint_;        ///< [passive joints]
  std::vector<lie::Matrix6<double>> from_error_;  ///< [frames] from the error to the motion of the limb's platform
  std::vector<lie::Screw<double>> columns_;       ///< [passive joints]
  std::vector<double> meetings_;                  ///< [passive joints] number of pairs that contain the joint's limb
  std::vector<double> no_mismatch_;               ///< [6 x pairs] zeros
  std::vector<double> unit_;                      ///< [passive joints] a unit vector
  std::vector<double> by_joint_;                  ///< [passive joints] scratch
  std::vector<double> mismatch_;                  ///< [6 x pairs] scratch
  std::vector<lie::Screw<double>> pull_;          ///< [limbs] scratch
  lie::Matrix6<double> W_;
  NormalEquations equations_;
};

}  // namespace poesy::chain
