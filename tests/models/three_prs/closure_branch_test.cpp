#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/models/three_prs/closure_samples.h"

// Tests solves at steep poses that converge to another root than the one that continues from zero error.

namespace poesy::three_prs {
namespace {

constexpr double kSteepest = 1.2;  // rad

/// Poses tilted by up to 69 deg that the rods reach and that are not singular to rounding.
std::vector<std::vector<double>> steep_poses(std::size_t count) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> tilt(-kSteepest, kSteepest);
  std::vector<std::vector<double>> poses;
  while (poses.size() < count) {
    const std::vector<double> pose{tilt(engine), tilt(engine), 0.75};
    const Configuration nominal = configuration_at({}, pose);
    bool reached = true;
    for (const LimbConfiguration& limb : nominal.limbs) reached = reached && std::isfinite(limb.q);
    if (reached && condition({}, nominal) < 1e6) poses.push_back(pose);
  }
  return poses;
}

/// The sample with all its errors multiplied by `share`.
ClosureSamples scaled(ClosureSamples sample, double share) {
  for (double& value : sample.values) value *= share;
  return sample;
}

/// The platform motion that is followed from zero error in steps. None if a step does not converge or is too large.
std::optional<PlatformMotion> continued(const ClosureSamples& sample) {
  constexpr int kSteps = 200;
  constexpr double kLeap = 0.3;  // rad or m in a step
  PlatformMotion motion{lie::Matrix3<double>::Identity(), lie::Vector3<double>::Zero()};
  for (int step = 1; step <= kSteps; ++step) {
    const PlatformMotion before = motion;
    const ClosureSamples part = scaled(sample, static_cast<double>(step) / kSteps);
    const auto limbs = limbs_of_sample(part.geometry, part.nominal, part.block(), 0);
    if (!solved(close_limbs(limbs, part.nominal.platform.p, 0.0, {}, motion).status)) return std::nullopt;
    if (lie::log(lie::Matrix3<double>(motion.E * before.E.transpose())).norm() > kLeap) return std::nullopt;
    if ((motion.dr - before.dr).norm() > kLeap) return std::nullopt;
  }
  return motion;
}

TEST(ClosureBranch, ARootOnTheOtherSideOfASingularPoseIsNotSolved) {
  constexpr double kSize = 0.01;
  constexpr std::size_t kSamples = 4;
  std::mt19937_64 engine(17);
  std::size_t beyond = 0, alike = 0, same = 0;
  for (const std::vector<double>& pose : steep_poses(500)) {
    const ClosureSamples samples = all_varied(pose, kSize, kSamples, engine);
    const ClosureOutcome found = solve(samples, {});
    const ClosureOutcome reference = solve_by_reference(samples, {});
    const ClosureStart start(samples.geometry, samples.nominal);
    for (std::size_t b = 0; b < kSamples; ++b) {
      const std::array<std::size_t, 1> position{b};
      const ClosureSamples sample = picked(samples, position);
      const auto limbs = limbs_of_sample(sample.geometry, sample.nominal, sample.block(), 0);
      PlatformMotion any_root = start(limbs);
      if (!solved(close_limbs(limbs, sample.nominal.platform.p, 0.0, {}, any_root).status)) continue;
      const auto branch = continued(sample);
      const bool on_branch =
          branch && (branch->E - any_root.E).norm() < 1e-6 && (branch->dr - any_root.dr).norm() < 1e-6;
      const bool marked = found.status[b] == SolveStatus::singular;
      ASSERT_TRUE(!on_branch || solved(found.status[b])) << "a root on the branch is never marked";
      // If a solve does not converge directly, rounding decides which root it finds. So only equal motions are
      // compared.
      if ((reference.motion(b) - found.motion(b)).norm() < 1e-9) {
        ASSERT_EQ(reference.status[b] == SolveStatus::singular, marked) << "alone as in a block";
        alike += marked ? 1 : 0;
      }
      same += on_branch ? 1 : 0;
      beyond += marked ? 1 : 0;
    }
  }
  EXPECT_GT(beyond, 10u);
  EXPECT_GT(alike, 10u);
  EXPECT_GT(same, 1000u);
}

}  // namespace
}  // namespace poesy::three_prs
