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

}  // namespace

PlatformPose pose_of(const State& state) {
  PlatformPose pose;
  std::ranges::copy(state.tail<6>(), pose.begin());
  return pose;
}

LoopEquations loop_equations(const Mechanism& unit, const State& state) {
  const PlatformPose pose = pose_of(state);
  const auto rows = 6 * static_cast<Index>(unit.limbs.size());
  LoopEquations made{Eigen::MatrixXd::Zero(rows, state.size()), Eigen::VectorXd(rows)};
  const Transform wanted = platform_transform(unit, pose);
  const lie::Matrix6<double> by_pose = platform_columns(unit, pose);
  Index row = 0;
  Index begin = 0;
  for (const Limb& limb : unit.limbs) {
    const auto moving = static_cast<Index>(limb.moving());
    Columns columns(6, moving);
    const Transform g = limb_transform(limb, {state.data() + begin, limb.moving()}, &columns);
    made.columns.block(row, begin, 6, moving) = columns;
    made.columns.block<6, 6>(row, state.size() - 6) = -by_pose;
    made.residual.segment<6>(row) = lie::log(wanted * g.inverse());
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
