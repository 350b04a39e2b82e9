#include "models/file/mobility.h"

#include <algorithm>
#include <cmath>

#include "engine/base/units.h"
#include "engine/linalg/decompositions.h"
#include "models/file/structure.h"
#include "models/file/tracking.h"

namespace poesy::file {
namespace {

using Matrix = Eigen::MatrixXd;
using Eigen::Index;
using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// The singular values of a matrix, its rank, and an orthonormal basis of its null space.
struct Decomposed {
  Eigen::VectorXd values;
  Index rank;
  Matrix null;  ///< [columns x (columns - rank)] basis of the null space
  Matrix V;     ///< [columns x columns] right singular vectors
};

/// Decomposes a matrix. A singular value counts as zero if it is at most `threshold` times the largest singular value,
/// or times `largest` if this argument is not 0.
Decomposed decomposed(const Matrix& matrix, double threshold, double largest = 0.0) {
  if (matrix.cols() == 0 || matrix.rows() == 0) {
    const Matrix identity = Matrix::Identity(matrix.cols(), matrix.cols());
    return {{}, 0, identity, identity};
  }
  const linalg::SingularValueDecomposition svd = linalg::right_singular_vectors(matrix);
  const double smallest = threshold * (largest > 0.0 ? largest : svd.values[0]);
  const Index rank = (svd.values.array() > smallest).count();
  return {svd.values, rank, svd.V.rightCols(matrix.cols() - rank), svd.V};
}

std::size_t size(Index count) { return static_cast<std::size_t>(count); }

/// The loop Jacobian and the twists of the bodies, with lengths in units of the reach.
struct Jacobians {
  Matrix loops;
  /// For each body, its twists by the joints, one in each column; 0 for the base.
  std::vector<Columns> bodies;
  std::vector<const Joint*> joints;  ///< joint of each column
  std::vector<std::string> limbs;    ///< limb of each column, for messages

  const Columns& platform() const { return bodies[kPlatform]; }
};

/// The twist of a body is that of the limb that places it (placing_limbs()). Each other limb that ends at the body
/// gives six equations: the twist of this limb minus that of the body.
Jacobians jacobians(const Mechanism& unit, std::span<const double> q) {
  const auto joints = static_cast<Index>(unit.moving());
  const std::size_t bodies = unit.bodies.size();
  const auto loops = static_cast<Index>(unit.limbs.size() - (bodies - 1));
  Jacobians made{Matrix::Zero(6 * loops, joints), std::vector<Columns>(bodies, Columns::Zero(6, joints)), {}, {}};
  std::vector<Index> first;
  Index column = 0;
  for (std::size_t i = 0; i < unit.limbs.size(); ++i) {
    first.push_back(column);
    column += static_cast<Index>(unit.limbs[i].moving());
    for (const Joint& joint : unit.limbs[i].joints) {
      if (!joint.moves()) continue;
      made.joints.push_back(&joint);
      made.limbs.push_back(limb_text(unit, i));
    }
  }
  std::vector<Transform> at(bodies);
  /// Adds sign x (twist of the limb's end) to `to`, and returns the pose of the end.
  const auto add_limb = [&](std::size_t i, Eigen::Ref<Matrix> to, double sign) {
    const Limb& limb = unit.limbs[i];
    Columns columns(6, static_cast<Index>(limb.moving()));
    const Transform end = limb_transform(limb, q.subspan(size(first[i]), limb.moving()), &columns, at[limb.from]);
    to += sign * made.bodies[limb.from];
    to.middleCols(first[i], columns.cols()) += sign * columns;
    return end;
  };
  std::vector<bool> places(unit.limbs.size(), false);
  for (const std::size_t i : placing_limbs(unit)) {
    places[i] = true;
    Matrix twists = Matrix::Zero(6, joints);
    at[unit.limbs[i].to] = add_limb(i, twists, 1.0);
    made.bodies[unit.limbs[i].to] = twists;
  }
  Index row = 0;
  for (std::size_t i = 0; i < unit.limbs.size(); ++i) {
    if (places[i]) continue;
    add_limb(i, made.loops.middleRows(row, 6), 1.0);
    made.loops.middleRows(row, 6) -= made.bodies[unit.limbs[i].to];
    row += 6;
  }
  return made;
}

/// Replaces the columns of all joints of a drive by one column, their sum. The sum takes the place of the column of the
/// drive's first joint.
Jacobians with_one_column_a_drive(Jacobians all, const std::vector<Drive>& drives) {
  std::vector<Index> kept;
  std::vector<bool> follows(all.joints.size(), false);
  for (const Drive& drive : drives) {
    const auto first = static_cast<Index>(drive.joints.front());
    for (const std::size_t other : std::span(drive.joints).subspan(1)) {
      all.loops.col(first) += all.loops.col(static_cast<Index>(other));
      for (Columns& body : all.bodies) body.col(first) += body.col(static_cast<Index>(other));
      follows[other] = true;
    }
  }
  Jacobians made{{}, {}, {}, {}};
  for (std::size_t k = 0; k < follows.size(); ++k) {
    if (follows[k]) continue;
    kept.push_back(static_cast<Index>(k));
    made.joints.push_back(all.joints[k]);
    made.limbs.push_back(all.limbs[k]);
  }
  made.loops = all.loops(Eigen::all, kept);
  for (const Columns& body : all.bodies) made.bodies.emplace_back(body(Eigen::all, kept));
  return made;
}

/// The columns of the joints without a drive.
Matrix passive(const Matrix& matrix, const Jacobians& all) {
  Matrix made(matrix.rows(), matrix.cols());
  Index count = 0;
  for (Index column = 0; column < matrix.cols(); ++column) {
    if (!all.joints[size(column)]->actuated) made.col(count++) = matrix.col(column);
  }
  return made.leftCols(count);
}

/// A vector as text: "(0, 0.71, 0.71)".
std::string vector_text(const Vector3& vector) {
  const auto entry = [](double value) {
    const double rounded = std::round(100.0 * value) / 100.0;
    return shortest(rounded == 0.0 ? 0.0 : rounded);
  };
  return "(" + entry(vector.x()) + ", " + entry(vector.y()) + ", " + entry(vector.z()) + ")";
}

/// Sets the texts for a motion of the passive joints: "joint 'A' of limb 2 is loose, and the platform turns about (0,
/// 0, 1)".
void describe_loose(const Jacobians& all, const Eigen::VectorXd& motion, const lie::Screw<double>& twist,
                    Mobility& found) {
  Index largest = 0;
  for (Index n = 1; n < motion.size(); ++n) {
    if (std::abs(motion[n]) > std::abs(motion[largest])) largest = n;
  }
  Index column = 0;
  for (Index passed = 0;; ++column) {
    if (!all.joints[size(column)]->actuated && passed++ == largest) break;
  }
  const bool turns = twist.head<3>().norm() > 1e-3 * twist.norm();
  const Vector3 along = turns ? twist.head<3>() : twist.tail<3>();
  const Vector3 direction = along / along.norm();
  found.loose_place = all.joints[size(column)]->place;
  found.loose_text = "joint '" + all.joints[size(column)]->name + "' of " + all.limbs[size(column)] +
                     " is loose, and " + found.loose_body + " " +
                     (turns ? "turns about " + vector_text(direction) : "slides along " + vector_text(direction));
}

/// Finds whether the platform or another body can move while all drives are held. bodies: those of the mechanism.
void find_loose(const Jacobians& all, const std::vector<assembly::Body>& bodies, double threshold, Mobility& found) {
  const Matrix loops = passive(all.loops, all);
  const double largest = found.singular_values.empty() ? 0.0 : found.singular_values[0];
  const Decomposed locked = decomposed(loops, threshold, largest);
  found.passive_rank = size(locked.rank);
  found.left_when_locked = size(locked.null.cols());
  for (std::size_t b = kPlatform; b < bodies.size(); ++b) {
    const Matrix moved = passive(all.bodies[b], all) * locked.null;
    const Decomposed body = decomposed(moved, threshold, 1.0);
    if (body.rank == 0) continue;
    found.loose = size(body.rank);
    found.loose_body = b == kPlatform ? "the platform" : "body '" + bodies[b].name + "'";
    const Eigen::VectorXd freedom = body.V.col(0);
    describe_loose(all, locked.null * freedom, moved * freedom, found);
    return;
  }
}

/// The name of the first coordinate whose removal does not change the rank.
std::string dependent_of(const Mechanism& unit, const Matrix& rates, Index rank) {
  for (Index row = 0; row < rates.rows(); ++row) {
    Matrix others = rates;
    others.row(row).setZero();
    if (decomposed(others, unit.precision.rank_threshold, 1.0).rank == rank) return unit.coordinates[size(row)].name;
  }
  return {};
}

void find_coordinates(const Mechanism& unit, const PlatformPose& pose, const Matrix& twists, Mobility& found) {
  if (twists.cols() == 0) return;  // nothing moves; Eigen does not support a matrix without columns here
  // If the coordinates are singular at this pose, `rates` are the least-squares rates of least norm.
  const Matrix rates = linalg::pseudo_inverse(platform_columns(unit, pose)) * twists;
  Matrix chosen(static_cast<Index>(unit.coordinates.size()), rates.cols());
  for (std::size_t c = 0; c < unit.coordinates.size(); ++c) {
    chosen.row(static_cast<Index>(c)) = rates.row(static_cast<Index>(unit.coordinates[c].component));
  }
  const Index rank = decomposed(chosen, unit.precision.rank_threshold, 1.0).rank;
  found.coordinates_rank = size(rank);
  if (found.coordinates_rank < unit.coordinates.size()) found.dependent = dependent_of(unit, chosen, rank);
}

/// The argument `largest` of decomposed() for the loop Jacobian. If a drive moves several joints, their columns may
/// cancel in the sum; so the result is the largest singular value of the matrix with a column for each joint. Otherwise
/// the result is 0: decomposed() then takes the largest singular value of its own matrix.
double largest_of(const Matrix& loops_by_joint, const std::vector<Drive>& drives) {
  if (std::ranges::none_of(drives, &Drive::is_shared)) return 0.0;
  return linalg::singular_values(loops_by_joint)[0];
}

/// The mobility of a mechanism from in_reaches().
Mobility mobility_of(const Mechanism& unit, std::span<const double> q, const PlatformPose& pose) {
  const double threshold = unit.precision.rank_threshold;
  const Jacobians of_joints = jacobians(unit, q);
  const std::vector<Drive> drives = drives_of(unit);
  const Jacobians all = with_one_column_a_drive(of_joints, drives);
  const Decomposed loops = decomposed(all.loops, threshold, largest_of(of_joints.loops, drives));
  const Matrix twists = all.platform() * loops.null;
  Mobility found{.joints = of_joints.joints.size(), .drives = drives.size(), .loop_equations = size(all.loops.rows())};
  for (const Drive& drive : drives) found.actuated += drive.joints.size();
  found.singular_values.assign(loops.values.begin(), loops.values.end());
  found.rank = size(loops.rank);
  found.freedoms = all.joints.size() - found.rank;
  found.over_constraints = found.loop_equations - found.rank;
  found.platform_freedoms = size(decomposed(twists, threshold, 1.0).rank);
  found.platform_rotates = size(decomposed(twists.topRows(3), threshold, 1.0).rank);
  found.idle = found.freedoms - found.platform_freedoms;
  find_loose(all, unit.bodies, threshold, found);
  find_coordinates(unit, pose, twists, found);
  return found;
}

/// The k-th point of Roberts' sequence in the unit cube of n dimensions. Coordinate d (from 1) is the fractional part
/// of 1/2 + (k + 1) / phi^d, where phi^(n+1) = phi + 1.
std::vector<double> even_point(std::size_t k, std::size_t dimensions) {
  double phi = 2.0;
  for (int n = 0; n < 60; ++n) phi = std::pow(1.0 + phi, 1.0 / (static_cast<double>(dimensions) + 1.0));
  std::vector<double> point;
  double step = 1.0;
  for (std::size_t d = 0; d < dimensions; ++d) {
    step /= phi;
    const double along = 0.5 + step * static_cast<double>(k + 1);
    point.push_back(along - std::floor(along));
  }
  return point;
}

std::string count_text(std::size_t count, const std::string& one) {
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace

std::optional<double> Mobility::below_gap() const {
  return rank < singular_values.size() ? std::optional(singular_values[rank]) : std::nullopt;
}

Mobility mobility(const Mechanism& mechanism, std::span<const double> displacements, const PlatformPose& pose) {
  const std::vector<double> q = scaled_displacements(mechanism, displacements, 1.0 / mechanism.reach);
  PlatformPose unit_pose = pose;
  for (std::size_t k = 0; k < 3; ++k) unit_pose[k] /= mechanism.reach;
  return mobility_of(in_reaches(mechanism), q, unit_pose);
}

Mobility home_mobility(const Mechanism& mechanism) {
  return mobility(mechanism, std::vector<double>(mechanism.moving(), 0.0), home_pose(mechanism));
}

namespace {

/// Sets the parasitic motion of the platform at `pose`: its motion relative to the pose that has the same coordinates
/// and, in all other components, the values of home.
void find_parasitic(const Mechanism& mechanism, const PlatformPose& pose, PoseMobility& found) {
  PlatformPose without = home_pose(mechanism);
  for (const Coordinate& coordinate : mechanism.coordinates) without[coordinate.component] = pose[coordinate.component];
  const Transform from = platform_transform(mechanism, without);
  const Transform to = platform_transform(mechanism, pose);
  found.moved = (to.p - from.p).norm();
  for (std::size_t k = 3; k < pose.size(); ++k) found.turned = std::max(found.turned, std::abs(pose[k] - without[k]));
  // An angle (rad) below this is taken from the component itself, because products of rotations would add rounding.
  constexpr double kSmall = 1e-9;
  if (found.turned < kSmall) return;
  const lie::Matrix3<double> turn = to.R * from.R.transpose();
  found.turned = lie::log<double>(turn).norm();
}

}  // namespace

std::vector<PoseMobility> workspace_mobility(const Mechanism& mechanism, std::size_t count) {
  const Tracker tracker(mechanism);
  std::vector<PoseMobility> list;
  for (std::size_t k = 0; k < count; ++k) {
    PoseMobility found{even_point(k, mechanism.coordinates.size()), {}};
    for (std::size_t c = 0; c < found.pose.size(); ++c) {
      const Coordinate& coordinate = mechanism.coordinates[c];
      found.pose[c] = coordinate.lower + found.pose[c] * (coordinate.upper - coordinate.lower);
    }
    found.tracked = tracker.track(found.pose);
    if (found.reached()) {
      found.mobility = mobility(mechanism, found.tracked.displacements, found.tracked.pose);
      find_parasitic(mechanism, found.tracked.pose, found);
    }
    list.push_back(std::move(found));
  }
  return list;
}

namespace {

/// The text " in limb 2, which has none" for the first limb without a drive, if some limbs have drives. Empty
/// otherwise, and empty if the mechanism is branched, because then many limbs have no drive.
std::string limb_without_drive(const Mechanism& mechanism) {
  if (mechanism.is_branched()) return {};
  const auto has_none = [](const Limb& limb) { return std::ranges::none_of(limb.joints, &Joint::actuated); };
  const auto first = std::ranges::find_if(mechanism.limbs, has_none);
  if (first == mechanism.limbs.end() || std::ranges::all_of(mechanism.limbs, has_none)) return {};
  return " in limb " + std::to_string(first - mechanism.limbs.begin() + 1) + ", which has none";
}

/// Throws if the platform or another body can move while all drives are held. where: "" at home, or " at some poses".
void check_held(const Mechanism& mechanism, const Mobility& found, const std::string& where) {
  if (found.loose == 0) return;
  throw InputError(
      found.loose_place,
      "the drives do not hold " + found.loose_body + where +
          (found.loose_body == "the platform" ? ", which has " + count_text(found.platform_freedoms, "freedom") +
                                                    " and " + count_text(found.drives, "drive")
                                              : "") +
          ": " + found.loose_text,
      found.loose_body != "the platform" ? "fix or drive that joint, or hold " + found.loose_body + " by another limb"
      : found.drives < found.platform_freedoms
          ? "write actuated = true at one more joint" + limb_without_drive(mechanism) + ", or correct the axes"
          : "correct the axes, drive another joint, or draw it at a pose that is not singular");
}

}  // namespace

void check_mobility(const Mechanism& mechanism, const Mobility& home) {
  const auto fail = [&](const std::string& problem, const std::string& remedy) {
    const std::vector<std::string> along = axes_along_legs(mechanism);
    throw InputError(mechanism.coordinates_place, problem, along.empty() ? remedy : along.front() + "; " + remedy);
  };
  if (home.platform_freedoms == 0) fail("the platform cannot move", "look at the axes of the joints at home");
  if (home.joints == home.actuated) {
    fail("a drive holds every joint that moves, so none gives way to errors",
         "leave actuated out at joints without a drive, or add the joints that let the mechanism be assembled");
  }
  check_held(mechanism, home, "");
  const std::size_t named = mechanism.coordinates.size();
  if (home.coordinates_rank < named) {
    fail("platform.coordinates are not independent: " + home.dependent +
             " follows from the others, and the platform has " + count_text(home.platform_freedoms, "freedom"),
         home.drives < home.actuated
             ? "remove it, take another, correct the axes of the joints, or let fewer joints share a drive"
             : "remove it, take another, or correct the axes of the joints");
  }
  if (named < home.platform_freedoms) {
    fail("platform.coordinates has " + std::to_string(named) + ", but the platform has " +
             count_text(home.platform_freedoms, "freedom"),
         "name as many as it has freedoms");
  }
}

void check_mobility(const Mechanism& mechanism, const Mobility& home, std::span<const PoseMobility> poses) {
  const auto fail = [&](const std::string& problem, const std::string& remedy) {
    throw InputError(mechanism.coordinates_place, problem, remedy);
  };
  if (poses.empty()) return;
  if (std::ranges::none_of(poses, &PoseMobility::reached)) {
    fail("no pose that was tried in the workspace is reached from home: " + poses.front().tracked.unreachable,
         "correct the workspace, or the home pose if the mechanism moves there by an instant only");
  }
  for (const PoseMobility& pose : poses) {
    if (!pose.reached()) continue;
    if (pose.mobility.rank != home.rank) {
      fail("home is a singular pose: the mechanism has " + count_text(home.freedoms, "freedom") + " there, and " +
               std::to_string(pose.mobility.freedoms) + " elsewhere",
           "draw it at another pose");
    }
    check_held(mechanism, pose.mobility, " at some poses");
  }
}

}  // namespace poesy::file
