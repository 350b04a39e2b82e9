#include "models/chain/passive_condition.h"

#include <limits>

#include "engine/base/contract.h"
#include "engine/linalg/decompositions.h"

namespace poesy::chain {
namespace {

/// A joint's screw with lengths in units of the reach.
lie::Screw<double> in_reaches(const lie::Screw<double>& spatial, double reach) {
  const bool prismatic = spatial.head<3>().isZero(0.0);
  lie::Screw<double> scaled = spatial;
  if (!prismatic) scaled.tail<3>() /= reach;
  return scaled;
}

/// J of Eq. 43 with the screws column_of the passive joints. A motion of limb i enters pair (k, i) with +, one of limb
/// k with -.
template <class ColumnOf>
Eigen::MatrixXd passive_jacobian(const ParallelChain& chain, std::span<const double> displacements,
                                 ColumnOf&& column_of) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(chain.pairs.size()),
                                                   static_cast<Eigen::Index>(chain.passive_joints()));
  std::size_t joint = 0;
  Eigen::Index column = 0;
  const auto add = [&](std::size_t limb, const lie::Screw<double>& spatial) {
    const lie::Screw<double> scaled = column_of(spatial);
    for (std::size_t n = 0; n < chain.pairs.size(); ++n) {
      const auto row = 6 * static_cast<Eigen::Index>(n);
      if (chain.pairs[n].i == limb) jacobian.block<6, 1>(row, column) += scaled;
      if (chain.pairs[n].k == limb) jacobian.block<6, 1>(row, column) -= scaled;
    }
    ++column;
  };
  for (std::size_t i = 0; i < chain.limbs.size(); ++i) {
    const Limb& limb = chain.limbs[i];
    const std::size_t joints = limb.joints.size();
    forward_kinematics<double>(limb, limb.home, displacements.subspan(joint, joints),
                               [&](std::size_t, const lie::Screw<double>& spatial) { add(i, spatial); });
    joint += joints;
  }
  return jacobian;
}

/// The published J, dimensionless.
Eigen::MatrixXd jacobian_in_reaches(const ParallelChain& chain, std::span<const double> displacements) {
  const double reach = chain.reach();
  return passive_jacobian(chain, displacements,
                          [&](const lie::Screw<double>& spatial) { return in_reaches(spatial, reach); });
}

/// W^(1/2) J with columns of length 1.
Eigen::MatrixXd jacobian_by(const Metric& metric, const ParallelChain& chain, std::span<const double> displacements) {
  const lie::Matrix6<double> root = linalg::cholesky_root(metric.W);
  Eigen::MatrixXd jacobian = passive_jacobian(
      chain, displacements, [&](const lie::Screw<double>& spatial) -> lie::Screw<double> { return root * spatial; });
  jacobian.colwise().normalize();
  return jacobian;
}

}  // namespace

double passive_condition(const ParallelChain& chain, std::span<const double> displacements, const Metric* metric) {
  POESY_EXPECTS(displacements.size() == chain.joints());
  const Eigen::VectorXd values = linalg::singular_values(
      metric == nullptr ? jacobian_in_reaches(chain, displacements) : jacobian_by(*metric, chain, displacements));
  const double rounding = static_cast<double>(values.size()) * std::numeric_limits<double>::epsilon();
  const double largest = values[0];
  const double smallest = values[values.size() - 1 - static_cast<Eigen::Index>(chain.idle)];
  return smallest > rounding * largest ? largest / smallest : std::numeric_limits<double>::infinity();
}

}  // namespace poesy::chain
