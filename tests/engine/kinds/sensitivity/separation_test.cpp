#include "engine/kinds/sensitivity/separation.h"
#include "engine/kinds/sensitivity/result.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/fake_model.h"

namespace poesy::sensitivity {
namespace {

/// A model whose separation is proportional to s = -z, the height that the tests choose. delta_2 has no effect.
class SeparatingModel final : public test::FakeModel {
 public:
  SeparatingModel() { described_.separation = {"how far the platform moves", {"compensable", "", "non-compensable"}}; }

  const ModelDescription& description() const override { return described_; }
  Separation separation(std::span<const double> pose) const override {
    const double s = -pose[0];
    return {{3.0 * s, 0.0, 0.0}, {1.0 * s, 2.0 * s, 0.0}, {4.0 * s, 2.0 * s, 1e-12}, {1.0 * s, 2.0 * s, 1e-12}};
  }

 private:
  ModelDescription described_ = describe();
};

const std::vector<FactorIndex> kFactors{FactorIndex(1), FactorIndex(0), FactorIndex(2)};

SeparationResult separated(const std::vector<double>& heights, const std::vector<double>& sigma) {
  std::vector<double> coordinates;
  for (const double height : heights) coordinates.insert(coordinates.end(), {-height, 0.0, 0.0});
  return separate_errors(SeparatingModel(), PoseSet(3, coordinates), kFactors, sigma);
}

TEST(Separation, KeepsEveryPoseOfTheStudysErrors) {
  const SeparationResult found = separated({1.0, 2.0}, {1.0, 1.0, 1.0});
  using Cells = SeparationResult::Cells;
  EXPECT_EQ(found.drive, Cells({3, 2}, {0, 0, 3, 6, 0, 0}));
  EXPECT_EQ(found.constraint, Cells({3, 2}, {2, 4, 1, 2, 0, 0}));
  EXPECT_EQ(found.effect, Cells({3, 2}, {2, 4, 4, 8, 1e-12, 1e-12}));
  EXPECT_EQ(found.residual, Cells({3, 2}, {2, 4, 1, 2, 1e-12, 1e-12}));
  for (const std::size_t m : {0U, 1U}) {
    EXPECT_EQ(found.removable_local(0, m), 0.0);
    EXPECT_EQ(found.removable_local(1, m), 0.75);
    EXPECT_TRUE(std::isnan(found.removable_local(2, m)));
  }
  EXPECT_EQ(found.measure, "how far the platform moves");
  const std::vector<std::string> published{"", "compensable", "non-compensable"};
  EXPECT_TRUE(std::ranges::equal(found.published, published));
}

TEST(Separation, SharesOverTheWorkspace) {
  const SeparationResult found = separated({1.0, 2.0, 7.0}, {1.0, 1.0, 1.0});
  EXPECT_EQ(found.drive_share(0), 0.0);
  EXPECT_NEAR(found.drive_share(1), 0.75, 1e-15);
  EXPECT_EQ(found.removable(0), 0.0);
  EXPECT_NEAR(found.removable(1), 0.75, 1e-15);
  EXPECT_TRUE(std::isnan(found.drive_share(2)) && std::isnan(found.removable(2)));
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
  EXPECT_NEAR(found.removable_local(1, 0), 0.75, 1e-15);
  EXPECT_TRUE(std::isnan(found.removable_local(1, 1)) && std::isnan(found.removable(1)));
  EXPECT_TRUE(std::isnan(found.drive_share(1)) && std::isnan(found.removable_together));
}

}  // namespace
}  // namespace poesy::sensitivity
