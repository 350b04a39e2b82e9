#include "models/file/loops.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/linalg/decompositions.h"
#include "models/chain/limb.h"
#include "models/chain/metric.h"

namespace poesy::file {
namespace {

using Eigen::Index;
using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// The index in a State of the first number of a body's pose.
Index place_of(const Mechanism& unit, std::size_t body) { return static_cast<Index>(unit.moving() + 6 * (body - 1)); }

}  // namespace

State home_state(const Mechanism& unit) {
  State state = State::Zero(static_cast<Index>(unit.moving() + 6 * (unit.bodies.size() - 1)));
  for (std::size_t b = kPlatform; b < unit.bodies.size(); ++b) {
    std::ranges::copy(home_pose(unit, b), state.begin() + place_of(unit, b));
  }
  return state;
}

PlatformPose pose_of(const Mechanism& unit, const State& state, std::size_t body) {
  PlatformPose pose;
  std::copy_n(state.begin() + place_of(unit, body), pose.size(), pose.begin());
  return pose;
}

Transform transform_of(const Mechanism& unit, const State& state, std::size_t body) {
  return body == kBase ? Transform() : body_transform(unit, body, pose_of(unit, state, body));
}

LoopEquations loop_equations(const Mechanism& unit, const State& state) {
  const auto rows = 6 * static_cast<Index>(unit.limbs.size());
  LoopEquations made{Eigen::MatrixXd::Zero(rows, state.size()), Eigen::VectorXd(rows)};
  std::vector<Transform> bodies(unit.bodies.size());
  std::vector<lie::Matrix6<double>> by_pose(unit.bodies.size());
  for (std::size_t b = kPlatform; b < bodies.size(); ++b) {
    bodies[b] = transform_of(unit, state, b);
    by_pose[b] = body_columns(unit, b, pose_of(unit, state, b));
  }
  Index row = 0;
  Index begin = 0;
  for (const Limb& limb : unit.limbs) {
    const auto moving = static_cast<Index>(limb.moving());
    Columns columns(6, moving);
    const Transform g = limb_transform(limb, {state.data() + begin, limb.moving()}, &columns, bodies[limb.from]);
    made.columns.block(row, begin, 6, moving) = columns;
    made.columns.block<6, 6>(row, place_of(unit, limb.to)) = -by_pose[limb.to];
    if (limb.from != kBase) made.columns.block<6, 6>(row, place_of(unit, limb.from)) = by_pose[limb.from];
    made.residual.segment<6>(row) = lie::log(bodies[limb.to] * g.inverse());
    begin += moving;
    row += 6;
  }
  return made;
}

lie::Matrix6<double> metric_root(const Mechanism& unit, const PlatformPose& pose) {
  const Transform platform = platform_transform(unit, pose);
  std::vector<Vector3> points;
  for (const Vector3& point : unit.points) points.emplace_back(platform.R * point + platform.p);
  return linalg::cholesky_root(chain::metric_of_points(points));
}

Eigen::MatrixXd weighed(const lie::Matrix6<double>& root, const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd made(rows.rows(), rows.cols());
  for (Index row = 0; row < rows.rows(); row += 6) made.middleRows<6>(row) = root * rows.middleRows<6>(row);
  return made;
}

double mismatch(const Mechanism& unit, const lie::Matrix6<double>& root, const Eigen::VectorXd& residual) {
  if (unit.is_branched()) {
    const double square = weighed(root, residual).squaredNorm();
    return std::sqrt(2.0 / static_cast<double>(unit.loops()) * square);
  }
  double sum = 0.0;
  const std::vector<chain::LimbPair> pairs = chain::pairs_of(unit.limbs.size());
  for (const chain::LimbPair& pair : pairs) {
    const lie::Screw<double> apart =
        residual.segment<6>(6 * static_cast<Index>(pair.k)) - residual.segment<6>(6 * static_cast<Index>(pair.i));
    sum += (root * apart).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

}  // namespace poesy::file
