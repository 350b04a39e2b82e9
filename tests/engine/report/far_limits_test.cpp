#include "engine/report/far_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace poesy {
namespace {

constexpr double kRms = 2e-5;

/// The notes for one limit, where `within` of 100 draws are within it, or where `rejects` of 100 machines are rejects.
std::vector<std::string> notes(double limit, std::uint64_t within, std::optional<std::uint64_t> rejects = {},
                               double rms = kRms) {
  StoredResult result;
  result.responses = {{"tip", "m"}};
  LimitVerdicts& verdicts = result.verdicts.emplace();
  verdicts.limits = {{.response = 0, .limit = limit, .tried = 100, .within = within}};
  if (rejects) {
    verdicts.yield.emplace();
    verdicts.yield->machines = 100;
    verdicts.yield->rejects = *rejects;
  }
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

/// With a yield, machines count, and not the draws within one limit.
TEST(FarLimits, AreJudgedByMachinesWhereThereIsAYield) {
  EXPECT_EQ(notes(31.0 * kRms, 100, 0).size(), 1U);
  EXPECT_EQ(notes(31.0 * kRms, 100, 1), Notes{});
  EXPECT_EQ(notes(kRms / 31.0, 50, 100).size(), 1U);
}

TEST(FarLimits, AreNotSoughtAgainstNothing) {
  EXPECT_EQ(notes(1e-3, 100, {}, 0.0), Notes{});
  EXPECT_EQ(notes(1e-3, 100, {}, 1e-15), Notes{});  // zero up to rounding
  EXPECT_EQ(notes(1e-3, 100, {}, std::numeric_limits<double>::quiet_NaN()), Notes{});
  EXPECT_EQ(far_limit_notes({}, nullptr, ""), Notes{});
}

}  // namespace
}  // namespace poesy
