#include "models/file/tracking.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/units.h"
#include "engine/linalg/decompositions.h"

namespace poesy::file {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

constexpr double kFirstStep = 0.25;           ///< first step along the path, as a share of the path
constexpr double kSmallestStep = 1.0 / 2048;  ///< smallest step along the path, as a share of the path
/// The first step of Newton's method must not change any unknown by more than this (rad, or share of the reach).
constexpr double kLargestMove = 0.5;
constexpr double kContraction = 0.25;  ///< largest ratio of a Newton step to the previous one
constexpr double kRest = 1e-12;        ///< the iteration ends if Newton's step changes no unknown by more than this
/// Newton's iteration also ends if the largest component of the residual (rad, or share of the reach) is at most this.
constexpr double kRounding = 1e-13;
/// Smallest pivot with which columns count as independent, as a share of the largest pivot.
constexpr double kDependent = 1e-12;
constexpr int kMostSteps = 12;      ///< largest number of steps of Tracker::close()
constexpr int kMostSettlings = 60;  ///< largest number of steps of settle_limb()

Index index(std::size_t value) { return static_cast<Index>(value); }

}  // namespace

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

Tracker::Tracker(const Mechanism& mechanism, Given given)
    : unit_(in_reaches(mechanism)), reach_(mechanism.reach), by_(given) {
  const auto give = [&](std::size_t place, bool is_length) {
    given_.push_back(place);
    units_.push_back(is_length ? reach_ : 1.0);
  };
  const std::vector<const Joint*> joints = moving_joints(unit_);
  std::vector<bool> is_given(joints.size(), false);
  std::vector<bool> follows(static_cast<std::size_t>(home_state(unit_).size()), false);
  std::vector<bool> is_settled(joints.size(), true);
  for (const Drive& drive : drives_of(unit_)) {
    const std::size_t first = drive.joints.front();
    if (given == Given::drives) give(first, joints[first]->motion == Motion::prismatic);
    for (const std::size_t place : drive.joints) {
      follows[place] = place != first;
      is_given[place] = given == Given::drives;
      is_settled[place] = !is_given[place] && !drive.is_shared();
    }
    if (drive.is_shared()) shared_.push_back(drive);
  }
  std::size_t begin = 0;
  for (const Limb& limb : unit_.limbs) {
    const std::size_t moving = limb.moving();
    std::vector<std::size_t> free;
    for (std::size_t k = 0; k < moving; ++k) {
      if (is_settled[begin + k]) free.push_back(k);
    }
    Columns columns(6, index(moving));
    limb_transform(limb, std::vector<double>(moving, 0.0), &columns, unit_.bodies[limb.from].home);
    limb_ranks_.push_back(linalg::rank(columns(Eigen::all, free), unit_.precision.rank_threshold));
    idle_ += free.size() - limb_ranks_.back();
    limb_joints_.push_back(std::move(free));
    begin += moving;
  }
  if (given == Given::coordinates) {
    for (const Coordinate& coordinate : unit_.coordinates) give(begin + coordinate.component, coordinate.component < 3);
  }
  for (std::size_t place = 0; place < follows.size(); ++place) {
    if (!follows[place] && std::ranges::find(given_, place) == given_.end()) free_.push_back(place);
  }
}

/// [6 limbs x unknowns] The columns of the unknowns. The column of a drive is the sum of the columns of its joints.
Matrix Tracker::matrix_of(const LoopEquations& equations) const {
  if (shared_.empty()) return equations.columns(Eigen::all, free_);
  Matrix all = equations.columns;
  for (const Drive& drive : shared_) {
    for (const std::size_t other : std::span(drive.joints).subspan(1)) {
      all.col(index(drive.joints.front())) += all.col(index(other));
    }
  }
  return all(Eigen::all, free_);
}

/// A step of Newton's method. For rounded numbers, the step minimises the residual in the metric, among the steps that
/// do not move the idle freedoms.
Vector Tracker::step(const LoopEquations& equations, const State& state) const {
  const Matrix matrix = matrix_of(equations);
  if (!unit_.precision.rounded()) return linalg::least_squares(matrix, equations.residual, kRankThreshold);
  const Matrix ways = linalg::right_singular_vectors(matrix).V.leftCols(matrix.cols() - index(idle_));
  const lie::Matrix6<double> root = metric_root(unit_, pose_of(unit_, state));
  const Vector wanted = weighed(root, equations.residual);
  return ways * linalg::least_squares(weighed(root, matrix * ways), wanted, kDependent);
}

bool Tracker::is_closed(const State& state) const {
  const LoopEquations equations = loop_equations(unit_, state);
  if (!unit_.precision.rounded()) return equations.residual.lpNorm<Eigen::Infinity>() <= kClosed;
  return mismatch(unit_, metric_root(unit_, pose_of(unit_, state)), equations.residual) <= unit_.precision.closed &&
         is_regular(state);
}

/// Returns true if the equations determine all unknowns except the idle freedoms.
bool Tracker::is_regular(const State& state) const {
  const Matrix matrix = matrix_of(loop_equations(unit_, state));
  const Vector values = linalg::singular_values(matrix);
  return values[matrix.cols() - 1 - index(idle_)] > unit_.precision.rank_threshold * values[0];
}

/// Sets all joints of a drive to the displacement of its first joint.
void Tracker::move_together(State& state) const {
  for (const Drive& drive : shared_) {
    for (const std::size_t place : drive.joints) state[index(place)] = state[index(drive.joints.front())];
  }
}

/// Solves the loop equations by Newton's method. The method gives up if a step is larger than kContraction times the
/// previous one, so it finds the root that continues the path.
Tracker::Ending Tracker::close(State& state) const {
  double most = kLargestMove;
  for (int n = 0; n < kMostSteps; ++n) {
    const LoopEquations equations = loop_equations(unit_, state);
    const Vector change = step(equations, state);
    const double size = change.lpNorm<Eigen::Infinity>();
    if (!(size <= most)) return Ending::slow;
    state(free_) += change;
    move_together(state);
    if (size <= kRest || equations.residual.lpNorm<Eigen::Infinity>() <= kRounding) {
      return is_closed(state) ? Ending::closed : Ending::open;
    }
    most = std::max(kContraction * size, kRest);
  }
  return Ending::slow;
}

namespace {

/// Moves joints of a limb such that the sum of squares of their displacements q is least while the limb's end stays at
/// its pose g. This is Newton's method on min |q|^2 / 2 with fixed g(q). To second order the constraint log(g(q) g^-1)
/// is sum xi_j dq_j + sum_{i<j} [xi_i, xi_j] dq_i dq_j / 2, with the twists xi_j of the joints. free: indices of the
/// joints that may move. rank: rank of the columns of these joints. end: pose of the limb's end in the frame of the
/// body at which the limb begins. Returns false if the method does not converge.
bool settle_limb(const Limb& limb, const std::vector<std::size_t>& free, Index rank, const Transform& end,
                 Eigen::Ref<Vector> q) {
  const Index joints = index(free.size());
  Columns all(6, q.size());
  for (int n = 0; n < kMostSettlings; ++n) {
    const Transform g = limb_transform(limb, {q.data(), limb.moving()}, &all);
    const Columns J = all(Eigen::all, free);
    const Vector now = q(free);
    const auto [U, values, V] = linalg::singular_value_decomposition(J);
    const Matrix inverse =
        V.leftCols(rank) * values.head(rank).cwiseInverse().asDiagonal() * U.leftCols(rank).transpose();
    const Matrix idle = V.rightCols(joints - rank);
    const Vector closing = inverse * lie::log(end * g.inverse());
    const lie::Screw<double> multiplier = -inverse.transpose() * now;
    Matrix hessian = Matrix::Identity(joints, joints);
    for (Index i = 0; i < joints; ++i) {
      for (Index j = i + 1; j < joints; ++j) {
        hessian(i, j) = hessian(j, i) = 0.5 * multiplier.dot(lie::bracket<double>(J.col(i), J.col(j)));
      }
    }
    const Vector slope = idle.transpose() * (now + hessian * closing);
    const auto newton = linalg::solve_positive_definite(idle.transpose() * hessian * idle, slope);
    Vector along = newton ? Vector(-*newton) : Vector(-slope);
    if (along.norm() > kLargestMove) along *= kLargestMove / along.norm();
    const Vector change = closing + idle * along;
    q(free) += change;
    if (!change.allFinite()) return false;
    if (change.lpNorm<Eigen::Infinity>() <= kRest) return true;
  }
  return false;
}

}  // namespace

bool Tracker::settle(State& state) const {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < unit_.limbs.size(); ++i) {
    const Limb& limb = unit_.limbs[i];
    Eigen::Ref<Vector> q = state.segment(index(begin), index(limb.moving()));
    begin += limb.moving();
    if (limb_ranks_[i] == limb_joints_[i].size()) continue;
    Transform end = transform_of(unit_, state, limb.to);
    if (limb.from != kBase) end = transform_of(unit_, state, limb.from).inverse() * end;
    // If numbers are rounded, the limb keeps its share of the mismatch.
    if (unit_.precision.rounded()) end = limb_transform(limb, {q.data(), limb.moving()});
    if (!settle_limb(limb, limb_joints_[i], index(limb_ranks_[i]), end, q)) return false;
  }
  return true;
}

std::string Tracker::why(const State& state, Ending ending, double share) const {
  // The number of unknown joint displacements. In free_ they precede the unknown components of the bodies' poses.
  const auto joints = std::ranges::count_if(free_, [&](std::size_t place) { return place < unit_.moving(); });
  const std::string where =
      "the way there from home ends after " + readable_text({100.0 * share, Dimension::number}, 3) + " %: ";
  if (ending == Ending::open && is_regular(state)) {
    return where + "beyond, the loops stay open by more than rounding, because the limbs do not fit each other there";
  }
  const Matrix matrix = matrix_of(loop_equations(unit_, state));
  const Vector weakest = linalg::right_singular_vectors(matrix).V.col(matrix.cols() - 1 - index(idle_));
  Index column = 0;
  weakest.head(joints).cwiseAbs().maxCoeff(&column);
  std::size_t place = free_[static_cast<std::size_t>(column)];
  std::string blamed;
  for (std::size_t i = 0; i < unit_.limbs.size() && blamed.empty(); ++i) {
    for (const Joint& joint : unit_.limbs[i].joints) {
      if (joint.moves() && place-- == 0) {
        blamed = "joint '" + joint.name + "' of " + limb_text(unit_, i);
        break;
      }
    }
  }
  if (ending == Ending::restless) return where + "there the pose does not determine the idle freedom at " + blamed;
  return where + "there the mechanism comes to a singular pose, " +
         (by_ == Given::drives
              ? "in which its drives do not hold it"
              : "a limb is stretched, folded or has its axes in line, or one coordinate depends on the others") +
         ", and " + blamed + " moves most";
}

Tracked Tracker::track(std::span<const double> numbers) const {
  POESY_EXPECTS(numbers.size() == given_.size());
  const State home = home_state(unit_);
  State state = home;
  bool finite = true;
  for (const double number : numbers) finite = finite && std::isfinite(number);
  double share = 0.0;
  double stride = kFirstStep;
  Ending ending = Ending::closed;
  while (finite && share < 1.0 && stride >= kSmallestStep) {
    const double next = std::min(share + stride, 1.0);
    State trial = state;
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      const Index place = index(given_[n]);
      const double wanted = numbers[n] / units_[n];
      trial[place] = next < 1.0 ? home[place] + next * (wanted - home[place]) : wanted;
    }
    move_together(trial);
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
  Tracked tracked{{}, pose_of(unit_, state), {}, share, {}};
  if (share < 1.0) tracked.unreachable = finite ? why(state, ending, share) : "a coordinate is not a finite number";
  tracked.open = ending == Ending::open && share < 1.0 && is_regular(state);
  if (unit_.precision.rounded()) {
    const lie::Matrix6<double> root = metric_root(unit_, tracked.pose);
    tracked.mismatch = reach_ * mismatch(unit_, root, loop_equations(unit_, state).residual);
  }
  tracked.platform = platform_transform(unit_, tracked.pose);
  tracked.platform.p *= reach_;
  for (std::size_t k = 0; k < 3; ++k) tracked.pose[k] *= reach_;
  tracked.displacements = scaled_displacements(unit_, {state.data(), unit_.moving()}, reach_);
  tracked.state = std::move(state);
  return tracked;
}

}  // namespace poesy::file
