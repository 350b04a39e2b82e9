#pragma once

#include <span>
#include <vector>

#include "models/chain/limb.h"
#include "models/chain/normal_equations.h"

namespace poesy::chain {

/// What small errors do, in closed form: delta_mu = (1 - J (J^T W J)^-1 J^T W) G eps, with G eps the mismatch that
/// errors make where no joint gives way, and (J^T W J)^-1 J^T W G eps by how much the passive joints give way. All at
/// nominal displacements.
class FirstOrder {
 public:
  /// Scratch for the chain, which must outlive it.
  explicit FirstOrder(const ParallelChain& chain);

  /// At these nominal displacements [all joints] (rad, m); W: null for W = 1. Returns false where the passive joints'
  /// motion is singular: then the first order does not exist.
  bool prepare(std::span<const double> displacements, const lie::Matrix6<double>* W);

  /// Of a unit of one entry of a frame's error: delta_mu [6 x pairs] and what the passive joints [passive joints] give
  /// way, SI per rad or m. Precondition: prepare() returned true.
  void effect(const FrameEntry& entry, std::span<double> delta_mu, std::span<double> displacements);

  /// What a unit of a frame's error does to its limb's platform where no joint gives way, and a passive joint's column
  /// of J; with the limbs of both. Precondition: as above.
  /// @{
  lie::Screw<double> motion(const FrameEntry& entry) const {
    return from_error_[entry.frame].col(static_cast<Eigen::Index>(entry.component));
  }
  std::size_t limb_of_frame(std::size_t frame) const { return limb_of_frame_[frame]; }
  const lie::Screw<double>& column(std::size_t joint) const { return columns_[joint]; }
  std::size_t limb_of_joint(std::size_t joint) const { return limb_of_joint_[joint]; }
  /// @}

  /// The sum of the motions of all limbs' platforms, of a unit of that entry and of these displacements
  /// [passive joints], as effect() gives them. Precondition: as above.
  lie::Screw<double> sum_of_motions(const FrameEntry& entry, std::span<const double> displacements) const;

  /// The part of a mismatch delta_mu [6 x pairs] that passive joints could take away:
  /// J (J^T W J)^-1 J^T W delta_mu. Precondition: as above.
  void taken_away(std::span<const double> delta_mu, std::span<double> part);

  /// Of each frame, [frames], the screw whose product with motion() of an entry is by how much a unit of that entry
  /// changes ln det(J^T W J) to first order, while the passive joints give way. Precondition: as above.
  void determinant_slopes(std::span<lie::Screw<double>> slopes);

  /// See NormalEquations::idle().
  std::span<const double> idle() const { return equations_.idle(); }

  /// (J^T W J)^-1 and the diagonal of J^T W J: [passive joints x passive joints] and [passive joints]. Precondition:
  /// prepare() returned true.
  void matrix(std::span<double> inverse, std::span<double> diagonal);

 private:
  void add_motion(std::size_t limb, const lie::Screw<double>& motion, std::span<double> delta_mu) const;
  void pull_of(std::span<const double> displacements);

  const ParallelChain* chain_;
  std::vector<std::size_t> limb_of_frame_;
  std::vector<std::size_t> limb_of_joint_;        ///< of each passive joint
  std::vector<lie::Matrix6<double>> from_error_;  ///< per frame: [omega; v] to the motion of the limb's platform
  std::vector<lie::Screw<double>> columns_;       ///< of each passive joint
  std::vector<double> meetings_;                  ///< of each passive joint: pairs in which its limb takes part
  std::vector<double> no_mismatch_;               ///< [6 x pairs] zeros
  std::vector<double> unit_;                      ///< [passive joints] a column of 1
  std::vector<double> mismatch_;                  ///< [6 x pairs] scratch
  std::vector<lie::Screw<double>> pull_;          ///< [limbs] scratch
  lie::Matrix6<double> W_;
  NormalEquations equations_;
};

}  // namespace poesy::chain
