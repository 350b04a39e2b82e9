#include "engine/optimise/least_cost.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "tests/engine/optimise/random_programme.h"

namespace poesy {
namespace {

using testing::PlainLaw;
using testing::random_programme;
using testing::RandomProgramme;

constexpr std::uint64_t kProgrammes = 1000;

long double plain_size(long double tolerance, Stacking stacking) {
  return stacking == Stacking::root_sum_square ? tolerance * tolerance : tolerance;
}

/// The minimum over T in [lo, hi] of cost + price x size, which is convex in T, by ternary search.
long double least_total(const PlainLaw& law, long double price, long double lo, long double hi, Stacking stacking) {
  const auto total = [&](long double t) { return law.at(t) + price * plain_size(t, stacking); };
  for (int step = 0; step < 160; ++step) {
    const long double left = lo + (hi - lo) / 3;
    const long double right = hi - (hi - lo) / 3;
    (total(left) <= total(right) ? hi : lo) = total(left) <= total(right) ? right : left;
  }
  return total((lo + hi) / 2);
}

/// The Lagrangian lower bound of the cost for these multipliers, computed independently of the engine.
long double dual_value(const RandomProgramme& random, const std::vector<double>& multiplier) {
  const ToleranceLimits& limits = random.problem.limits;
  long double bound = 0;
  for (std::size_t i = 0; i < limits.parts; ++i) {
    const Process& process = random.problem.parts[i][0];
    long double price = 0;
    long double hi = process.hi;  // the limits alone bound the tolerance too
    for (std::size_t l = 0; l < limits.count(); ++l) {
      const long double effect = limits.row(l)[i];
      price += multiplier[l] * effect;
      if (effect == 0) continue;
      const long double alone = limits.room[l] / effect;
      hi = std::min(hi, limits.stacking == Stacking::worst_case ? alone : std::sqrt(alone));
    }
    bound += least_total(random.laws[i], price, process.lo, std::max(hi, static_cast<long double>(process.lo)),
                         limits.stacking);
  }
  for (std::size_t l = 0; l < limits.count(); ++l) bound -= static_cast<long double>(multiplier[l]) * limits.room[l];
  return bound;
}

TEST(RandomProgrammes, AreSolvedWithAProofOfTheirOwn) {
  for (std::uint64_t number = 0; number < kProgrammes; ++number) {
    const RandomProgramme random = random_programme(number);
    const LeastCost found = std::get<LeastCost>(least_cost(random.problem));
    const double cost = found.best.cost;
    EXPECT_LE(found.gap(), 1e-9 * cost) << number;
    EXPECT_GE(found.gap(), 0.0) << number;
    for (const double multiplier : found.multiplier) EXPECT_GE(multiplier, 0.0) << number;
    const long double dual = dual_value(random, found.multiplier);
    EXPECT_GE(static_cast<double>(dual), cost * (1.0 - 1e-9)) << number;
    EXPECT_LE(found.lower_bound, static_cast<double>(dual)) << number;
    long double sum = 0;
    for (std::size_t i = 0; i < random.laws.size(); ++i) sum += random.laws[i].at(found.best.tolerance[i]);
    EXPECT_NEAR(cost, static_cast<double>(sum), 1e-13 * cost) << number;
  }
}

TEST(RandomProgrammes, KeepTheirBoundsAndLimits) {
  for (std::uint64_t number = 0; number < kProgrammes; ++number) {
    const AllocationProblem problem = random_programme(number).problem;
    const LeastCost found = std::get<LeastCost>(least_cost(problem));
    const std::vector<double>& tolerance = found.best.tolerance;
    for (std::size_t i = 0; i < tolerance.size(); ++i) {
      EXPECT_GE(tolerance[i], problem.parts[i][0].lo) << number;
      EXPECT_LE(tolerance[i], problem.parts[i][0].hi) << number;
    }
    for (std::size_t l = 0; l < problem.limits.count(); ++l) {
      long double exact = 0;
      double forwards = 0.0;
      double backwards = 0.0;
      for (std::size_t i = 0; i < tolerance.size(); ++i) {
        const std::size_t j = tolerance.size() - 1 - i;
        forwards += problem.limits.row(l)[i] * size_of(tolerance[i], problem.limits.stacking);
        backwards += problem.limits.row(l)[j] * size_of(tolerance[j], problem.limits.stacking);
        exact += problem.limits.row(l)[i] * plain_size(tolerance[i], problem.limits.stacking);
      }
      EXPECT_LE(forwards, problem.limits.room[l]) << number;
      EXPECT_LE(backwards, problem.limits.room[l]) << number;
      EXPECT_LE(exact, static_cast<long double>(problem.limits.room[l])) << number;
    }
  }
}

/// Reference costs by SLSQP of scipy, computed with reference_costs.py.
TEST(RandomProgrammes, CostNoMoreThanAnotherSolverFinds) {
  std::ifstream file(POESY_TEST_DATA "/allocation_costs.csv");
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  std::uint64_t compared = 0;
  std::uint64_t found_too = 0;
  while (std::getline(file, line)) {
    const std::uint64_t number = std::stoull(line);
    const double reference = std::stod(line.substr(line.find(',') + 1));
    const LeastCost found = std::get<LeastCost>(least_cost(random_programme(number).problem));
    EXPECT_LE(found.best.cost, reference * (1.0 + 1e-10)) << number;  // the file has 12 digits
    EXPECT_LE(found.lower_bound, reference * (1.0 + 1e-11)) << number;
    ++compared;
    if (reference <= found.best.cost * (1.0 + 1e-7)) ++found_too;
  }
  EXPECT_EQ(compared, kProgrammes);
  EXPECT_GE(found_too, kProgrammes * 95 / 100);  // the reference solver found nearly all optima
}

TEST(RandomProgrammes, CostLessWithMoreRoom) {
  for (std::uint64_t number = 0; number < 200; ++number) {
    const AllocationProblem problem = random_programme(number).problem;
    const double cost = std::get<LeastCost>(least_cost(problem)).best.cost;
    AllocationProblem wider = problem;
    for (double& room : wider.limits.room) room *= 1.3;
    EXPECT_LE(std::get<LeastCost>(least_cost(wider)).lower_bound, cost) << number;
    AllocationProblem more = problem;
    for (std::size_t i = 0; i < problem.parts.size(); ++i) more.limits.effects.push_back(problem.limits.row(0)[i]);
    more.limits.room.push_back(problem.limits.room[0] * 1.5);
    EXPECT_NEAR(std::get<LeastCost>(least_cost(more)).best.cost, cost, 1e-10 * cost) << number;
  }
}

/// Problems in which the lower bounds of the tolerances use nearly the whole limit: the rest is from a tenth down to a
/// billionth.
TEST(RandomProgrammes, ThatHardlyHaveRoomAreSolved) {
  for (std::uint64_t number = 0; number < 500; ++number) {
    AllocationProblem problem = random_programme(number).problem;
    testing::SplitMix draw(number);
    double rounding = 0.0;
    std::vector<double> lo;
    for (const auto& part : problem.parts) lo.push_back(part[0].lo);
    for (std::size_t l = 0; l < problem.limits.count(); ++l) {
      const double need = problem.limits.need(l, lo);
      if (need > 0.0) problem.limits.room[l] = need * (1.0 + std::pow(10.0, -1.0 - 8.0 * draw.uniform()));
    }
    const LeastCost found = std::get<LeastCost>(least_cost(problem));
    EXPECT_LE(found.use.share, 1.0) << number;
    for (std::size_t l = 0; l < problem.limits.count(); ++l) rounding += found.multiplier[l] * problem.limits.room[l];
    EXPECT_LE(found.gap(), 1e-9 * found.best.cost + 1e-13 * rounding) << number;
  }
}

}  // namespace
}  // namespace poesy
