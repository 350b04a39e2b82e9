#include "models/chain/nominal.h"

#include <Eigen/Core>

#include "engine/base/contract.h"
#include "models/chain/deformation_solver.h"
#include "models/chain/platform_motion.h"

namespace poesy::chain {
namespace {

using Transform = lie::Transform<double>;

/// Number of solves. The second solve begins at the result of the first, so that its own result is accurate to
/// rounding.
constexpr int kSolves = 2;
constexpr double kTolerance = 1e-14;  ///< tolerance of a solve (rad, m)
/// Number of Newton steps for the pose of the platform. Each step multiplies the remaining error by a number about as
/// large as the mismatch (rad).
constexpr int kSteps = 8;

std::vector<Transform> frames_of(const ParallelChain& chain) {
  std::vector<Transform> frames;
  for (const Limb& limb : chain.limbs) frames.insert(frames.end(), limb.home.begin(), limb.home.end());
  return frames;
}

/// [limbs] The platform poses of all limbs.
std::vector<Transform> platforms(const ParallelChain& chain, std::span<const double> displacements) {
  POESY_EXPECTS(displacements.size() == chain.joints());
  std::vector<Transform> list;
  for (const Limb& limb : chain.limbs) {
    const std::size_t joints = limb.joints.size();
    list.push_back(forward_kinematics<double>(limb, limb.home, displacements.first(joints),
                                              [](std::size_t, const lie::Screw<double>&) {}));
    displacements = displacements.subspan(joints);
  }
  return list;
}

}  // namespace

std::vector<double> settled(const ParallelChain& chain, std::vector<double> displacements) {
  const std::vector<Transform> frames = frames_of(chain);
  std::vector<double> delta_mu(6 * chain.pairs.size());
  SolverOptions options;
  options.tolerance = kTolerance;
  DeformationSolver solver(chain, options);
  for (int n = 0; n < kSolves; ++n) {
    std::vector<double> end = displacements;
    const Deformation found = solver.solve(frames, end, delta_mu);
    if (!solved(found.status)) return displacements;
    displacements = std::move(end);
  }
  return displacements;
}

Transform mean_platform(const ParallelChain& chain, std::span<const double> displacements) {
  const std::vector<Transform> frames = frames_of(chain);
  Transform mean = platforms(chain, displacements).front();
  for (int n = 0; n < kSteps; ++n) mean = lie::exp(mean_motion(chain, frames, displacements, mean)) * mean;
  return mean;
}

std::vector<lie::Screw<double>> nominal_motions(const ParallelChain& chain, std::span<const double> displacements) {
  const Transform mean = mean_platform(chain, displacements);
  std::vector<lie::Screw<double>> motions;
  for (const Transform& platform : platforms(chain, displacements)) {
    motions.push_back(lie::log(platform * mean.inverse()));
  }
  return motions;
}

std::vector<double> nominal_mismatch(const ParallelChain& chain, std::span<const double> displacements) {
  const std::vector<Transform> poses = platforms(chain, displacements);
  std::vector<double> delta_mu;
  for (const LimbPair& pair : chain.pairs) {
    const lie::Screw<double> screw = lie::log(poses[pair.k] * poses[pair.i].inverse());
    delta_mu.insert(delta_mu.end(), screw.begin(), screw.end());
  }
  return delta_mu;
}

}  // namespace poesy::chain
