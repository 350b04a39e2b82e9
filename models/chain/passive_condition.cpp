#include "models/chain/passive_condition.h"

#include <limits>

#include "engine/base/contract.h"
#include "engine/linalg/decompositions.h"

namespace poesy::chain {
namespace {

/// The screw of a joint, with lengths in units of the chain's reach.
lie::Screw<double> in_reaches(const lie::Screw<double>& spatial, double reach) {
  const bool prismatic = spatial.head<3>().isZero(0.0);
  lie::Screw<double> scaled = spatial;
  if (!prismatic) scaled.tail<3>() /= reach;
  return scaled;
}

/// The dimensionless Jacobian J of Du et al. 2022, Eq. 43. A motion of limb i enters pair (k, i) with the sign +, and a
/// motion of limb k with the sign -.
Eigen::MatrixXd passive_jacobian(const ParallelChain& chain, std::span<const double> displacements) {
  const double reach = chain.reach();
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(chain.pairs.size()),
                                                   static_cast<Eigen::Index>(chain.passive_joints()));
  std::size_t joint = 0;
  Eigen::Index column = 0;
  const auto add = [&](std::size_t limb, const lie::Screw<double>& spatial) {
    const lie::Screw<double> scaled = in_reaches(spatial, reach);
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

}  // namespace

double passive_condition(const ParallelChain& chain, std::span<const double> displacements) {
  POESY_EXPECTS(displacements.size() == chain.joints());
  const Eigen::VectorXd values = linalg::singular_values(passive_jacobian(chain, displacements));
  const double rounding = static_cast<double>(values.size()) * std::numeric_limits<double>::epsilon();
  const double largest = values[0];
  const double smallest = values[values.size() - 1 - static_cast<Eigen::Index>(chain.idle)];
  return smallest > rounding * largest ? largest / smallest : std::numeric_limits<double>::infinity();
}

}  // namespace poesy::chain
