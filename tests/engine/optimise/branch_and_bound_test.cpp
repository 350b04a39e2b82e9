#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/optimise/least_cost.h"
#include "tests/engine/optimise/overrunning_clutch.h"
#include "tests/engine/optimise/random_programme.h"

namespace poesy {
namespace {

using testing::clutch_problem;
using testing::SplitMix;

enum class Choice { processes, values, both };

/// Random parts, each with `ways` processes or single values, whose ranges overlap and whose cost curves cross.
AllocationProblem random_choice(std::uint64_t seed, std::size_t parts, std::size_t limits, std::size_t ways,
                                Choice choice) {
  SplitMix draw(seed + 77);
  AllocationProblem problem{{Stacking::root_sum_square, parts, {}, {}}, {}};
  std::vector<double> base;
  for (std::size_t i = 0; i < parts; ++i) base.push_back(std::exp(4.0 * draw.uniform() - 2.0));
  for (std::size_t l = 0; l < limits; ++l) {
    problem.limits.room.push_back(std::exp(0.5 * draw.uniform()));
    for (std::size_t i = 0; i < parts; ++i) problem.limits.effects.push_back(base[i] * (0.3 + draw.uniform()));
  }
  for (std::size_t i = 0; i < parts; ++i) {
    const double scale = std::sqrt(1.0 / (static_cast<double>(parts) * base[i]));
    const double money = std::exp(2.0 * draw.uniform());
    const double bend = 0.5 + draw.uniform();
    std::vector<Process>& list = problem.parts.emplace_back();
    for (std::size_t p = 0; p < ways; ++p) {
      const double step = static_cast<double>(p) / static_cast<double>(ways);
      const double tolerance = 0.4 * scale * std::pow(100.0, step);
      if (choice == Choice::values || (choice == Choice::both && i % 2 == 1)) {
        list.push_back(
            fixed_process(tolerance, money * std::pow(tolerance / scale, -bend) * (1.0 + 0.1 * draw.uniform())));
      } else {
        const double fixed = money * (1.0 + static_cast<double>(ways) * step) * draw.uniform();
        const double b = money * scale * std::exp(-3.0 * step) * (0.5 + draw.uniform());
        list.push_back({CostLaw::reciprocal(fixed, b), 0.5 * tolerance, 2.5 * tolerance});
      }
    }
  }
  return problem;
}

/// The least costs of all choices of processes that can keep the limits, ascending. Each choice is optimised
/// separately.
std::vector<double> costs_of_all(const AllocationProblem& problem) {
  std::vector<double> costs;
  std::vector<std::size_t> choice(problem.parts.size(), 0);
  for (std::size_t i = 0; i < choice.size();) {
    AllocationProblem one{problem.limits, {}};
    for (std::size_t k = 0; k < choice.size(); ++k) one.parts.push_back({problem.parts[k][choice[k]]});
    const AllocationOutcome outcome = least_cost(one);
    if (const auto* found = std::get_if<LeastCost>(&outcome)) costs.push_back(found->best.cost);
    for (i = 0; i < choice.size() && ++choice[i] == problem.parts[i].size(); ++i) choice[i] = 0;
  }
  std::ranges::sort(costs);
  return costs;
}

void expect_the_best_of_all(const AllocationProblem& problem, std::size_t alternatives, std::uint64_t seed) {
  const std::vector<double> costs = costs_of_all(problem);
  SearchOptions options;
  options.alternatives = alternatives;
  const LeastCost found = std::get<LeastCost>(least_cost(problem, options));
  EXPECT_NEAR(found.best.cost, costs[0], 1e-9 * costs[0]) << seed;
  EXPECT_LE(found.lower_bound, costs[0] * (1.0 + 1e-15)) << seed;
  EXPECT_LE(found.gap(), 1e-9 * costs[0]) << seed;
  EXPECT_LE(found.use.share, 1.0) << seed;
  ASSERT_EQ(found.next.size(), std::min(alternatives, costs.size() - 1)) << seed;
  for (std::size_t k = 0; k < found.next.size(); ++k) {
    EXPECT_NEAR(found.next[k].cost, costs[k + 1], 1e-9 * costs[k + 1]) << seed;
  }
}

TEST(SearchAmongProcesses, FindsTheBestOfAllAndTheNextOnes) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    expect_the_best_of_all(random_choice(seed, 5, 3, 4, Choice::processes), 3, seed);
    expect_the_best_of_all(random_choice(seed, 5, 3, 4, Choice::values), 3, seed);
    expect_the_best_of_all(random_choice(seed, 5, 3, 4, Choice::both), 0, seed);
  }
}

TEST(SearchAmongProcesses, RanksAllChoicesOfTheClutch) {
  expect_the_best_of_all(clutch_problem(Stacking::root_sum_square), 35, 0);
  expect_the_best_of_all(clutch_problem(Stacking::worst_case), 35, 0);
}

TEST(SearchAmongProcesses, SolvesManyPartsAndLimits) {
  const AllocationProblem problem = random_choice(1, 40, 300, 10, Choice::values);
  const LeastCost found = std::get<LeastCost>(least_cost(problem));
  EXPECT_LE(found.gap(), 1e-9 * found.best.cost);
  EXPECT_LE(found.use.share, 1.0);
  EXPECT_LT(found.nodes, 5000u);
}

TEST(SearchAmongProcesses, ThatEndsEarlySaysHowFarItMayBeOff) {
  const AllocationProblem problem = random_choice(1, 30, 10, 10, Choice::values);
  const double least = std::get<LeastCost>(least_cost(problem)).best.cost;
  SearchOptions options;
  options.max_nodes = 2;
  const LeastCost found = std::get<LeastCost>(least_cost(problem, options));
  EXPECT_EQ(found.nodes, 2u);
  EXPECT_GT(found.gap(), 1e-9 * least);
  EXPECT_LE(found.lower_bound, least);
  EXPECT_GE(found.best.cost, least);
  EXPECT_LE(found.gap(), 0.02 * least);
  options.max_nodes = 20000;
  options.relative_gap = 0.01;
  EXPECT_LE(std::get<LeastCost>(least_cost(problem, options)).gap(), 0.01 * least);
}

TEST(SearchAmongProcesses, KnowsWhatMixedProcessesWouldPayForRoom) {
  AllocationProblem problem = random_choice(3, 30, 1, 10, Choice::values);
  const LeastCost found = std::get<LeastCost>(least_cost(problem));
  EXPECT_EQ(found.multiplier, std::vector{0.0});  // a little more room does not change a choice among single values
  EXPECT_GT(found.relaxed[0], 0.0);
  const double more = 0.5;
  problem.limits.room[0] += more;
  const double saved = found.best.cost - std::get<LeastCost>(least_cost(problem)).best.cost;
  EXPECT_LT(saved, 1.05 * more * found.relaxed[0]);  // the relaxed cost is convex; choices cost about as much
  EXPECT_GT(saved, 0.2 * more * found.relaxed[0]);
}

// Grades IT5 to IT12 of ISO 286-1 (micrometres) at 12 mm, 100 mm and 400 mm. The best of the 8^3 choices is found by
// enumeration.
TEST(SearchAmongProcesses, TakesGradesOfAStandard) {
  const std::vector<std::pair<double, std::vector<double>>> widths{{0.012, {8, 11, 18, 27, 43, 70, 110, 180}},
                                                                   {0.1, {15, 22, 35, 54, 87, 140, 220, 350}},
                                                                   {0.4, {25, 36, 57, 89, 140, 230, 360, 570}}};
  std::vector<std::vector<double>> tolerances;
  AllocationProblem problem{{Stacking::worst_case, 3, {1.0, 0.5, 2.0}, {60e-6}}, {}};
  for (const auto& [nominal, micrometres] : widths) {
    std::vector<double>& list = tolerances.emplace_back();
    for (const double width : micrometres) list.push_back(0.5e-6 * width);
    problem.parts.push_back(available_values(CostLaw::reciprocal(1.0, nominal * 1e-3), list));
  }
  double least = std::numeric_limits<double>::infinity();
  for (const double a : tolerances.at(0)) {
    for (const double b : tolerances.at(1)) {
      for (const double c : tolerances.at(2)) {
        if (a + 0.5 * b + 2.0 * c <= 60e-6) least = std::min(least, 3.0 + 12e-6 / a + 1e-4 / b + 4e-4 / c);
      }
    }
  }
  const LeastCost found = std::get<LeastCost>(least_cost(problem));
  EXPECT_NEAR(found.best.cost, least, 1e-12 * least);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found.best.tolerance[i], tolerances[i][found.best.process[i]]);
  EXPECT_EQ(found.bound, std::vector(3, AtBound::single));
}

TEST(SearchAmongProcesses, ChoosesTheCheapestOfAPartWithoutEffect) {
  AllocationProblem problem{{Stacking::worst_case, 2, {1, 0}, {1.0}}, {}};
  problem.parts = {
      {{CostLaw::reciprocal(0, 1), 0, 2.0}},
      {{CostLaw::reciprocal(0, 1), 0.1, 0.5}, {CostLaw::reciprocal(1.2, 0.1), 0.1, 0.5}, fixed_process(0.3, 1.5)}};
  const LeastCost found = std::get<LeastCost>(least_cost(problem));
  EXPECT_EQ(found.best.process[1], 1u);
  EXPECT_EQ(found.best.tolerance[1], 0.5);
}

}  // namespace
}  // namespace poesy
