// Allocation studies of functions for which the optimal tolerances are known.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/kinds/allocation/kind.h"
#include "engine/kinds/allocation/mean_squares.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/search.h"
#include "engine/kinds/study_run.h"
#include "engine/random/normal_quantile.h"
#include "engine/stats/proportion.h"
#include "tests/engine/kinds/allocation/function_allocation.h"

namespace poesy::test {
namespace {

/// The contact angle of the overrunning clutch minus its nominal value (rad). The errors x are numbers in mm, although
/// the model declares them as m.
void clutch(std::span<const double> x, double, std::span<double> y) {
  const double rollers = 0.5 * (22.86 + x[1] + 22.86 + x[2]);
  const double nominal = std::acos((55.29 + 22.86) / (101.60 - 22.86));
  y[0] = std::acos((55.29 + x[0] + rollers) / (101.60 + x[3] - rollers)) - nominal;
}

/// Each part has the manufacturing processes of the literature. If `fixed` is given, part i has the cost of process
/// fixed[i] (from 1) without bounds.
FunctionStudy clutch_study(std::size_t machines, std::vector<std::size_t> fixed = {}) {
  FunctionStudy study(4, clutch, 0.035, machines);
  struct Range {
    double a, b, lo, hi;
  };
  const std::vector<std::vector<Range>> processes{{{10, .015, .015, .08}, {5, .5, .06, .15}, {3.5, .75, .12, .25}},
                                                  {{8, .25, .02, .15}, {3, .65, .08, .30}},
                                                  {{2.5, .3, .04, .20}, {5, .045, .12, .25}},
                                                  {{4, .56, .08, .12}, {6, .16, .15, .25}, {.5, .88, .2, .4}}};
  for (std::size_t i = 0; i < processes.size(); ++i) {
    allocation::AllocatedPart part = part_of(i, {});
    if (fixed.empty()) {
      part.choice = allocation::AllocatedPart::Choice::processes;
      for (const Range& one : processes[i]) {
        part.processes.push_back({std::to_string(part.processes.size() + 1), reciprocal(one.a, one.b), one.lo, one.hi});
      }
    } else {
      const Range& one = processes[i][fixed[i] - 1];
      part.cost = reciprocal(one.a, one.b);
    }
    study.asked().parts.push_back(part);
  }
  return study;
}

// y = 3 x0 + 4 x1 + 5 x3 + x4. The first part has the errors x0, x1 and x2 with the same variance, so their shares are
// as 9 : 16 : 0.
TEST(SharesWithinAPart, AreThoseOfItsErrors) {
  const auto linear = [](std::span<const double> x, double, std::span<double> y) {
    y[0] = 3.0 * x[0] + 4.0 * x[1] + 5.0 * x[3] + x[4];
  };
  FunctionStudy study(5, linear, 0.05, 2000);
  allocation::AllocatedPart joined = part_of(0, reciprocal(0.0, 1.0));
  joined.factors = {FactorIndex(0), FactorIndex(1), FactorIndex(2)};
  study.asked().parts = {joined, part_of(3, reciprocal(0.0, 2.0))};
  study.study.errors.by_factor[4] = Distribution::normal(1e-4);  // an error of no part
  const allocation::Result found = study.find();
  const auto& shares = found.error_mean_square_share;
  ASSERT_EQ(shares.size(), 5u);
  const double of_part = found.mean_square_share(0);
  EXPECT_GT(of_part, 0.1);
  EXPECT_NEAR(shares(0), of_part * 9.0 / 25.0, 1e-9);
  EXPECT_NEAR(shares(1), of_part * 16.0 / 25.0, 1e-9);
  EXPECT_NEAR(shares(2), 0.0, 1e-12);
  EXPECT_NEAR(shares(3), found.mean_square_share(1), 1e-12);
  EXPECT_TRUE(std::isnan(shares(4)));
}

TEST(SharesWithinALimit, StateWhatIsInNoPart) {
  const auto linear = [](std::span<const double> x, double, std::span<double> y) {
    y[0] = 3.0 * x[0] + 4.0 * x[1] + 2.0 * x[2];
  };
  FunctionStudy study(3, linear, 0.05, 2000);
  study.asked().parts = {part_of(0, reciprocal(0.0, 1.0)), part_of(1, reciprocal(0.0, 2.0))};
  study.study.errors.by_factor[2] = Distribution::normal(2e-3);  // an error of no part
  const allocation::Result found = study.find();
  const double fixed = std::pow(2.0 * 2e-3, 2);
  const double of_parts = std::pow(3.0 * found.sigma(0), 2) + std::pow(4.0 * found.sigma(1), 2);
  EXPECT_NEAR(found.fixed_share(0), fixed / (fixed + of_parts), 1e-9);
  study.study.errors.by_factor[2] = Distribution::normal(1e-12);
  EXPECT_LT(study.find().fixed_share(0), 1e-12);
}

TEST(OverrunningClutch, HasTheLeastCostOfTheLiterature) {
  const allocation::Result found = clutch_study(148'000).find();
  const allocation::AllocationStage& linear = found.stages.front();
  EXPECT_NEAR(linear.cost, 24.462426, 3e-6);
  EXPECT_LE(linear.lower_bound, linear.cost);
  EXPECT_GT(linear.lower_bound, linear.cost * (1.0 - 1e-6));
  const std::vector<double> best{.173842, .166160, .128409, .200000};  // by processes 3, 2, 1 and 3
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found.stage_tolerance(0, i), best[i], 1e-6) << i;
}

TEST(OverrunningClutch, HasTheLeastCostWithoutBounds) {
  const allocation::Result found = clutch_study(2000, {3, 2, 1, 3}).find();
  EXPECT_NEAR(found.stages.front().cost, 24.42989011, 3e-6);
  const std::vector<double> best{.17859228, .17069998, .13191761, .18931314};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found.stage_tolerance(0, i), best[i], 1e-7) << i;
}

// The yield at the linear model's tolerances is 0.99486. The test allows 4.4 standard errors of n machines (alpha =
// 1e-5).
TEST(OverrunningClutch, IsRepairedByItsMachines) {
  const allocation::Result found = clutch_study(148'000).find();
  const auto tried = std::ranges::find(found.stages, "tried on machines", &allocation::AllocationStage::name);
  ASSERT_NE(tried, found.stages.end());
  const double n = static_cast<double>(tried->machines);
  EXPECT_NEAR(static_cast<double>(tried->rejects) / n, 1.0 - 0.99486, 4.4 * std::sqrt(0.00514 / n) + 5e-6);
  EXPECT_TRUE(found.certified());
  EXPECT_GT(found.total_cost, 24.462426);
  EXPECT_LT(found.total_cost, 1.1 * 24.462426);
  EXPECT_LE(found.design_rejects, found.design_most);
}

// Each certificate holds with a probability of 99 %. Then the probability that fewer than 18 of 20 hold is 1e-3.
TEST(OverrunningClutch, IsCertifiedWithOtherSeedsToo) {
  const FunctionStudy study = clutch_study(148'000);
  Study confirming = *study.run().confirming;
  int holds = 0;
  for (int other = 0; other < 20; ++other) {
    ++confirming.seed;
    const auto repeated = run_study(confirming, study.model, PoseSet(1, {0.5}), {.threads = 2});
    if (repeated->verdicts->yield->decision == YieldVerdict::Decision::kept) ++holds;
  }
  EXPECT_GE(holds, 18);
}

TEST(OverrunningClutch, AnyPartMadeCoarserAloneBreaksTheYield) {
  const allocation::Result found = clutch_study(148'000).find();
  const double most = 1.0 - static_cast<double>(found.design_most) / static_cast<double>(found.design_machines);
  std::size_t judged = 0;
  for (std::size_t i = 0; i < found.parts(); ++i) {
    if (std::isnan(found.coarser_yield(i))) continue;
    EXPECT_LT(found.coarser_yield(i), most) << found.part_names[i];
    ++judged;
  }
  EXPECT_GE(judged, 2u);
}

// The minimum of the cost sum b_i / t_i subject to sum g_i^2 t_i^2 = L^2 has t_i proportional to (b_i / g_i^2)^(1/3).
// Since the one response is normal, its yield depends only on this sum, so the same t_i are optimal for the yield.
TEST(ToleranceSearch, SharesALinearLimitAsTheClosedForm) {
  const FunctionStudy study = weighted_sum_study();
  const allocation::Result found = study.find();
  EXPECT_TRUE(found.certified());
  std::vector<double> best;
  double square = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    best.push_back(std::cbrt(kPrices[i] / (kCoefficients[i] * kCoefficients[i])));
    square += std::pow(kCoefficients[i] * best[i] / 3.0, 2);
  }
  // The allowed share of rejects of the design determines the standard deviation 1 / z of the response.
  const double share = static_cast<double>(found.design_most) / static_cast<double>(found.design_machines);
  const double z = -normal_quantile(1.0, 0.5 * share);
  double cost = 0.0;
  for (std::size_t i = 0; i < 3; ++i) cost += kPrices[i] / (best[i] / (z * std::sqrt(square)));
  EXPECT_NEAR(found.total_cost, cost, 0.01 * cost);
  double found_square = 0.0;
  for (std::size_t i = 0; i < 3; ++i) found_square += std::pow(kCoefficients[i] * found.sigma(i), 2);
  EXPECT_NEAR(std::sqrt(found_square), 1.0 / z, 0.01 / z);
}

// The design uses all rejects that it may have, so no part alone can be coarser, not even one with little effect.
TEST(ToleranceSearch, LeavesNoRejectUnused) {
  const allocation::Result found = weighted_sum_study().find();
  EXPECT_EQ(found.design_rejects, found.design_most);
  const double most = 1.0 - static_cast<double>(found.design_most) / static_cast<double>(found.design_machines);
  for (std::size_t i = 0; i < found.parts(); ++i) EXPECT_LT(found.coarser_yield(i), most) << found.part_names[i];
}

/// Number of parts that could be coarser without breaking the yield of the design.
std::size_t idle_parts(const allocation::Result& found) {
  const double most = 1.0 - static_cast<double>(found.design_most) / static_cast<double>(found.design_machines);
  return static_cast<std::size_t>(std::ranges::count_if(found.coarser_yield, [&](double one) { return one >= most; }));
}

// Each of thirty parts has about 2e-5 of the mean square, which is worth 0.003 of 310 rejects. If rejects were counted,
// noise would make half of these parts look as if they could be coarser.
TEST(ToleranceSearch, LeavesNoPartCoarserThatHardlyActs) {
  constexpr std::size_t kSmall = 30;
  const auto function = [](std::span<const double> x, double, std::span<double> y) {
    y[0] = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) y[0] += (i < 2 ? 1.0 : 0.01) * x[i];
  };
  FunctionStudy study(2 + kSmall, function, 0.3, 149'000);
  for (std::size_t i = 0; i < 2 + kSmall; ++i) {
    study.asked().parts.push_back(part_of(i, reciprocal(0.0, i < 2 ? 1.0 : 1e-5)));
  }
  const allocation::Result found = study.find();
  EXPECT_TRUE(found.certified());
  EXPECT_LT(found.mean_square_share.all().back(), 1e-4);
  EXPECT_EQ(idle_parts(found), 0u);
}

// The third part has no effect. The last scaling makes it finer together with the other parts; afterwards the search
// must return it to its upper bound.
TEST(ToleranceSearch, MakesAPartThatDoesNothingCoarse) {
  const auto function = [](std::span<const double> x, double, std::span<double> y) { y[0] = x[0] + x[1]; };
  std::size_t loosened = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    FunctionStudy study(3, function, 0.3, 20'000);
    study.study.seed = seed;
    study.asked().yield = 0.99;
    for (std::size_t i = 0; i < 3; ++i) study.asked().parts.push_back(part_of(i, reciprocal(0.0, 1.0)));
    study.asked().parts.back().hi = 0.7;
    const allocation::Result found = study.find();
    EXPECT_EQ(found.tolerance(2), 0.7);
    EXPECT_EQ(found.bound(2), allocation::Result::kWithoutEffect);
    EXPECT_EQ(idle_parts(found), 0u);
    EXPECT_EQ(found.design_rejects, found.design_most);
    if (found.stages.back().name == "coarser where nothing breaks") {
      ++loosened;
      EXPECT_LT(found.stages.back().cost, found.stages[found.stages.size() - 2].cost);
    }
  }
  EXPECT_GE(loosened, 1u);
}

// At the first pose, where the limit is tight, only the first part has an effect; at the second pose only the second.
TEST(ToleranceSearch, KnowsThatALimitWithRoomDependsOnAPart) {
  const auto function = [](std::span<const double> x, double place, std::span<double> y) {
    y[0] = place < 0.5 ? x[0] : 0.1 * x[1];
  };
  FunctionStudy study(2, function, 0.3, 20'000);
  for (std::size_t i = 0; i < 2; ++i) study.asked().parts.push_back(part_of(i, reciprocal(0.0, 1.0)));
  study.asked().parts.back().hi = 0.7;
  const allocation::Result found = study.run(2, {0.2, 0.8}).as<allocation::Result>();
  EXPECT_EQ(found.tolerance(1), 0.7);
  EXPECT_EQ(found.mean_square_share(1), 0.0);
  EXPECT_EQ(found.bound(1), static_cast<std::uint8_t>(AtBound::upper));
}

// y = x0 + x1 and z = 0.97 (x0 - x1) have the same limit 1. Both parts cost the same, so x0 and x1 are equally large,
// and y and z independent, with the standard deviations s and 0.97 s. The density at u of machines whose load is |y| is
// proportional to exp(-u^2 / 2 s^2) / s, times the probability of |z| < u, and that of |z| in the same way.
TEST(ToleranceSearch, DividesTheSavingByDecidingMachines) {
  constexpr double kSecond = 0.97;
  constexpr std::size_t kDrawn = 100'000;
  const auto sum_and_difference = [](std::span<const double> x, double, std::span<double> y) {
    y[0] = x[0] + x[1];
    y[1] = kSecond * (x[0] - x[1]);
  };
  FunctionStudy study(2, sum_and_difference, 1.0, kDrawn, {"y", "z"});
  study.asked().yield = 0.99;
  for (std::size_t i = 0; i < 2; ++i) study.asked().parts.push_back(part_of(i, reciprocal(0.0, 1.0)));
  const allocation::Result found = study.find();
  const double s = std::hypot(found.sigma(0), found.sigma(1));
  const auto near_limits = [](double own, double other) {  // the integral from 0.9 to 1.1 by the midpoint rule
    constexpr int kSteps = 1000;
    double sum = 0.0;
    for (int n = 0; n < kSteps; ++n) {
      const double u = 0.9 + 0.2 * (n + 0.5) / kSteps;
      sum += std::exp(-0.5 * u * u / (own * own)) / own * std::erf(u / (other * std::sqrt(2.0)));
    }
    return std::sqrt(2.0 / std::numbers::pi) * 0.2 * sum / kSteps;
  };
  const double by_y = near_limits(s, kSecond * s);
  const double by_z = near_limits(kSecond * s, s);
  const double share = by_z / (by_y + by_z);
  const double machines = kDrawn * (by_y + by_z);
  EXPECT_GT(share, 0.35);
  EXPECT_NEAR(found.deciding_share(1, 0), share, 4.0 * std::sqrt(share * (1.0 - share) / machines));  // alpha 6e-5
  EXPECT_NEAR(found.deciding_share(0, 0) + found.deciding_share(1, 0), 1.0, 1e-12);
  // All tolerances grow with all limits, so the cost, which is reciprocal, falls by one per cent.
  EXPECT_NEAR(found.saving(0) + found.saving(1), 0.01 * found.total_cost, 2e-4 * found.total_cost);
  EXPECT_NEAR(found.saving(1), found.deciding_share(1, 0) * (found.saving(0) + found.saving(1)), 1e-12);
  EXPECT_EQ(found.multiplier(1, 0), 0.0);  // the root mean square of z is below its limit
}

TEST(ToleranceSearch, FindsTheSameOnAnyNumberOfThreads) {
  const FunctionStudy study = weighted_sum_study(20'000);
  const allocation::Result one = study.find(1);
  const allocation::Result three = study.find(3);
  EXPECT_EQ(one.tolerance, three.tolerance);
  EXPECT_EQ(one.certificate.rejects, three.certificate.rejects);
  EXPECT_EQ(one.coarser_yield, three.coarser_yield);
  EXPECT_EQ(one.multiplier, three.multiplier);
}

TEST(ToleranceSearch, GivesAStudyThatRepeatsItsCertificate) {
  const FunctionStudy study = weighted_sum_study(20'000);
  const StudyResult result = study.run();
  const allocation::Result& found = result.as<allocation::Result>();
  ASSERT_TRUE(result.confirming);
  EXPECT_NE(result.confirming->seed, study.study.seed);
  const auto repeated = run_study(*result.confirming, study.model, PoseSet(1, {0.5}), {.threads = 2});
  ASSERT_TRUE(repeated && repeated->verdicts && repeated->verdicts->yield);
  EXPECT_EQ(repeated->verdicts->yield->rejects, found.certificate.rejects);
  EXPECT_EQ(repeated->verdicts->yield->machines, found.certificate.machines);
  EXPECT_EQ(repeated->verdicts->yield->decision, YieldVerdict::Decision::kept);
}

TEST(ToleranceSearch, GivesEqualEffectEqualShares) {
  FunctionStudy study = weighted_sum_study(20'000);
  study.asked().aim = allocation::Aim::equal_effect;
  const allocation::Result found = study.find();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.mean_square_share(i), 1.0 / 3.0, 1e-9);
    EXPECT_NEAR(found.tolerance(i) * kCoefficients[i], found.tolerance(0) * kCoefficients[0], 1e-9);
  }
  EXPECT_TRUE(found.certified());
}

TEST(ToleranceSearch, TakesTheLargestCommonFactor) {
  FunctionStudy study = weighted_sum_study(20'000);
  study.asked().aim = allocation::Aim::common_factor;
  study.study.errors.by_factor[1] = Distribution::normal(0.15);
  const allocation::Result found = study.find();
  EXPECT_NEAR(found.tolerance(1), 3.0 * found.tolerance(0), 1e-9 * found.tolerance(1));
  EXPECT_NEAR(found.tolerance(2), found.tolerance(0), 1e-9 * found.tolerance(0));
}

TEST(ToleranceSearch, KeepsTheShapeOfErrorsAndTheirShift) {
  FunctionStudy study = weighted_sum_study(20'000);
  study.study.errors.by_factor[0] = Distribution::uniform(0.1);
  for (allocation::AllocatedPart& part : study.asked().parts) {
    part.sigmas = std::sqrt(3.0);
    part.shift = 0.1;
  }
  const StudyResult result = study.run();
  const allocation::Result& found = result.as<allocation::Result>();
  const Distribution& first = result.confirming->errors.by_factor[0];
  EXPECT_EQ(first.shape(), Distribution::Shape::uniform);
  EXPECT_NEAR(first.half_width() + first.shift(), found.tolerance(0), 1e-12);
  EXPECT_NEAR(first.shift(), 0.1 * found.tolerance(0), 1e-15);
  EXPECT_TRUE(found.certified());
}

TEST(ToleranceSearch, ChoosesAmongValuesThatCanBeHad) {
  FunctionStudy study = weighted_sum_study(20'000);
  for (allocation::AllocatedPart& part : study.asked().parts) {
    part.choice = allocation::AllocatedPart::Choice::values;
    part.values = {0.05, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0};
  }
  const allocation::Result found = study.find();
  EXPECT_TRUE(found.certified());
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& values = study.asked().parts[i].values;
    EXPECT_NE(std::ranges::find(values, found.tolerance(i)), values.end());
  }
}

// The second error acts only through a product with the first. If the search missed this, its tolerance would be the
// upper bound.
TEST(ToleranceSearch, SeesErrorsThatActThroughOthers) {
  const auto function = [](std::span<const double> x, double, std::span<double> y) {
    y[0] = x[0] + 30.0 * x[0] * x[1];
  };
  FunctionStudy study(2, function, 0.3, 20'000);
  study.asked().yield = 0.99;
  for (std::size_t i = 0; i < 2; ++i) {
    study.asked().parts.push_back(part_of(i, reciprocal(0.0, i == 0 ? 1.0 : 0.1)));
    study.asked().parts.back().hi = 5.0;
  }
  const allocation::Result found = study.find();
  EXPECT_TRUE(found.certified());
  EXPECT_LT(found.tolerance(1), 0.5);
}

// The second error has no effect below 0.93, which one machine of 190 exceeds if its tolerance is at the upper bound.
// The root mean squares miss this effect, because they are estimated from few draws, so no limit on them keeps the
// yield.
TEST(ToleranceSearch, MakesFinerWhatMeanSquaresDoNotSee) {
  const auto function = [](std::span<const double> x, double, std::span<double> y) {
    y[0] = x[0] + (std::abs(x[1]) > 0.93 ? 100.0 : 0.0);
  };
  FunctionStudy study(2, function, 0.3, 149'000);
  for (std::size_t i = 0; i < 2; ++i) study.asked().parts.push_back(part_of(i, reciprocal(0.0, 1.0)));
  study.asked().parts.back().hi = 1.0;
  const allocation::Result found = study.find();
  EXPECT_TRUE(found.certified());
  const auto alike = std::ranges::find(found.stages, "finer where machines fail", &allocation::AllocationStage::name);
  ASSERT_NE(alike, found.stages.end());
  // If only the first part used up the allowed rejects it would cost 1 / 0.3, and the second part 1 / 0.95.
  EXPECT_GT(found.total_cost, 1.0 / 0.3 + 1.0 / 0.95);
  EXPECT_LT(found.total_cost, 1.15 * (1.0 / 0.3 + 1.0 / 0.95));
}

std::string refusal_of(const FunctionStudy& study) {
  try {
    static_cast<void>(study.find());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ToleranceSearch, RefusesALimitBelowWhatOtherErrorsGive) {
  FunctionStudy study = weighted_sum_study(20'000);
  study.asked().parts.erase(study.asked().parts.begin());  // x1 keeps sigma = 0.05, which gives an rms of 0.15
  study.study.analysis.limits = {{0, 0.1}};
  EXPECT_NE(refusal_of(study).find("the errors of no part alone give a root mean square of 0.15"), std::string::npos)
      << refusal_of(study);
}

/// Expects that the response has the standard deviation at which the design's allowed share of rejects exceeds 1 on one
/// side.
void expect_deviation_by_one_end(const allocation::Result& found) {
  double variance = 0.0;
  for (std::size_t i = 0; i < 3; ++i) variance += std::pow(kCoefficients[i] * found.sigma(i), 2);
  const double z =
      -normal_quantile(1.0, static_cast<double>(found.design_most) / static_cast<double>(found.design_machines));
  EXPECT_NEAR(std::sqrt(variance), 1.0 / z, 0.01 / z);
  EXPECT_EQ(found.certificate.decision, YieldVerdict::Decision::kept);
}

/// A limit from -1 to 3: practically all rejects are beyond the nearer end. If the response of the perfect mechanism is
/// not zero, the distance to the limit counts from that response.
TEST(ToleranceSearch, KeepsALimitWithTwoEnds) {
  FunctionStudy study = weighted_sum_study();
  study.study.analysis.limits = {{0, ValueLimit::between(-1.0, 3.0)}};
  const StudyResult result = study.run();
  const allocation::Result& found = result.as<allocation::Result>();
  expect_deviation_by_one_end(found);
  EXPECT_EQ(result.verdicts->limits.at(0).limit, ValueLimit::between(-1.0, 3.0));
  FunctionStudy moved(
      3,
      [](std::span<const double> x, double place, std::span<double> y) {
        weighted_sum(x, place, y);
        y[0] += 2.0;
      },
      1.0, 200'000);
  moved.asked() = study.asked();
  moved.study.analysis.limits = {{0, ValueLimit::between(1.0, 5.0)}};
  const allocation::Result same = moved.find();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(same.tolerance(i), found.tolerance(i), 1e-3 * found.tolerance(i));
  moved.study.analysis.limits = {{0, ValueLimit::between(-1.0, 1.5)}};
  EXPECT_NE(refusal_of(moved).find("without the errors of the parts it is 2"), std::string::npos) << refusal_of(moved);
}

/// A limit with an upper end only: all rejects are on this side.
TEST(ToleranceSearch, KeepsALimitWithOneEnd) {
  FunctionStudy study = weighted_sum_study();
  study.study.analysis.limits = {{0, ValueLimit::between(-std::numeric_limits<double>::infinity(), 1.0)}};
  const allocation::Result found = study.find();
  expect_deviation_by_one_end(found);
}

TEST(ToleranceSearch, RefusesLowestTolerancesThatAreTooCoarse) {
  FunctionStudy study = weighted_sum_study(20'000);
  for (allocation::AllocatedPart& part : study.asked().parts) part.lo = 1.0;
  EXPECT_NE(refusal_of(study).find("with every tolerance at its lowest the root mean square is 1.067"),
            std::string::npos)
      << refusal_of(study);
  for (allocation::AllocatedPart& part : study.asked().parts)
    part.lo = 0.5;  // the rms is then 0.534, too much for a yield of 99 %
  EXPECT_NE(refusal_of(study).find("99 % of the machines within the limits cannot be reached"), std::string::npos)
      << refusal_of(study);
}

TEST(ToleranceSearch, RefusesAPartWithoutEffectAndBound) {
  FunctionStudy study(
      2, [](std::span<const double> x, double, std::span<double> y) { y[0] = x[0]; }, 1.0, 5000);
  study.asked().yield = 0.99;
  for (std::size_t i = 0; i < 2; ++i) study.asked().parts.push_back(part_of(i, reciprocal(0.0, 1.0)));
  EXPECT_NE(refusal_of(study).find("part 'part 2' has no effect on any limit, and no upper bound"), std::string::npos)
      << refusal_of(study);
}

allocation::MeanSquares squares_of(std::size_t errors, ErrorFunction function, std::size_t draws,
                                   std::vector<double> places) {
  FunctionStudy study(errors, std::move(function), 1.0, 1000);
  const Plan plan(study.study, PoseSet(1, std::move(places)));
  return *allocation::mean_squares(plan, study.model, study.study.analysis.limits, draws, {.threads = 2});
}

TEST(MeanSquaresOf, LinearFunctionsAreExact) {
  constexpr std::size_t kErrors = 400;
  const auto function = [](std::span<const double> x, double place, std::span<double> y) {
    y[0] = 0.01;
    for (std::size_t p = 0; p < x.size(); ++p) y[0] += (1.0 + place) * (1.0 + static_cast<double>(p)) * x[p];
  };
  const allocation::MeanSquares found = squares_of(kErrors, function, 20, {0.0, 1.0});
  for (std::size_t m = 0; m < 2; ++m) {
    double value = 1e-4;
    for (std::size_t p = 0; p < kErrors; ++p) {
      const double slope = std::pow((1.0 + static_cast<double>(m)) * (1.0 + static_cast<double>(p)), 2);
      EXPECT_NEAR(found.slope[m * kErrors + p], slope, 1e-6 * slope) << p;
      value += 0.05 * 0.05 * slope;
    }
    EXPECT_NEAR(found.value[m], value, 1e-6 * value);
  }
}

// y = 0.01 + x1 + 2 x2 - x3 has E y^2 = (0.01 + m1 + 2 m2 - m3)^2 + s1^2 + 4 s2^2 + s3^2, with the means m and the
// standard deviations s of the errors.
TEST(MeanSquaresOf, ErrorsWithMeansAreExact) {
  FunctionStudy study(
      3, [](std::span<const double> x, double, std::span<double> y) { y[0] = 0.01 + x[0] + 2.0 * x[1] - x[2]; }, 1.0,
      1000);
  study.study.errors.by_factor[0] = Distribution::normal(0.05).about(0.2);
  study.study.errors.by_factor[1] = Distribution::uniform(0.1).about(-0.3);
  const Plan plan(study.study, PoseSet(1, {0.5}));
  const allocation::MeanSquares found =
      *allocation::mean_squares(plan, study.model, study.study.analysis.limits, 20, {.threads = 2});
  const double mean = 0.01 + 0.2 - 0.6;
  EXPECT_NEAR(found.value[0], mean * mean + 0.0025 + 4.0 * 0.01 / 3.0 + 0.0025, 1e-12);
  for (std::size_t p = 0; p < 3; ++p) EXPECT_NEAR(found.slope[p], p == 1 ? 4.0 : 1.0, 1e-9) << p;
}

// y = x1 + 10 x2 x3 has E y^2 = s^2 + 100 s^4, with the standard deviation s of each error. The effect of x2 is
// estimated from 4000 draws of x3, whose mean square has a relative standard error of sqrt(2 / 4000). The test allows
// 4.5 of them (alpha = 1e-5).
TEST(MeanSquaresOf, ErrorsThatActTogetherCountForEach) {
  const auto function = [](std::span<const double> x, double, std::span<double> y) {
    y[0] = x[0] + 10.0 * x[1] * x[2];
  };
  const allocation::MeanSquares found = squares_of(3, function, 4000, {0.5});
  const double square = 0.05 * 0.05;
  const double tolerance = 4.5 * std::sqrt(2.0 / 4000.0);
  EXPECT_NEAR(found.slope[0], 1.0, 1e-9);
  EXPECT_NEAR(found.slope[1], 100.0 * square, 100.0 * square * tolerance);
  EXPECT_NEAR(found.slope[2], 100.0 * square, 100.0 * square * tolerance);
  EXPECT_NEAR(found.value[0], square + 100.0 * square * square, 100.0 * square * square * tolerance);
}

struct Promise {
  double yield;
  double confidence;
  std::uint64_t machines;
};

class Allowed : public ::testing::TestWithParam<Promise> {};

TEST_P(Allowed, RejectsAreWhatClopperAndPearsonAllow) {
  const auto [yield, confidence, machines] = GetParam();
  const allocation::AllowedRejects allowed = allocation::allowed_rejects(yield, confidence, machines);
  EXPECT_GE(proportion_at_least(machines - allowed.certificate, machines, confidence), yield);
  EXPECT_LT(proportion_at_least(machines - allowed.certificate - 1, machines, confidence), yield);
  EXPECT_LE(allowed.design, allowed.certificate);
  // The rejects of the design and of the certificate are about Poisson, so their difference is about normal.
  const double d = static_cast<double>(allowed.design);
  EXPECT_LE(d + 2.3 * std::sqrt(2.0 * d), static_cast<double>(allowed.certificate) + 1.0);
}

INSTANTIATE_TEST_SUITE_P(Of, Allowed,
                         ::testing::Values(Promise{0.9973, 0.95, 148'000}, Promise{0.9973, 0.95, 1109},
                                           Promise{0.9, 0.99, 4000}, Promise{0.999, 0.5, 100'000}));

}  // namespace
}  // namespace poesy::test
