#pragma once

#include <span>
#include <vector>

#include "models/chain/limb.h"
#include "tests/models/chain/random_chain.h"

namespace poesy::chain {

enum class PassiveJoints { revolute, mixed };

/// A chain of random limbs with these numbers of joints, one of them actuated in each limb. The last frames of the
/// limbs are chosen so that the platform frames coincide at the displacements q [all joints]. Neighbouring limbs form
/// the pairs.
inline ParallelChain closed_chain(std::span<const std::size_t> joints, PassiveJoints kind, std::span<const double> q,
                                  std::mt19937_64& engine) {
  ParallelChain chain;
  const lie::Transform<double> platform = lie::exp(lie::random_screw(0.5, engine));
  const std::size_t limbs = joints.size();
  std::size_t first = 0;
  for (std::size_t i = 0; i < limbs; ++i) {
    Limb limb = random_limb(joints[i], engine);
    for (Joint& joint : limb.joints) {
      if (kind == PassiveJoints::revolute) joint.type = JointType::revolute;
      joint.actuated = false;
    }
    limb.joints[i % joints[i]].actuated = true;
    limb.home.back() = lie::Transform<double>{};
    limb.home.back() = platform_pose(limb, limb.home, q.subspan(first, joints[i])).inverse() * platform;
    chain.limbs.push_back(limb);
    first += joints[i];
  }
  for (std::size_t i = 0; i < limbs && (limbs > 2 || i == 0); ++i) chain.pairs.push_back({(i + 1) % limbs, i});
  return chain;
}

/// [6 pairs] The residual of all pairs, computed from the definition.
inline Eigen::VectorXd residual(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                                std::span<const double> q) {
  std::vector<lie::Transform<double>> poses;
  std::size_t frame = 0;
  std::size_t joint = 0;
  for (const Limb& limb : chain.limbs) {
    poses.push_back(platform_pose(limb, frames.subspan(frame, limb.frames()), q.subspan(joint, limb.joints.size())));
    frame += limb.frames();
    joint += limb.joints.size();
  }
  Eigen::VectorXd all(6 * static_cast<Eigen::Index>(chain.pairs.size()));
  for (std::size_t n = 0; n < chain.pairs.size(); ++n) {
    all.segment<6>(6 * static_cast<Eigen::Index>(n)) =
        lie::log(poses[chain.pairs[n].k] * poses[chain.pairs[n].i].inverse());
  }
  return all;
}

/// The matrix J of Du et al. 2022, Eq. 43, by its definition: the spatial screw of a passive joint counts in pair (k,
/// i) with +1 if it is in limb i and with -1 if it is in limb k.
inline Eigen::MatrixXd jacobian(const ParallelChain& chain, std::span<const lie::Transform<double>> frames,
                                std::vector<double> q) {
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(chain.pairs.size()),
                                            static_cast<Eigen::Index>(chain.passive_joints()));
  std::size_t frame = 0;
  std::size_t joint = 0;
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < chain.limbs.size(); ++i) {
    const Limb& limb = chain.limbs[i];
    const auto own = frames.subspan(frame, limb.frames());
    for (std::size_t k = 0; k < limb.joints.size(); ++k) {
      if (limb.joints[k].actuated) continue;
      const double h = 1e-5;
      const double at = q[joint + k];
      const auto pose_at = [&](double value) {
        q[joint + k] = value;
        return platform_pose(limb, own, std::span<const double>(q).subspan(joint, limb.joints.size()));
      };
      const lie::Screw<double> motion = lie::log(pose_at(at + h) * pose_at(at - h).inverse()) / (2 * h);
      q[joint + k] = at;
      for (std::size_t n = 0; n < chain.pairs.size(); ++n) {
        const auto row = 6 * static_cast<Eigen::Index>(n);
        if (chain.pairs[n].i == i) j.block<6, 1>(row, column) += motion;
        if (chain.pairs[n].k == i) j.block<6, 1>(row, column) -= motion;
      }
      ++column;
    }
    frame += limb.frames();
    joint += limb.joints.size();
  }
  return j;
}

}  // namespace poesy::chain
