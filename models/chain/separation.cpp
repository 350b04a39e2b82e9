#include "models/chain/separation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/linalg/decompositions.h"
#include "models/chain/first_order.h"
#include "models/chain/metric.h"

namespace poesy::chain {
namespace {

using Vector3 = lie::Vector3<double>;
using Screw = lie::Screw<double>;
using Matrix6 = lie::Matrix6<double>;
using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// A part of a vector that is smaller than this share of the whole is rounding.
constexpr double kRounding = 1e-12;

/// A column of length 1 counts as dependent on other columns if its projection onto their complement is shorter than
/// this.
constexpr double kDependent = 1e-9;

/// Appends a column and returns a reference to it.
auto next_column(Columns& columns) {
  columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
  return columns.rightCols<1>();
}

LimbMotions motions_of(const Limb& limb, std::span<const double> displacements) {
  LimbMotions found;
  lie::Transform<double> g = limb.home.front();
  for (std::size_t j = 0; j < limb.joints.size(); ++j) {
    found.add(limb.joints[j], spatial_column(limb.joints[j], g), g.p);
    move_joint(limb.joints[j], displacements[j], g);
    g = g * limb.home[j + 1];
  }
  return found;
}

/// The projection onto the orthogonal complement of these columns.
Matrix6 beyond(const Columns& columns) {
  if (columns.cols() == 0) return Matrix6::Identity();
  const Eigen::MatrixXd rest = linalg::orthogonal_complement(columns, kDependent);
  return rest * rest.transpose();
}

/// The projection of x. If the projection is only rounding, zero is returned; if the removed part is only rounding, x
/// is returned.
Screw left_of(const Screw& x, const Matrix6& projection) {
  const Screw left = projection * x;
  if (left.norm() <= kRounding * x.norm()) return Screw::Zero();
  return (x - left).norm() <= kRounding * x.norm() ? x : left;
}

/// The matrix B_i from a motion of the limb's end to the motion of the platform (see separation()).
Matrix6 platform_by_limb(const ParallelChain& chain, FirstOrder& first_order, std::size_t limb) {
  std::vector<double> delta_mu(6 * chain.pairs.size());
  std::vector<double> moved(chain.passive_joints());
  Matrix6 B;
  for (std::size_t c = 0; c < 6; ++c) {
    // The unit error is in the first frame, which is expressed in the base frame. With errors_at_joints it rotates
    // about the first joint.
    const FrameEntry unit{chain.first_frame(limb), c};
    first_order.effect(unit, delta_mu, moved);
    B.col(static_cast<Eigen::Index>(c)) =
        first_order.sum_of_motions(unit, moved) / static_cast<double>(chain.limbs.size());
  }
  const Limb& one = chain.limbs[limb];
  if (one.errors_at_joints) B *= lie::adjoint(one.before_error(0).inverse());
  return B;
}

/// The two parts of a displacement of the platform, scaled so that their norms are those of separation().
struct Parts {
  Screw drive;       ///< drive part: the displacement through the directions of the drives
  Screw constraint;  ///< constraint part: the remaining displacement, through constrained directions
};

/// Splits the effects of errors of one limb into their drive and constraint parts.
class LimbSeparation {
 public:
  /// root, radius: as for separation_of().
  LimbSeparation(const LimbMotions& joints, const Matrix6& root, double radius) {
    lengths_ << radius * lie::Matrix3<double>::Identity(), lie::Matrix3<double>::Zero(), -lie::hat<double>(joints.end),
        lie::Matrix3<double>::Identity();
    const Matrix6 to_displacement = root * joints.platform;
    from_lengths_ = to_displacement * linalg::inverse(lengths_);
    Columns passive = lengths_ * joints.passive;
    passive.colwise().normalize();
    beyond_passive_ = beyond(passive);
    Columns driven = lengths_ * joints.driven;
    driven_lengths_ = driven.colwise().norm();
    driven.colwise().normalize();
    driven = beyond_passive_ * driven;
    for (auto column : driven.colwise()) {
      if (column.norm() < kDependent) column.setZero();
    }
    beyond_drives_ = beyond(driven);
    motions_ = from_lengths_ * driven;
    drives_ = joints.drives;
  }

  /// The drive (Joint::drive) of each column of motions().
  const std::vector<std::size_t>& drives() const { return drives_; }
  /// The columns of B_i A_i (see separation()), scaled like Parts, each divided by the length |A_i|_i of the same
  /// column of A_i.
  const Columns& motions() const { return motions_; }
  /// The length |A_i|_i of a column of A_i (see separation()).
  double driven_length(Eigen::Index column) const { return driven_lengths_[column]; }

  /// The parts of an error that moves the limb's end by the twist xi.
  Parts parts(const Screw& xi) const {
    const Screw not_passive = left_of(lengths_ * xi, beyond_passive_);
    const Screw rest = left_of(not_passive, beyond_drives_);
    return {from_lengths_ * (not_passive - rest), from_lengths_ * rest};
  }

 private:
  Matrix6 lengths_;         ///< matrix for which |lengths xi| is the norm |xi|_i of separation()
  Matrix6 from_lengths_;    ///< matrix from these lengths to displacements of the platform, scaled like Parts
  Matrix6 beyond_passive_;  ///< projection that removes the part of the passive joints
  Matrix6 beyond_drives_;   ///< projection that also removes the part of the drives
  Columns motions_;
  Eigen::RowVectorXd driven_lengths_;
  std::vector<std::size_t> drives_;
};

/// The root U of the metric: |U xi| is the root mean square displacement of the platform's points by the twist xi.
Matrix6 root_of_metric(const DeformationModel& model, std::span<const double> displacements) {
  return linalg::cholesky_root(platform_metric(model.chain, model.platform->points, displacements).W);
}

std::vector<LimbMotions> limb_motions(const DeformationModel& model, std::span<const double> displacements,
                                      FirstOrder& first_order) {
  std::vector<LimbMotions> limbs;
  for (std::size_t i = 0; i < model.chain.limbs.size(); ++i) {
    const std::size_t joints = model.chain.limbs[i].joints.size();
    limbs.push_back(motions_of(model.chain.limbs[i], displacements.first(joints)));
    limbs.back().platform = platform_by_limb(model.chain, first_order, i);
    displacements = displacements.subspan(joints);
  }
  return limbs;
}

std::vector<LimbSeparation> separations(const std::vector<LimbMotions>& limbs, const Matrix6& root, double radius) {
  std::vector<LimbSeparation> list;
  for (const LimbMotions& limb : limbs) list.emplace_back(limb, root, radius);
  return list;
}

/// The motions of drives that several limbs share, as columns like those of LimbSeparation::motions().
class SharedDrives {
 public:
  /// Adds the motion of the platform by a shared drive through one limb. column: index of the drive among the drives
  /// of this limb. Returns true if the drive was not known before.
  bool add(const LimbSeparation& limb, Eigen::Index column) {
    const auto [place, is_new] = sums_.try_emplace(limb.drives()[static_cast<std::size_t>(column)]);
    const double length = limb.driven_length(column);
    place->second.motion += length * limb.motions().col(column);
    place->second.square += length * length;
    return is_new;
  }

  /// The motion of the platform by the drive: the sum of B_k A_k over the limbs k that the drive moves, divided by the
  /// square root of the sum of |A_k|_k^2 (symbols as for separation()). Zero if the motions through these limbs cancel
  /// each other.
  Screw motion(std::size_t drive) const {
    const Sum& sum = sums_.at(drive);
    const Screw motion = sum.motion / std::sqrt(sum.square);
    return motion.norm() < kDependent ? Screw::Zero().eval() : motion;
  }

 private:
  struct Sum {
    Screw motion = Screw::Zero();
    double square = 0.0;
  };
  std::map<std::size_t, Sum> sums_;
};

/// The projection of a displacement, scaled like Parts, onto the part that corrections by all drives cannot remove.
Matrix6 beyond_all_drives(const std::vector<LimbSeparation>& limbs) {
  Columns motions;
  SharedDrives shared;
  std::vector<std::pair<std::size_t, Eigen::Index>> places;  // indices of shared drives among the columns
  for (const LimbSeparation& limb : limbs) {
    for (Eigen::Index c = 0; c < limb.motions().cols(); ++c) {
      const std::size_t drive = limb.drives()[static_cast<std::size_t>(c)];
      if (drive > 0 && !shared.add(limb, c)) continue;
      if (drive > 0) places.emplace_back(drive, motions.cols());
      next_column(motions) = limb.motions().col(c);
    }
  }
  for (const auto& [drive, column] : places) motions.col(column) = shared.motion(drive);
  return beyond(motions);
}

/// Returns true if the limb's drives move no other limb. The drives can then correct the whole drive part of the limb's
/// errors.
bool drives_are_its_own(const std::vector<LimbSeparation>& limbs, std::size_t limb) {
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    for (const std::size_t drive : limbs[i].drives()) {
      const std::vector<std::size_t>& own = limbs[limb].drives();
      if (i != limb && drive > 0 && std::ranges::find(own, drive) != own.end()) return false;
    }
  }
  return true;
}

}  // namespace

Separation separation(const DeformationModel& model, std::span<const double> pose) {
  POESY_EXPECTS(model.platform && model.platform->points.size() >= 3);
  const std::vector<double> displacements = model.joint_displacements(pose);
  FirstOrder first_order(model.chain);
  if (!first_order.prepare(displacements, nullptr)) {
    const std::vector<double> unknown(model.terms.size(), kNaN);
    return {unknown, unknown, unknown, unknown};
  }
  std::vector<std::vector<EndTwist>> errors;
  for (const ErrorTerms& terms : model.terms) {
    std::vector<EndTwist>& twists = errors.emplace_back();
    for (const ErrorTerm& term : terms) {
      add_twist(term.limb, term.at(displacements) * first_order.motion(model.entry(term)), twists);
    }
  }
  return separation_of(limb_motions(model, displacements, first_order), root_of_metric(model, displacements),
                       radius_of(model.platform->points), errors);
}

void LimbMotions::add(const Joint& joint, const Screw& twist, const Vector3& at) {
  if (joint.fixed) return;
  end = at;
  if (!joint.actuated) {
    next_column(passive) = twist;
    return;
  }
  const auto known = joint.drive == 0 ? drives.end() : std::ranges::find(drives, joint.drive);
  if (known != drives.end()) {
    driven.col(known - drives.begin()) += twist;
  } else {
    next_column(driven) = twist;
    drives.push_back(joint.drive);
  }
}

Separation separation_of(const std::vector<LimbMotions>& motions, const Matrix6& root, double radius,
                         std::span<const std::vector<EndTwist>> errors) {
  const std::vector<LimbSeparation> limbs = separations(motions, root, radius);
  const Matrix6 uncorrected = beyond_all_drives(limbs);
  Separation found;
  for (const std::vector<EndTwist>& twists : errors) {
    Screw drives = Screw::Zero();
    Screw constraints = Screw::Zero();
    Screw left = Screw::Zero();
    for (const EndTwist& end : twists) {
      const auto [drive, constraint] = limbs[end.limb].parts(end.twist);
      drives += drive;
      constraints += constraint;
      left += drives_are_its_own(limbs, end.limb) ? constraint : Screw(drive + constraint);
    }
    found.drive.push_back(drives.norm());
    found.constraint.push_back(constraints.norm());
    found.effect.push_back((drives + constraints).norm());
    found.residual.push_back(left_of(left, uncorrected).norm());
  }
  return found;
}

void add_twist(std::size_t limb, const Screw& twist, std::vector<EndTwist>& twists) {
  const auto known = std::ranges::find(twists, limb, &EndTwist::limb);
  if (known == twists.end()) {
    twists.push_back({limb, twist});
  } else {
    known->twist += twist;
  }
}

std::optional<Matrix6> left_by_drives(const DeformationModel& model, std::span<const double> pose) {
  POESY_EXPECTS(model.platform && model.platform->points.size() >= 3);
  const std::vector<double> displacements = model.joint_displacements(pose);
  FirstOrder first_order(model.chain);
  if (!first_order.prepare(displacements, nullptr)) return std::nullopt;
  // This matrix maps [theta; displacement of the origin] first to the twist, whose v is at the base's origin, and then
  // to lengths.
  Matrix6 to_lengths = Matrix6::Identity();
  to_lengths.bottomLeftCorner<3, 3>() = lie::hat<double>(model.platform_points(displacements)->platform.p);
  const Matrix6 root = root_of_metric(model, displacements);
  to_lengths = root * to_lengths;
  const Matrix6 left = beyond_all_drives(
      separations(limb_motions(model, displacements, first_order), root, radius_of(model.platform->points)));
  return linalg::solve(to_lengths, left * to_lengths);
}

std::optional<SeparationDescription> separation_description(const DeformationModel& model) {
  if (!model.platform || model.platform->points.empty()) return std::nullopt;
  return SeparationDescription{
      "root mean square displacement of the platform's points, without the gap between its limbs",
      std::vector<std::string>(model.terms.size())};
}

}  // namespace poesy::chain
