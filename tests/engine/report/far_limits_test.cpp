#include "engine/report/far_limits.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace poesy {
namespace {

constexpr double kRms = 2e-5;

/// The notes for two limits: `within` of 100 draws keep the first one, and half of them the second one, which is near.
std::vector<std::string> notes(double limit, std::uint64_t within, double rms = kRms) {
  StoredResult result;
  result.responses = {{"tip", "m"}, {"turn", "rad"}};
  result.verdicts.emplace().limits = {{.response = 0, .limit = limit, .tried = 100, .within = within},
                                      {.response = 1, .limit = rms, .tried = 100, .within = 50}};
  return far_limit_notes(
      result, [&](std::size_t) { return rms; }, "root mean square");
}

using Notes = std::vector<std::string>;

TEST(FarLimits, AreThoseThatAllKeepByFar) {
  EXPECT_EQ(notes(31.0 * kRms, 100),
            (Notes{"The limit of tip is 31 times its root mean square: look at the units of limits and sigmas"}));
  EXPECT_EQ(notes(29.0 * kRms, 100), Notes{});
  EXPECT_EQ(notes(31.0 * kRms, 99), Notes{});
}

TEST(FarLimits, AreThoseThatNoneKeepsByFar) {
  EXPECT_EQ(notes(kRms / 31.0, 0),
            (Notes{"The root mean square of tip is 31 times its limit: look at the units of limits and sigmas"}));
  EXPECT_EQ(notes(kRms / 31.0, 1), Notes{});
}

TEST(FarLimits, AreNotSoughtAgainstNothing) {
  EXPECT_EQ(notes(1e-3, 100, 0.0), Notes{});
  EXPECT_EQ(notes(1e-3, 100, 1e-15), Notes{});  // zero up to rounding
  EXPECT_EQ(notes(1e-3, 100, std::numeric_limits<double>::quiet_NaN()), Notes{});
  EXPECT_EQ(far_limit_notes({}, nullptr, ""), Notes{});
}

}  // namespace
}  // namespace poesy
