#pragma once

#include <span>

#include "engine/model/model.h"
#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// The first-order effect of each error [F] on the platform at a reachable pose, and its residual after the best
/// correction of the drives. If no joint moves, a unit of an error of limb i moves the limb's own platform by the twist
/// xi. After the reaction of the passive joints (J^T W delta_mu = 0, see FirstOrder) it moves the platform of the
/// mechanism by B_i xi, the mean of its limbs' motions. With columns V_i of the limb's passive joints and A_i of its
/// drives, xi has the parts
///
///     xi = V_i u + A_i a + n, u and a such that |n|_i is as small as possible
///     drive = |B_i A_i a|, constraint = |B_i n|, effect = |B_i xi|
///     residual = min over dq of |B_i xi + sum over all limbs of B_k A_k dq_k|
///
/// A_i and dq have a column and an entry for each drive. A drive that moves joints of several limbs (Joint::drive) has
/// one entry of dq in all of them, so it may be unable to correct an error of one limb.
///
/// Passive joints compensate their own motions: B_i V_i = 0. |x| is the root mean square displacement of the model's
/// platform->points by the twist x. |n|_i is that of the limb's end: |n|_i^2 = |v + omega x c|^2 + rho^2 |omega|^2,
/// with c the position of the limb's last joint and rho the points' root mean square distance from their middle. |n|_i
/// defines the drive and the constraint part; effect and residual do not depend on it. For a 3-PRS all four are those
/// of three_prs::separation().
///
/// In an over-constrained mechanism these numbers describe the displacement of the platform and not the gap, which
/// corrections do not change unless there are more drives than freedoms. NaN where passive joints are in a singular
/// configuration. A drive that cannot move the platform, or that depends on other drives, adds no correction.
/// Precondition: platform->points are at least three, not all on a line.
Separation separation(const DeformationModel& model, std::span<const double> pose);

/// The matrix [6 x 6] from a displacement of the platform, [theta; displacement of its origin] (rad, m) in the base
/// frame, to its residual after the best correction of all drives: the projection along the drives' motions with the
/// least norm of separation(). The residual of separation() is the norm of this matrix times an error's effect. Empty
/// where passive joints are in a singular configuration. Precondition as for separation().
std::optional<lie::Matrix6<double>> left_by_drives(const DeformationModel& model, std::span<const double> pose);

/// A limb for separation_of(), at the perfect mechanism's pose.
struct LimbMotions {
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;  ///< twists [omega; v], one a column

  lie::Vector3<double> end = lie::Vector3<double>::Zero();  ///< position of its last joint (m)
  Columns passive;                                          ///< twists of its end by its passive joints
  Columns driven;                        ///< twists of its end by drives, each with all its joints in this limb
  std::vector<std::size_t> drives = {};  ///< Joint::drive of these columns
  lie::Matrix6<double> platform;         ///< B: from a twist of the end to a twist of the platform

  /// Adds a joint with this twist [omega; v]. at: its point (m).
  void add(const Joint& joint, const lie::Screw<double>& twist, const lie::Vector3<double>& at);
};

/// The twist of a limb's end by a unit of an error if no joint moves. An error may twist the ends of several limbs.
struct EndTwist {
  std::size_t limb;          ///< position of the limb
  lie::Screw<double> twist;  ///< of the end
};

/// Adds a twist of a limb's end to those of an error.
void add_twist(std::size_t limb, const lie::Screw<double>& twist, std::vector<EndTwist>& twists);

/// separation() from the motions of the limbs. root: U, where |U xi| is the root mean square displacement of the
/// platform's points by the twist xi; radius: rho.
Separation separation_of(const std::vector<LimbMotions>& limbs, const lie::Matrix6<double>& root, double radius,
                         std::span<const std::vector<EndTwist>> errors);

/// The description of separation(), without classes of the literature; none if the model has no platform->points.
std::optional<SeparationDescription> separation_description(const DeformationModel& model);

}  // namespace poesy::chain
