#pragma once

#include <span>

#include "engine/model/model.h"
#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// How each error [F] moves the platform to first order at a reachable pose, and what correcting the drives leaves of
/// it. A unit of an error of limb i, where no joint gives way, moves the limb's own platform by the twist xi, and the
/// mechanism's, once the passive joints have given way (J^T W delta_mu = 0, see FirstOrder), by B_i xi, the mean of its
/// limbs' motions. Of xi the limb's own joints can take away, with the columns V_i of its passive joints and A_i of its
/// drives, all but a rest n:
///
///     xi = V_i u + A_i a + n, u and a so that |n|_i is as small as it can be
///     drive = |B_i A_i a|, constraint = |B_i n|, effect = |B_i xi|
///     residual = min over dq of |B_i xi + sum over all limbs of B_k A_k dq_k|
///
/// A_i and dq have a column and an entry for each drive, and a drive that moves joints of several limbs (Joint::drive)
/// has one entry of dq in all of them: what enters through it in one limb it may not take away.
///
/// Passive joints give way: B_i V_i = 0. |x| is the root mean square displacement of the model's platform->points under
/// the twist x. |n|_i is that of the limb's end: |n|_i^2 = |v + omega x c|^2 + rho^2 |omega|^2, with c the place of the
/// limb's last joint and rho the points' distance from their middle. It decides what counts as drive and what as
/// constraint; effect and residual do not depend on it. For a 3-PRS all four are those of three_prs::separation().
///
/// Where the mechanism is over-constrained, this is about the displacement of its platform and not about the gap:
/// corrections leave that as it is, unless there are more drives than freedoms. NaN where passive joints are in a
/// singular configuration; a drive that cannot move the platform, and one that others can stand for, correct nothing
/// more. Precondition: platform->points are at least three, on no line.
Separation separation(const DeformationModel& model, std::span<const double> pose);

/// From a displacement of the platform, [theta; displacement of its origin] in the base frame, to what corrections of
/// all drives leave of it: the projection along the drives' motions that leaves the least by the measure of
/// separation(), [6 x 6]. So residual is the measure of this times an error's effect. Empty where passive joints are in
/// a singular configuration. Precondition as for separation().
std::optional<lie::Matrix6<double>> left_by_drives(const DeformationModel& model, std::span<const double> pose);

/// A limb as separation sees it, where the perfect mechanism holds its end.
struct LimbMotions {
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;  ///< twists, one a column

  lie::Vector3<double> end = lie::Vector3<double>::Zero();  ///< where its last joint is (m)
  Columns passive;                                          ///< twists of its end by the passive joints
  Columns driven;                        ///< and by the drives, each with all joints that it moves in this limb
  std::vector<std::size_t> drives = {};  ///< of these columns: Joint::drive
  lie::Matrix6<double> platform;         ///< B: by how much a twist of its end moves the platform

  /// Adds a joint with this twist. at: its point.
  void add(const Joint& joint, const lie::Screw<double>& twist, const lie::Vector3<double>& at);
};

/// What a unit of an error does to its limb's end, where no joint gives way.
struct EndTwist {
  std::size_t limb;          ///< position
  lie::Screw<double> twist;  ///< of the end
};

/// separation() of limbs that are known so. root: twists of the platform times it have the root mean square
/// displacement of its points as their norm; radius: rho.
Separation separation_of(const std::vector<LimbMotions>& limbs, const lie::Matrix6<double>& root, double radius,
                         std::span<const EndTwist> errors);

/// Without classes of the literature; none where the model has no platform->points.
std::optional<SeparationDescription> separation_description(const DeformationModel& model);

}  // namespace poesy::chain
