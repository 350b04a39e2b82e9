#include "engine/kinds/sensitivity/separation.h"
#include "engine/kinds/sensitivity/result.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/fake_model.h"

namespace poesy {
namespace {

/// All lengths grow with -z, which is 1, 2, ... at the poses below; delta_2 has no effect.
class SeparatingModel final : public test::FakeModel {
 public:
  Separation separation(std::span<const double> pose) const override {
    const double s = -pose[0];
    return {{3.0 * s, 0.0, 0.0}, {1.0 * s, 2.0 * s, 0.0}, {4.0 * s, 2.0 * s, 1e-12}, {1.0 * s, 2.0 * s, 1e-12}};
  }
};

const std::vector<FactorIndex> kFactors{FactorIndex(1), FactorIndex(0), FactorIndex(2)};

SeparationResult separated(const std::vector<double>& heights, const std::vector<double>& sigma) {
  std::vector<double> coordinates;
  for (const double height : heights) coordinates.insert(coordinates.end(), {-height, 0.0, 0.0});
  return separate_errors(SeparatingModel(), PoseSet(3, coordinates), kFactors, sigma);
}

TEST(Separation, KeepsEveryPoseOfTheStudysErrors) {
  const SeparationResult found = separated({1.0, 2.0}, {1.0, 1.0, 1.0});
  EXPECT_EQ(found.drive, (std::vector<double>{0, 0, 3, 6, 0, 0}));
  EXPECT_EQ(found.constraint, (std::vector<double>{2, 4, 1, 2, 0, 0}));
  EXPECT_EQ(found.effect, (std::vector<double>{2, 4, 4, 8, 1e-12, 1e-12}));
  EXPECT_EQ(found.residual, (std::vector<double>{2, 4, 1, 2, 1e-12, 1e-12}));
  const std::vector<double> local(found.removable_local.begin(), found.removable_local.begin() + 4);
  EXPECT_EQ(local, (std::vector<double>{0, 0, 0.75, 0.75}));
  EXPECT_TRUE(std::isnan(found.removable_local[4]) && std::isnan(found.removable_local[5]));
}

TEST(Separation, SharesOverTheWorkspace) {
  const SeparationResult found = separated({1.0, 2.0, 7.0}, {1.0, 1.0, 1.0});
  EXPECT_EQ(found.drive_share[0], 0.0);
  EXPECT_NEAR(found.drive_share[1], 0.75, 1e-15);
  EXPECT_EQ(found.removable[0], 0.0);
  EXPECT_NEAR(found.removable[1], 0.75, 1e-15);
  EXPECT_TRUE(std::isnan(found.drive_share[2]) && std::isnan(found.removable[2]));
}

TEST(Separation, TogetherBySigma) {
  const auto together = [](double epsilon, double delta) {
    return separated({1.0}, {epsilon, delta, 0.0}).removable_together;
  };
  EXPECT_EQ(together(1.0, 0.0), 0.0);
  EXPECT_NEAR(together(0.0, 1e-3), 0.75, 1e-15);
  EXPECT_NEAR(together(0.5, 0.25), 1.0 - std::sqrt(1.0 + 0.0625) / std::sqrt(1.0 + 1.0), 1e-15);
  EXPECT_TRUE(std::isnan(together(0.0, 0.0)));
}

TEST(Separation, SingularPoseLeavesSharesOpen) {
  const SeparationResult found = separated({1.0, std::numeric_limits<double>::infinity()}, {1.0, 1.0, 1.0});
  EXPECT_NEAR(found.removable_local[2], 0.75, 1e-15);
  EXPECT_TRUE(std::isnan(found.removable_local[3]) && std::isnan(found.removable[1]));
  EXPECT_TRUE(std::isnan(found.drive_share[1]) && std::isnan(found.removable_together));
}

}  // namespace
}  // namespace poesy
