#include "engine/optimise/least_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/engine/optimise/overrunning_clutch.h"

namespace poesy {
namespace {

using testing::clutch_limits;
using testing::clutch_problem;
using testing::clutch_processes;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Parts of one process each, without bounds.
AllocationProblem unbounded(ToleranceLimits limits, const std::vector<CostLaw>& laws) {
  AllocationProblem problem{std::move(limits), {}};
  for (const CostLaw& law : laws) problem.parts.push_back({{law, 0.0, kInfinity}});
  return problem;
}

LeastCost solved(const AllocationProblem& problem, const SearchOptions& options = {}) {
  return std::get<LeastCost>(least_cost(problem, options));
}

TEST(OverrunningClutch, HasTheOptimumOfItsPublishedProcesses) {
  const std::size_t published[]{2, 1, 0, 2};
  std::vector<CostLaw> laws;
  for (std::size_t i = 0; i < 4; ++i) laws.push_back(clutch_processes()[i][published[i]].cost);
  const LeastCost found = solved(unbounded(clutch_limits(Stacking::root_sum_square), laws));
  EXPECT_NEAR(found.best.cost, 24.42989011, 5e-8);  // the reference's gradient has 8 digits
  const double expected[]{.17859228, .17069998, .13191761, .18931314};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found.best.tolerance[i], expected[i], 2e-8);
  EXPECT_LE(found.gap(), 1e-11 * found.best.cost);
  EXPECT_EQ(found.bound, std::vector(4, AtBound::none));
}

TEST(OverrunningClutch, IsPublishedWithABrokenLimitAndAHigherCost) {
  const std::vector<double> published{.179806, .165358, .120132, .200581};
  const ToleranceLimits limits = clutch_limits(Stacking::root_sum_square);
  EXPECT_NEAR(std::sqrt(limits.need(0, published)), .035005, 5e-7);
  const std::size_t process[]{2, 1, 0, 2};
  double cost = 0.0;
  for (std::size_t i = 0; i < 4; ++i) cost += clutch_processes()[i][process[i]].cost.at(published[i]);
  EXPECT_NEAR(cost, 24.48654, 5e-6);
}

TEST(OverrunningClutch, HasTheBestProcessesAndTheNextBest) {
  SearchOptions options;
  options.alternatives = 1;
  const LeastCost found = solved(clutch_problem(Stacking::root_sum_square), options);
  EXPECT_EQ(found.best.process, (std::vector<std::size_t>{2, 1, 0, 2}));
  EXPECT_NEAR(found.best.cost, 24.462426, 5e-7);
  const double expected[]{.173842, .166160, .128409, .200000};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found.best.tolerance[i], expected[i], 6e-7);
  EXPECT_EQ(found.best.tolerance[3], 0.2);
  EXPECT_EQ(found.bound[3], AtBound::lower);
  EXPECT_LE(found.gap(), 1e-9 * found.best.cost);
  ASSERT_EQ(found.next.size(), 1u);
  EXPECT_EQ(found.next[0].process, (std::vector<std::size_t>{1, 1, 0, 2}));
  EXPECT_NEAR(found.next[0].cost, 24.494012, 5e-7);
}

TEST(OverrunningClutch, HasOtherProcessesInTheWorstCase) {
  const LeastCost found = solved(clutch_problem(Stacking::worst_case));
  EXPECT_EQ(found.best.process, (std::vector<std::size_t>{0, 1, 0, 0}));
  EXPECT_NEAR(found.best.cost, 34.127904, 5e-7);
  EXPECT_LE(found.use.share, 1.0);
  EXPECT_LE(found.gap(), 1e-9 * found.best.cost);
}

TEST(LeastCost, OfReciprocalCostsIsTheClosedForm) {
  // The minimum of sum b / T subject to sum g^2 T^2 = L^2 has T proportional to (b / g^2)^(1/3).
  const std::vector<double> b{0.3, 2.0, 0.04, 7.0, 1.1};
  const std::vector<double> g{0.1, 0.7, 3.0, 0.02, 1.0};
  ToleranceLimits limits{Stacking::root_sum_square, b.size(), {}, {0.05 * 0.05}};
  std::vector<CostLaw> laws;
  double square = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    limits.effects.push_back(g[i] * g[i]);
    laws.push_back(CostLaw::reciprocal(0.0, b[i]));
    square += std::pow(g[i] * std::cbrt(b[i] / (g[i] * g[i])), 2);
  }
  const LeastCost found = solved(unbounded(limits, laws));
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double expected = 0.05 / std::sqrt(square) * std::cbrt(b[i] / (g[i] * g[i]));
    EXPECT_NEAR(found.best.tolerance[i], expected, 1e-11 * expected);
  }
  EXPECT_LE(found.gap(), 1e-11 * found.best.cost);
}

TEST(LeastCost, HasMultipliersThatSayWhatMoreRoomSaves) {
  AllocationProblem problem{{Stacking::root_sum_square, 3, {4, 1, 2, 1, 9, 1, 1, 1, 1}, {1.0, 1.3, 100.0}}, {}};
  problem.parts = {{{CostLaw::reciprocal(0, 1), 0, kInfinity}},
                   {{CostLaw::exponential(0, 5, 0.2), 0.1, 2.0}},
                   {{CostLaw::reciprocal_power(0, 0.4, 2), 0, 0.9}}};
  const LeastCost found = solved(problem);
  for (std::size_t l = 0; l < 3; ++l) {
    AllocationProblem wider = problem;
    AllocationProblem closer = problem;
    wider.limits.room[l] *= 1.0 + 1e-5;
    closer.limits.room[l] *= 1.0 - 1e-5;
    const double saved = (solved(closer).best.cost - solved(wider).best.cost) / (2e-5 * problem.limits.room[l]);
    EXPECT_NEAR(found.multiplier[l], saved, 1e-6 * found.best.cost) << l;
  }
  EXPECT_GT(found.multiplier[0], 0.1);
  EXPECT_EQ(found.multiplier[2], 0.0);
}

TEST(LeastCost, LoosensEverythingWhereNoLimitIsReached) {
  AllocationProblem problem{{Stacking::worst_case, 2, {1, 1}, {10.0}}, {}};
  problem.parts = {{{CostLaw::reciprocal(1, 1), 0.1, 2.0}}, {{CostLaw::exponential(1, 1, 1), 0.1, 3.0}}};
  const LeastCost found = solved(problem);
  EXPECT_EQ(found.best.tolerance, (std::vector{2.0, 3.0}));
  EXPECT_EQ(found.bound, std::vector(2, AtBound::upper));
  EXPECT_EQ(found.multiplier, std::vector{0.0});
  EXPECT_DOUBLE_EQ(found.use.share, 0.5);
}

TEST(LeastCost, OfOneLimitThatStandsTwiceIsThatOfOne) {
  const std::vector<CostLaw> laws{CostLaw::reciprocal(0, 1), CostLaw::reciprocal(0, 2),
                                  CostLaw::exponential(0, 5, 0.3)};
  const LeastCost once = solved(unbounded({Stacking::root_sum_square, 3, {1, 2, 3}, {0.5}}, laws));
  const LeastCost twice = solved(unbounded({Stacking::root_sum_square, 3, {1, 2, 3, 1, 2, 3}, {0.5, 0.5}}, laws));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(twice.best.tolerance[i], once.best.tolerance[i], 1e-11 * once.best.tolerance[i]);
  }
  EXPECT_NEAR(twice.multiplier[0] + twice.multiplier[1], once.multiplier[0], 1e-9 * once.multiplier[0]);
}

TEST(LeastCost, TakesManyLimitsOfWhichFewMatter) {
  const std::size_t limits = 3000;
  ToleranceLimits many{Stacking::root_sum_square, 3, {}, {}};
  for (std::size_t l = 0; l < limits; ++l) {
    const double angle = 1.5 * static_cast<double>(l) / static_cast<double>(limits);
    many.effects.insert(many.effects.end(),
                        {1.0 + std::cos(angle), 1.0 + std::sin(angle), 1.0 + std::cos(2.0 * angle)});
    many.room.push_back(1.0);
  }
  const std::vector<CostLaw> laws{CostLaw::reciprocal(0, 1), CostLaw::reciprocal(0, 1), CostLaw::reciprocal(0, 1)};
  const LeastCost found = solved(unbounded(many, laws));
  EXPECT_LE(found.gap(), 1e-11 * found.best.cost);
  EXPECT_LE(std::ranges::count_if(found.multiplier, [](double multiplier) { return multiplier > 0.0; }), 20);
}

TEST(LeastCost, GivesAPartWithoutEffectItsUpperBound) {
  AllocationProblem problem{{Stacking::root_sum_square, 2, {1, 0}, {1.0}}, {}};
  problem.parts = {{{CostLaw::reciprocal(0, 1), 0, kInfinity}}, {{CostLaw::reciprocal(0, 1), 0.1, 0.7}}};
  const LeastCost found = solved(problem);
  EXPECT_NEAR(found.best.tolerance[0], 1.0, 1e-11);
  EXPECT_EQ(found.best.tolerance[1], 0.7);
  EXPECT_EQ(found.bound[1], AtBound::upper);
}

TEST(LeastCost, RefusesPartsThatCouldBeLoosenedForEver) {
  AllocationProblem problem{{Stacking::root_sum_square, 3, {1, 0, 0}, {1.0}}, {}};
  const Process endless{CostLaw::reciprocal(0, 1), 0, kInfinity};
  problem.parts = {{endless}, {endless}, {{CostLaw::constant(1), 0.1, 0.7}, endless}};
  EXPECT_EQ(std::get<Unbounded>(least_cost(problem)).parts, (std::vector<std::size_t>{1, 2}));
  problem.limits = {Stacking::root_sum_square, 3, {}, {}};
  EXPECT_EQ(std::get<Unbounded>(least_cost(problem)).parts, (std::vector<std::size_t>{0, 1, 2}));
}

TEST(LeastCost, WithoutLimitsIsThatOfTheUpperBounds) {
  AllocationProblem problem{{Stacking::root_sum_square, 1, {}, {}}, {}};
  problem.parts = {{{CostLaw::reciprocal(0, 1), 0, 4.0}}};
  const LeastCost found = solved(problem);
  EXPECT_EQ(found.best.tolerance, std::vector{4.0});
  EXPECT_NEAR(found.lower_bound, 0.25, 1e-12);
}

TEST(LeastCost, TakesTheTightestWhereTightnessCostsNothing) {
  AllocationProblem problem{{Stacking::worst_case, 2, {1, 1}, {1.0}}, {}};
  problem.parts = {{{CostLaw::reciprocal(0, 1), 0, kInfinity}}, {{CostLaw::constant(3), 0.25, 0.5}}};
  const LeastCost found = solved(problem);
  EXPECT_NEAR(found.best.tolerance[0], 0.75, 1e-11);
  EXPECT_EQ(found.best.tolerance[1], 0.25);
  EXPECT_EQ(found.bound[1], AtBound::lower);
}

TEST(LeastCost, KeepsFixedParts) {
  AllocationProblem problem{{Stacking::worst_case, 2, {1, 1}, {1.0}}, {}};
  problem.parts = {{{CostLaw::reciprocal(0, 1), 0, kInfinity}}, {fixed_process(0.4)}};
  const LeastCost found = solved(problem);
  EXPECT_NEAR(found.best.tolerance[0], 0.6, 1e-11);
  EXPECT_EQ(found.best.tolerance[1], 0.4);
  EXPECT_EQ(found.bound[1], AtBound::single);
}

TEST(LeastCost, SaysWhichLimitCannotBeMet) {
  AllocationProblem problem{{Stacking::root_sum_square, 2, {4, 1, 9, 1, 1, 1}, {1.0, 1.0, 2.0}}, {}};
  problem.parts = {{{CostLaw::reciprocal(0, 1), 0.5, 2.0}, {CostLaw::reciprocal(0, 1), 0.4, 2.0}},
                   {{CostLaw::reciprocal(0, 1), 0.1, 2.0}}};
  const auto broken = std::get<Infeasible>(least_cost(problem));
  EXPECT_EQ(broken.limit, 1u);
  EXPECT_DOUBLE_EQ(broken.need, 1.45);
  EXPECT_EQ(broken.room, 1.0);
}

TEST(LeastCost, CannotMeetALimitWithoutRoom) {
  AllocationProblem problem{{Stacking::root_sum_square, 1, {4, 1}, {1.0, -0.5}}, {}};
  problem.parts = {{{CostLaw::reciprocal(0, 1), 0.0, 2.0}}};
  const auto broken = std::get<Infeasible>(least_cost(problem));
  EXPECT_EQ(broken.limit, 1u);
  EXPECT_EQ(broken.room, -0.5);
}

TEST(LeastCost, IsAtTheLowerBoundsWhereTheseFillALimit) {
  AllocationProblem problem{{Stacking::worst_case, 3, {1, 1, 1, 0, 1, 1}, {0.75, 100.0}}, {}};
  problem.parts = {
      {{CostLaw::reciprocal(0, 1), 0.25, 2.0}}, {fixed_process(0.25)}, {{CostLaw::reciprocal(0, 1), 0.25, 2.0}}};
  const LeastCost found = solved(problem);
  EXPECT_EQ(found.best.tolerance, std::vector(3, 0.25));
  EXPECT_EQ(found.use.share, 1.0);
  EXPECT_NEAR(found.gap(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(found.multiplier[0], 16.0);  // 1 / T^2: either part would use more room
}

TEST(LeastCost, LeavesSomethingToEachPart) {
  AllocationProblem problem{{Stacking::worst_case, 2, {1, 1}, {0.5}}, {}};
  problem.parts = {{{CostLaw::reciprocal(0, 1), 0.0, 2.0}}, {fixed_process(0.5)}};
  const auto broken = std::get<Infeasible>(least_cost(problem));
  EXPECT_EQ(broken.limit, 0u);
  EXPECT_EQ(broken.need, broken.room);
}

TEST(LeastCost, WorksAtAnyScale) {
  for (const double money : {1e-9, 1.0, 1e12}) {
    for (const double metre : {1e-9, 1.0, 1e6}) {
      AllocationProblem problem{{Stacking::root_sum_square, 2, {1, 3, 2, 1}, {metre * metre, 1.5 * metre * metre}}, {}};
      problem.parts = {{{CostLaw::reciprocal(money, money * metre), 0, kInfinity}},
                       {{CostLaw::exponential(0, money, 0.3 * metre), 0.1 * metre, kInfinity}}};
      const LeastCost found = solved(problem);
      EXPECT_LE(found.gap(), 1e-11 * found.best.cost) << money << " " << metre;
      EXPECT_NEAR(found.best.cost / money, 2.543737146083, 1e-11) << money << " " << metre;
    }
  }
}

TEST(LeastCost, HasTheSameBitsTwice) {
  const LeastCost one = solved(clutch_problem(Stacking::root_sum_square));
  const LeastCost two = solved(clutch_problem(Stacking::root_sum_square));
  EXPECT_EQ(one.best.tolerance, two.best.tolerance);
  EXPECT_EQ(one.multiplier, two.multiplier);
  EXPECT_EQ(one.lower_bound, two.lower_bound);
}

}  // namespace
}  // namespace poesy
