#pragma once

#include <span>

#include "engine/model/model.h"
#include "models/chain/deformation_model.h"

namespace poesy::chain {

/// The first-order effect of each error on the platform at a reachable pose, and the part of this effect that remains
/// after the best correction by the drives. If no joint moves, a unit of an error of limb i moves the limb's own
/// platform by the twist xi. After the reaction of the passive joints (J^T W delta_mu = 0, see FirstOrder) the error
/// moves the platform of the mechanism by B_i xi, the mean of the motions of all limbs' platforms. Let V_i be the
/// columns of the limb's passive joints, and A_i those of its drives. Then xi splits into
///
///     xi = V_i u + A_i a + n, with u and a such that |n|_i is as small as possible
///     drive = |B_i A_i a|, constraint = |B_i n|, effect = |B_i xi|
///     residual = min over dq of |B_i xi + sum over all limbs of B_k A_k dq_k|
///
/// dq has an entry for each drive, and A_i has a column for each drive. A drive that moves joints of several limbs
/// (Joint::drive) has one entry of dq for all of them, so this drive may be unable to correct an error of one limb.
///
/// Passive joints compensate their own motions: B_i V_i = 0. |x| is the root mean square displacement of the model's
/// platform->points by the twist x. |n|_i is the norm for the limb's end: |n|_i^2 = |v + omega x c|^2 + rho^2 |omega|^2
/// for n = [omega; v], with c the position of the limb's last joint and rho the points' root mean square distance from
/// their centroid. |n|_i defines the drive and the constraint part; effect and residual do not depend on it. For a
/// 3-PRS all four numbers are those of three_prs::separation().
///
/// In an over-constrained mechanism these numbers describe the displacement of the platform, not the mismatch of the
/// limbs, which corrections change only if there are more drives than freedoms. The numbers are NaN at a pose at which
/// passive joints are singular. A drive that cannot move the platform, or that depends on other drives, adds no
/// correction. Precondition: platform->points are at least three, not all on a line.
Separation separation(const DeformationModel& model, std::span<const double> pose);

/// The projection [6 x 6] of a displacement of the platform onto the part that remains after the best correction by all
/// drives. The displacement is [theta; displacement of the platform's origin] (rad, m) in the base frame. The
/// correction makes the norm of the remainder (the norm of separation()) as small as possible. If the displacement is
/// the effect of an error, the norm of the remainder is the residual of separation(). Returns no value at a pose at
/// which passive joints are singular. Precondition as for separation().
std::optional<lie::Matrix6<double>> left_by_drives(const DeformationModel& model, std::span<const double> pose);

/// The motions of a limb that separation_of() needs, at a pose of the perfect mechanism, in the base frame.
struct LimbMotions {
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;  ///< twists [omega; v], one in each column

  lie::Vector3<double> end = lie::Vector3<double>::Zero();  ///< position of the limb's last joint (m)
  Columns passive;                                          ///< twists of the limb's end by its passive joints
  Columns driven;                        ///< twists of the limb's end by its drives, one column for each drive
  std::vector<std::size_t> drives = {};  ///< Joint::drive of each column of `driven`
  lie::Matrix6<double> platform;         ///< the matrix B, from a twist of the limb's end to a twist of the platform

  /// Adds the twist [omega; v] of a joint. at: point of the joint (m).
  void add(const Joint& joint, const lie::Screw<double>& twist, const lie::Vector3<double>& at);
};

/// The twist of a limb's end per unit of an error, if no joint moves. An error may twist the ends of several limbs.
struct EndTwist {
  std::size_t limb;          ///< index of the limb
  lie::Screw<double> twist;  ///< twist [omega; v] of the limb's end, in the base frame
};

/// Adds the twist of a limb's end to the list `twists` of one error. If the list has a twist of this limb, the two are
/// summed.
void add_twist(std::size_t limb, const lie::Screw<double>& twist, std::vector<EndTwist>& twists);

/// separation() computed from the motions of the limbs. root: U, for which |U xi| is the root mean square displacement
/// of the platform's points by the twist xi. radius: rho of separation() (m). errors: for each error, the twists of
/// limb ends that it causes.
Separation separation_of(const std::vector<LimbMotions>& limbs, const lie::Matrix6<double>& root, double radius,
                         std::span<const std::vector<EndTwist>> errors);

/// The description of separation(), without classes of the literature; no value if the model has no platform->points.
std::optional<SeparationDescription> separation_description(const DeformationModel& model);

}  // namespace poesy::chain
