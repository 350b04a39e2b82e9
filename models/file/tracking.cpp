#include "models/file/tracking.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/units.h"
#include "models/file/mobility.h"

namespace poesy::file {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

constexpr double kFirstStep = 0.25;           ///< of the way
constexpr double kSmallestStep = 1.0 / 2048;  ///< of the way
constexpr double kLargestMove = 0.5;          ///< of a joint in Newton's first step, rad or reaches
constexpr double kContraction = 0.25;         ///< of each later step against the one before
constexpr double kRest = 1e-12;               ///< a step this small ends the iteration
constexpr double kRounding = 1e-13;           ///< a residual this small does so too, rad or reaches
constexpr int kMostSteps = 12;
constexpr int kMostSettlings = 60;

Index index(std::size_t value) { return static_cast<Index>(value); }

Index rank_of(const Vector& singular_values) {
  return (singular_values.array() > kRankThreshold * singular_values[0]).count();
}

std::span<const double> part(const Vector& q, std::size_t begin, std::size_t count) {
  return {q.data() + begin, count};
}

}  // namespace

/// Joints and platform on the way.
struct Tracker::State {
  Vector q;           ///< [moving], in units of the reach
  PlatformPose pose;  ///< likewise
};

/// Every limb's platform moves to where the pose says: J_i dq_i - C dpose = log(T g_i^-1).
struct Tracker::System {
  Matrix matrix;    ///< [6 limbs x (moving + free)]
  Vector residual;  ///< [6 limbs]
};

std::vector<double> scaled_displacements(const Mechanism& mechanism, std::span<const double> displacements,
                                         double factor) {
  std::vector<double> scaled(displacements.begin(), displacements.end());
  std::size_t k = 0;
  for (const Limb& limb : mechanism.limbs) {
    for (const Joint& joint : limb.joints) {
      if (joint.moves() && joint.motion == Motion::prismatic) scaled[k] *= factor;
      if (joint.moves()) ++k;
    }
  }
  return scaled;
}

Tracker::Tracker(const Mechanism& mechanism) : unit_(in_reaches(mechanism)), reach_(mechanism.reach) {
  for (std::size_t component = 0; component < 6; ++component) {
    if (std::ranges::find(unit_.coordinates, component, &Coordinate::component) == unit_.coordinates.end()) {
      free_.push_back(component);
    }
  }
  for (const Limb& limb : unit_.limbs) {
    Columns columns(6, index(limb.moving()));
    limb_transform(limb, std::vector<double>(limb.moving(), 0.0), &columns);
    limb_ranks_.push_back(static_cast<std::size_t>(rank_of(Eigen::JacobiSVD<Matrix>(columns).singularValues())));
  }
}

Tracker::System Tracker::system(const State& state) const {
  const Index joints = state.q.size();
  const auto rows = 6 * index(unit_.limbs.size());
  System made{Matrix::Zero(rows, joints + index(free_.size())), Vector(rows)};
  const Transform wanted = platform_transform(unit_, state.pose);
  const lie::Matrix6<double> by_pose = platform_columns(unit_, state.pose);
  Index row = 0;
  std::size_t begin = 0;
  for (const Limb& limb : unit_.limbs) {
    Columns columns(6, index(limb.moving()));
    const Transform g = limb_transform(limb, part(state.q, begin, limb.moving()), &columns);
    made.matrix.block(row, index(begin), 6, columns.cols()) = columns;
    for (std::size_t f = 0; f < free_.size(); ++f) {
      made.matrix.block<6, 1>(row, joints + index(f)) = -by_pose.col(index(free_[f]));
    }
    made.residual.segment<6>(row) = lie::log(wanted * g.inverse());
    begin += limb.moving();
    row += 6;
  }
  return made;
}

/// Newton's method, as long as every step is a fraction of the one before: then the root is the one on the way.
Tracker::Ending Tracker::close(State& state) const {
  double most = kLargestMove;
  for (int n = 0; n < kMostSteps; ++n) {
    const System equations = system(state);
    Eigen::CompleteOrthogonalDecomposition<Matrix> least_norm;
    least_norm.setThreshold(kRankThreshold);
    const Vector change = least_norm.compute(equations.matrix).solve(equations.residual);
    const double size = change.lpNorm<Eigen::Infinity>();
    if (!(size <= most)) return Ending::slow;
    state.q += change.head(state.q.size());
    for (std::size_t f = 0; f < free_.size(); ++f) state.pose[free_[f]] += change[state.q.size() + index(f)];
    if (size <= kRest || equations.residual.lpNorm<Eigen::Infinity>() <= kRounding) {
      const bool closed = system(state).residual.lpNorm<Eigen::Infinity>() <= kClosed;
      return closed ? Ending::closed : Ending::open;
    }
    most = std::max(kContraction * size, kRest);
  }
  return Ending::slow;
}

namespace {

/// A limb that holds the platform where it is and still moves: the displacements with the least sum of squares, by
/// Newton's method on min |q|^2 / 2 where log(g(q) g^-1) is given. To second order that is sum xi_j dq_j +
/// sum_{i<j} [xi_i, xi_j] dq_i dq_j / 2. rank: of its columns.
bool settle_limb(const Limb& limb, Index rank, const Transform& platform, Eigen::Ref<Vector> q) {
  const Index joints = q.size();
  Columns J(6, joints);
  for (int n = 0; n < kMostSettlings; ++n) {
    const Transform g = limb_transform(limb, {q.data(), static_cast<std::size_t>(joints)}, &J);
    const Eigen::JacobiSVD<Matrix> svd(J, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix inverse = svd.matrixV().leftCols(rank) * svd.singularValues().head(rank).cwiseInverse().asDiagonal() *
                           svd.matrixU().leftCols(rank).transpose();
    const Matrix idle = svd.matrixV().rightCols(joints - rank);
    const Vector closing = inverse * lie::log(platform * g.inverse());
    const lie::Screw<double> multiplier = -inverse.transpose() * q;
    Matrix hessian = Matrix::Identity(joints, joints);
    for (Index i = 0; i < joints; ++i) {
      for (Index j = i + 1; j < joints; ++j) {
        hessian(i, j) = hessian(j, i) = 0.5 * multiplier.dot(lie::bracket<double>(J.col(i), J.col(j)));
      }
    }
    const Vector slope = idle.transpose() * (q + hessian * closing);
    const Eigen::LLT<Matrix> curvature(idle.transpose() * hessian * idle);
    Vector along = curvature.info() == Eigen::Success ? Vector(-curvature.solve(slope)) : Vector(-slope);
    if (along.norm() > kLargestMove) along *= kLargestMove / along.norm();
    const Vector change = closing + idle * along;
    q += change;
    if (!change.allFinite()) return false;
    if (change.lpNorm<Eigen::Infinity>() <= kRest) return true;
  }
  return false;
}

}  // namespace

bool Tracker::settle(State& state) const {
  const Transform platform = platform_transform(unit_, state.pose);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < unit_.limbs.size(); ++i) {
    const Limb& limb = unit_.limbs[i];
    const std::size_t joints = limb.moving();
    if (limb_ranks_[i] < joints &&
        !settle_limb(limb, index(limb_ranks_[i]), platform, state.q.segment(index(begin), index(joints)))) {
      return false;
    }
    begin += joints;
  }
  return true;
}

std::string Tracker::why(const State& state, Ending ending, double share) const {
  Index idle = 0;
  for (std::size_t i = 0; i < unit_.limbs.size(); ++i) idle += index(unit_.limbs[i].moving() - limb_ranks_[i]);
  const std::string where =
      "the way there from home ends after " + readable_text({100.0 * share, Dimension::number}, 3) + " %: ";
  if (ending == Ending::open) {
    return where + "beyond, the loops stay open by more than rounding, because the limbs do not fit each other there";
  }
  const Matrix matrix = system(state).matrix;
  const Eigen::JacobiSVD<Matrix> svd(matrix, Eigen::ComputeFullV);
  const Vector weakest = svd.matrixV().col(matrix.cols() - 1 - idle);
  Index column = 0;
  weakest.head(state.q.size()).cwiseAbs().maxCoeff(&column);
  std::string blamed;
  for (std::size_t i = 0; i < unit_.limbs.size() && blamed.empty(); ++i) {
    for (const Joint& joint : unit_.limbs[i].joints) {
      if (joint.moves() && column-- == 0) {
        blamed = "joint '" + joint.name + "' of limb " + std::to_string(i + 1);
        break;
      }
    }
  }
  if (ending == Ending::restless) return where + "there the idle freedom at " + blamed + " has no definite position";
  return where +
         "there the mechanism comes to a singular pose, a limb is stretched, folded or has its axes in line, and " +
         blamed + " moves most";
}

Tracked Tracker::track(std::span<const double> coordinates) const {
  POESY_EXPECTS(coordinates.size() == unit_.coordinates.size());
  State state{Vector::Zero(index(unit_.moving())), home_pose(unit_)};
  const PlatformPose home = state.pose;
  PlatformPose wanted = home;
  bool finite = true;
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const Coordinate& coordinate = unit_.coordinates[c];
    wanted[coordinate.component] = coordinate.component < 3 ? coordinates[c] / reach_ : coordinates[c];
    finite = finite && std::isfinite(coordinates[c]);
  }
  double share = 0.0;
  double stride = kFirstStep;
  Ending ending = Ending::closed;
  while (finite && share < 1.0 && stride >= kSmallestStep) {
    const double next = std::min(share + stride, 1.0);
    State trial = state;
    for (const Coordinate& coordinate : unit_.coordinates) {
      const std::size_t k = coordinate.component;
      trial.pose[k] = next < 1.0 ? home[k] + next * (wanted[k] - home[k]) : wanted[k];
    }
    const Ending ended = close(trial);
    if (ended == Ending::closed && settle(trial)) {
      state = std::move(trial);
      share = next;
      stride *= 2.0;
    } else {
      ending = ended == Ending::closed ? Ending::restless : ended;
      stride *= 0.5;
    }
  }
  Tracked tracked{{}, state.pose, {}, share, {}};
  if (share < 1.0) tracked.unreachable = finite ? why(state, ending, share) : "a coordinate is not a finite number";
  for (std::size_t k = 0; k < 3; ++k) tracked.pose[k] *= reach_;
  tracked.platform = platform_transform(unit_, state.pose);
  tracked.platform.p *= reach_;
  tracked.displacements = scaled_displacements(unit_, {state.q.data(), unit_.moving()}, reach_);
  return tracked;
}

}  // namespace poesy::file
