#include "engine/kinds/allocation/drawn_part.h"

#include <gtest/gtest.h>

#include <vector>

namespace poesy::allocation {
namespace {

TEST(SpreadOfErrors, IsTheToleranceOverTheSigmas) {
  EXPECT_DOUBLE_EQ(sigma_per_tolerance({3.0}), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(mean_square_per_tolerance({3.0}), 1.0 / 9.0);
}

TEST(SpreadOfErrors, WithAShiftHasWhatTheShiftLeaves) {
  // Cpk = (T - shift T) / (3 sigma), by its definition.
  const Spread spread{3.0 * 1.5, 0.25};
  const double sigma = sigma_per_tolerance(spread);
  EXPECT_DOUBLE_EQ((1.0 - 0.25) / (3.0 * sigma), 1.5);
  EXPECT_DOUBLE_EQ(mean_square_per_tolerance(spread), sigma * sigma + 0.0625);
}

TEST(PartsOfADrawing, HaveTheEffectsOfTheirErrors) {
  const std::vector<double> effects{1.0, 2.0, 4.0, 0.5, 0.0, 0.25};  // [limits x errors], two limits and three errors
  const auto square = [](double sigmas) { return mean_square_per_tolerance({sigmas}); };
  const std::vector<DrawnPart> parts{{{{{0, 2}, square(2.0)}}}, {{{{1}, square(3.0)}}}};
  EXPECT_EQ(part_effects(effects, 3, parts),
            (std::vector{5.0 / 4.0, 2.0 * (1.0 / 3.0) * (1.0 / 3.0), 0.75 / 4.0, 0.0}));
}

TEST(PartsOfADrawing, MayLeaveMoreToOtherErrorsTheFinerTheyAre) {
  const std::vector<DrawnPart> parts{{{{{0}, 0.25}}}, {{{{1, 2}, 1.0}, {{0}, -0.25}}}};
  EXPECT_EQ(part_effects(std::vector{4.0, 0.5, 0.125}, 3, parts), (std::vector{1.0, 0.625 - 1.0}));
}

}  // namespace
}  // namespace poesy::allocation
