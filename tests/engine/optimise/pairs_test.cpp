#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/optimise/least_cost.h"
#include "tests/engine/optimise/random_programme.h"

/// Pairs of parts: an orientation zone (inner) within a location zone (outer). The orientation zone may be left out.
namespace poesy {
namespace {

using testing::PlainLaw;
using testing::SplitMix;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

LeastCost solved(const AllocationProblem& problem, const SearchOptions& options = {}) {
  return std::get<LeastCost>(least_cost(problem, options));
}

/// For each zone of the tutorial's Delta, its mean square of the tool position divided by T^2 (both mm^2) at three
/// poses, from `allocation` in drawing.json. The limit is 0.02 mm.
constexpr std::array<std::array<double, 3>, 11> kDelta{{
    {5.593453503657986, 6.098184473741125, 7.30145588076525},             // face.parallelism
    {0.03967078189300408, 0.05385386075335197, 0.04415853858834494},      // rail.position
    {-0.01321111111111104, -0.043418967096981786, -0.00773266854690496},  // rail.perpendicularity
    {0.5578703703703698, 0.4493896377590069, 0.5274797451897272},         // zero
    {0.17913837448559652, 0.15669036724429333, 0.17341992843653667},      // hinge_b.position
    {0.5760790010930914, 0.7574658484929877, 0.5759227199728952},         // hinge_b.parallelism
    {0.7608735210905206, 0.8956839379741351, 0.7540965915846054},         // cross_b.position
    {0.7165534979423858, 0.6648050807724144, 0.7041138995431068},         // rod
    {1.342608667695445, 1.62516660575517, 1.3321647082834376},            // rod_bore.parallelism
    {0.7608735210905205, 0.8909284864997313, 0.7527923183599862},         // cross_c.position
    {0.46717787503214164, 0.5354232914907876, 0.4613812884229844},        // hinge_c.position
}};
constexpr std::size_t kRailTilt = 2;
constexpr std::size_t kHingeTilt = 5;

/// The allocation of these zones with costs b / T: b is 0.5 for the distances zero and rod, hinge_b for
/// hinge_b.parallelism and 1 for other zones.
AllocationProblem delta(double hinge_b) {
  AllocationProblem problem{{Stacking::root_sum_square, kDelta.size(), {}, {}}, {}, {}};
  for (std::size_t l = 0; l < 3; ++l) {
    problem.limits.room.push_back(0.02 * 0.02);
    for (const auto& zone : kDelta) problem.limits.effects.push_back(zone[l]);
  }
  for (std::size_t i = 0; i < kDelta.size(); ++i) {
    const double b = i == 3 || i == 7 ? 0.5 : i == kHingeTilt ? hinge_b : 1.0;
    problem.parts.push_back({{CostLaw::reciprocal(0.0, b), 0.0, kInfinity}});
  }
  problem.pairs = {{kRailTilt, 1, 0.5, LeftOut::never}, {kHingeTilt, 4, 0.5, LeftOut::never}};
  return problem;
}

TEST(ZonesOfTheDelta, CostLeastWithAnOrientationAtItsLimit) {
  const LeastCost found = solved(delta(1.0));
  EXPECT_NEAR(found.best.cost, 1304.3838661949499, 1e-8);
  const double expected[]{0.003691061983778386,  0.028451712669883767, 0.02011839896524602,  0.006987693399083074,
                          0.012508467125509229,  0.007397707779566027, 0.006995733587067192, 0.006132582731883502,
                          0.0057356885512473135, 0.007008158398715171, 0.00830460737014867};
  for (std::size_t i = 0; i < kDelta.size(); ++i) EXPECT_NEAR(found.best.tolerance[i], expected[i], 1e-8) << i;
  EXPECT_NEAR(found.best.tolerance[kRailTilt], std::sqrt(0.5) * found.best.tolerance[1], 1e-14);
  EXPECT_LE(found.gap(), 1e-11 * found.best.cost);
  EXPECT_TRUE(found.best.left_out.empty());
  EXPECT_GT(found.multiplier[1], 0.0);
  EXPECT_EQ(found.multiplier[0], 0.0);
}

TEST(ZonesOfTheDelta, CostLessWithoutOneOrBothOrientations) {
  const std::vector<std::pair<std::vector<std::size_t>, double>> cases{{{kRailTilt}, 1248.2402974054262},
                                                                       {{kHingeTilt}, 1164.9329761218596},
                                                                       {{kRailTilt, kHingeTilt}, 1110.8971540084056}};
  for (const auto& [left_out, cost] : cases) {
    AllocationProblem problem = delta(1.0);
    for (Within& pair : problem.pairs)
      pair.left_out = std::ranges::count(left_out, pair.inner) > 0 ? LeftOut::by_choice : LeftOut::never;
    const LeastCost found = solved(problem);
    EXPECT_NEAR(found.best.cost, cost, 1e-8);
    EXPECT_EQ(found.best.left_out, left_out);
    EXPECT_LE(found.gap(), 1e-9 * cost);
  }
}

TEST(ZonesOfTheDelta, KeepAnOrientationThatPays) {
  AllocationProblem problem = delta(0.1);
  for (Within& pair : problem.pairs) pair.left_out = LeftOut::by_choice;
  SearchOptions options;
  options.alternatives = 1;
  const LeastCost found = solved(problem, options);
  EXPECT_NEAR(found.best.cost, 1094.8038567464941, 1e-8);
  const double expected[]{0.003912980691785691, 0.02248396422691476,   std::sqrt(0.5) * 0.02248396422691476,
                          0.007407816360412567, 0.013260517043891612,  0.003640157755335293,
                          0.007416339950771777, 0.0065012936455957565, 0.006080536889860723,
                          0.007429511782697462, 0.008803907502790935};
  for (std::size_t i = 0; i < kDelta.size(); ++i) EXPECT_NEAR(found.best.tolerance[i], expected[i], 1e-8) << i;
  EXPECT_EQ(found.best.left_out, std::vector{kRailTilt});
  EXPECT_EQ(found.bound, std::vector(kDelta.size(), AtBound::none));
  ASSERT_EQ(found.next.size(), 1u);
  EXPECT_NEAR(found.next[0].cost, 1110.8971540084056, 1e-8);
  EXPECT_EQ(found.next[0].left_out, (std::vector{kRailTilt, kHingeTilt}));
}

/// A random problem with pairs and one part that is in no pair.
struct RandomPairs {
  AllocationProblem problem;
  std::vector<std::vector<PlainLaw>> laws;  ///< [parts][processes]
};

RandomPairs random_pairs(std::uint64_t number, std::size_t pairs, std::size_t ways, LeftOut left_out) {
  SplitMix draw(number * 7919 + 5);
  RandomPairs random;
  ToleranceLimits& limits = random.problem.limits;
  limits.parts = 2 * pairs + 1;
  const std::size_t count = 1 + draw.below(6);
  std::vector<double> scale;
  for (std::size_t i = 0; i < limits.parts; ++i) {
    random.laws.emplace_back();
    random.problem.parts.emplace_back();
    const double t0 =
        i % 2 == 1 && i < 2 * pairs ? scale.back() * (0.1 + 0.55 * draw.uniform()) : 0.01 + 0.09 * draw.uniform();
    scale.push_back(t0);
    for (std::size_t p = 0; p < ways; ++p) {
      PlainLaw law = testing::random_law(draw, t0);
      if (i % 2 == 1) law.b *= draw.uniform();
      const double lo = t0 * (0.02 + 0.2 * draw.uniform());
      const double hi = draw.below(4) == 0 ? kInfinity : t0 * (0.8 + 3.0 * draw.uniform());
      random.laws[i].push_back(law);
      const bool single = draw.below(6) == 0;
      random.problem.parts[i].push_back({law.law(), single ? 0.5 * t0 : lo, single ? 0.5 * t0 : hi});
    }
  }
  for (std::size_t p = 0; p < pairs; ++p) {
    random.problem.pairs.push_back({2 * p + 1, 2 * p, draw.below(3) == 0 ? 2.0 / 3.0 : 0.5, left_out});
  }
  for (std::size_t l = 0; l < count; ++l) {
    double room = 0.0;
    for (std::size_t i = 0; i < limits.parts; ++i) {
      double effect = (0.1 + draw.uniform()) * draw.uniform() / (scale[i] * scale[i]);
      if (i % 2 == 1) {  // a tilt: its own effect, minus what it takes from the middle
        const double middle = limits.effects.back();
        effect = (draw.below(2) == 0 ? effect : 0.0) - middle * (draw.below(4) == 0 ? 1.0 : draw.uniform());
      }
      limits.effects.push_back(effect);
      room += std::max(effect, 0.0) * scale[i] * scale[i] * (0.1 + draw.uniform());
    }
    limits.room.push_back(room);
  }
  return random;
}

long double square(long double x) { return x * x; }

/// The least value of a convex function on [lo, hi], by ternary search.
template <class F>
long double least_of(const F& f, long double lo, long double hi) {
  for (int step = 0; step < 70; ++step) {
    const long double left = lo + (hi - lo) / 3;
    const long double right = hi - (hi - lo) / 3;
    (f(left) <= f(right) ? hi : lo) = f(left) <= f(right) ? right : left;
  }
  return f((lo + hi) / 2);
}

/// The Lagrangian lower bound for a problem with one process for each part, in long double and without the closed forms
/// of the engine.
long double dual_value(const RandomPairs& random, const std::vector<double>& multiplier) {
  const ToleranceLimits& limits = random.problem.limits;
  const auto price = [&](std::size_t part) {
    long double sum = 0;
    for (std::size_t l = 0; l < limits.count(); ++l)
      sum += static_cast<long double>(multiplier[l]) * limits.row(l)[part];
    return sum;
  };
  const auto law = [&](std::size_t part) { return random.laws[part][0]; };
  const auto bounds = [&](std::size_t part) { return random.problem.parts[part][0]; };
  long double bound = 0;
  for (const Within& pair : random.problem.pairs) {
    const long double own = price(pair.outer);
    const long double inner = price(pair.inner);
    const long double share = pair.share;
    const auto of_outer = [&](long double t) {
      const long double most = std::min<long double>(bounds(pair.inner).hi, std::sqrt(share) * t);
      const auto of_inner = [&](long double tilt) { return law(pair.inner).at(tilt) + inner * square(tilt); };
      return law(pair.outer).at(t) + own * square(t) + least_of(of_inner, bounds(pair.inner).lo, most);
    };
    const long double lo = std::max<long double>(bounds(pair.outer).lo, bounds(pair.inner).lo / std::sqrt(share));
    bound += least_of(of_outer, lo, std::min<long double>(bounds(pair.outer).hi, 10.0));
  }
  const std::size_t last = limits.parts - 1;
  const auto alone = [&](long double t) { return law(last).at(t) + price(last) * square(t); };
  bound += least_of(alone, bounds(last).lo, std::min<long double>(bounds(last).hi, 10.0));
  for (std::size_t l = 0; l < limits.count(); ++l) bound -= static_cast<long double>(multiplier[l]) * limits.room[l];
  return bound;
}

void expect_within_bounds(const AllocationProblem& problem, const Allocation& found, std::uint64_t number) {
  for (std::size_t i = 0; i < found.tolerance.size(); ++i) {
    if (std::ranges::count(found.left_out, i) > 0) continue;
    EXPECT_GE(found.tolerance[i], problem.parts[i][found.process[i]].lo) << number;
    EXPECT_LE(found.tolerance[i], problem.parts[i][found.process[i]].hi) << number;
  }
  for (const Within& pair : problem.pairs) {
    EXPECT_LE(square(found.tolerance[pair.inner]), pair.share * square(found.tolerance[pair.outer]) * (1.0 + 1e-15))
        << number;
  }
  EXPECT_LE(worst_use(problem.limits, found.tolerance).share, 1.0) << number;
}

TEST(RandomPairs, AreSolvedWithAProofOfTheirOwn) {
  std::size_t count = 0;
  for (std::uint64_t number = 0; number < 60; ++number) {
    const RandomPairs random = random_pairs(number, 1 + number % 4, 1, LeftOut::never);
    const AllocationOutcome outcome = least_cost(random.problem);
    const auto* found = std::get_if<LeastCost>(&outcome);
    if (found == nullptr) continue;
    ++count;
    const double cost = found->best.cost;
    expect_within_bounds(random.problem, found->best, number);
    EXPECT_LE(found->gap(), 1e-9 * cost) << number;
    EXPECT_GE(found->gap(), 0.0) << number;
    const auto dual = static_cast<double>(dual_value(random, found->multiplier));
    EXPECT_GE(dual, cost * (1.0 - 1e-9)) << number;
    EXPECT_LE(found->lower_bound, dual + 1e-13 * cost) << number;
    long double sum = 0;
    for (std::size_t i = 0; i < random.laws.size(); ++i) sum += random.laws[i][0].at(found->best.tolerance[i]);
    EXPECT_NEAR(cost, static_cast<double>(sum), 1e-13 * cost) << number;
  }
  EXPECT_GT(count, 50u);
}

/// The problem with only the chosen process of each part. out: for each pair, 1 if its orientation zone is left out.
AllocationProblem chosen(const AllocationProblem& problem, const std::vector<std::size_t>& process,
                         const std::vector<std::size_t>& out) {
  AllocationProblem one{problem.limits, {}, {}};
  for (std::size_t i = 0; i < process.size(); ++i) one.parts.push_back({problem.parts[i][process[i]]});
  for (std::size_t p = 0; p < out.size(); ++p) {
    const Within& pair = problem.pairs[p];
    if (out[p] == 0) {
      one.pairs.push_back({pair.inner, pair.outer, pair.share, LeftOut::never});
      continue;
    }
    one.parts[pair.inner] = {fixed_process(0.0)};
    for (std::size_t l = 0; l < one.limits.count(); ++l) {
      const std::size_t row = l * one.limits.parts;
      one.limits.effects[row + pair.outer] += pair.share * one.limits.effects[row + pair.inner];
      one.limits.effects[row + pair.inner] = 0.0;
    }
  }
  return one;
}

/// Whether in each pair the finest orientation zone fits within the coarsest location zone.
bool fits(const AllocationProblem& one) {
  return std::ranges::all_of(one.pairs, [&](const Within& pair) {
    const double most = one.parts[pair.outer][0].hi;
    return std::pow(one.parts[pair.inner][0].lo, 2) <= pair.share * most * most;
  });
}

/// The least costs of all choices of processes and left-out zones that can keep the limits, ascending. Each choice is
/// optimised separately.
std::vector<double> costs_of_all(const AllocationProblem& problem) {
  std::vector<double> costs;
  const std::size_t parts = problem.parts.size();
  std::vector<std::size_t> most;
  std::vector<std::size_t> choice;
  const auto add = [&](std::size_t ways) {
    most.push_back(ways);
    choice.push_back(0);
  };
  for (const auto& processes : problem.parts) add(processes.size());
  for (const Within& pair : problem.pairs) add(pair.left_out == LeftOut::never ? 1 : 2);
  for (std::size_t i = 0; i < choice.size();) {
    const std::vector<std::size_t> process(choice.begin(), choice.begin() + static_cast<std::ptrdiff_t>(parts));
    const std::vector<std::size_t> out(choice.begin() + static_cast<std::ptrdiff_t>(parts), choice.end());
    bool is_new = true;  // a part that is left out has no choice of processes
    for (std::size_t p = 0; p < out.size(); ++p)
      is_new = is_new && (out[p] == 0 || process[problem.pairs[p].inner] == 0);
    const AllocationProblem one = chosen(problem, process, out);
    if (is_new && fits(one)) {
      const AllocationOutcome outcome = least_cost(one);
      if (const auto* found = std::get_if<LeastCost>(&outcome)) costs.push_back(found->best.cost);
    }
    for (i = 0; i < choice.size() && ++choice[i] == most[i]; ++i) choice[i] = 0;
  }
  std::ranges::sort(costs);
  return costs;
}

TEST(RandomPairs, AreKeptOrLeftOutAsTheBestOfAllSays) {
  std::size_t count = 0;
  std::size_t left_out = 0;
  std::size_t kept = 0;
  for (std::uint64_t number = 0; number < 120; ++number) {
    const std::size_t ways = 1 + number % 2;
    const RandomPairs random = random_pairs(number + 1000, ways == 1 ? 4 : 2, ways, LeftOut::by_choice);
    const std::vector<double> costs = costs_of_all(random.problem);
    SearchOptions options;
    options.alternatives = 2;
    const AllocationOutcome outcome = least_cost(random.problem, options);
    const auto* found = std::get_if<LeastCost>(&outcome);
    ASSERT_EQ(found == nullptr, costs.empty()) << number;
    if (found == nullptr) continue;
    ++count;
    left_out += found->best.left_out.size();
    kept += random.problem.pairs.size() - found->best.left_out.size();
    expect_within_bounds(random.problem, found->best, number);
    EXPECT_NEAR(found->best.cost, costs[0], 1e-9 * costs[0]) << number;
    EXPECT_LE(found->lower_bound, costs[0] * (1.0 + 1e-14)) << number;
    EXPECT_LE(found->gap(), 1.1e-9 * costs[0]) << number;
    ASSERT_EQ(found->next.size(), std::min<std::size_t>(2, costs.size() - 1)) << number;
    for (std::size_t k = 0; k < found->next.size(); ++k) {
      EXPECT_NEAR(found->next[k].cost, costs[k + 1], 2e-9 * costs[k + 1]) << number;
    }
  }
  EXPECT_GT(count, 100u);
  EXPECT_GT(left_out, 50u);
  EXPECT_GT(kept, 50u);
}

TEST(RandomPairs, WithListsOfValuesAreSearchedWell) {
  AllocationProblem problem = delta(0.1);
  for (Within& pair : problem.pairs) pair.left_out = LeftOut::by_choice;
  std::vector<double> values;
  for (int k = 0; k < 25; ++k) values.push_back(0.001 * std::pow(10.0, k / 10.0));
  for (std::size_t i = 0; i < kDelta.size(); ++i) {
    problem.parts[i] = available_values(problem.parts[i][0].cost, values);
  }
  const LeastCost found = solved(problem, {.relative_gap = 1e-6});
  EXPECT_LE(found.gap(), 1e-6 * found.best.cost);
  EXPECT_GT(found.best.cost, 1094.8038567464941);
  EXPECT_LT(found.best.cost, 1.1 * 1094.8038567464941);
  EXPECT_LT(found.nodes, 5000u);
  expect_within_bounds(problem, found.best, 0);
}

TEST(RandomPairs, OfManyFeaturesAreSolvedAtOnce) {
  const RandomPairs random = random_pairs(4, 30, 1, LeftOut::by_choice);
  const LeastCost found = solved(random.problem, {.relative_gap = 1e-6});
  EXPECT_LE(found.gap(), 1e-6 * found.best.cost);
  EXPECT_LT(found.nodes, 2000u);
}

TEST(PairOfParts, WithAGivenTiltHasItUnlessThatIsVoid) {
  AllocationProblem problem{
      {Stacking::root_sum_square, 2, {1.0, 0.5}, {1.0}}, {}, {{1, 0, 0.5, LeftOut::where_it_is_void}}};
  problem.parts = {{{CostLaw::reciprocal(0.0, 1.0), 0.0, kInfinity}}, {fixed_process(0.1)}};
  LeastCost found = solved(problem);
  EXPECT_NEAR(found.best.tolerance[0], std::sqrt(1.0 - 0.5 * 0.01), 1e-9);
  EXPECT_EQ(found.best.tolerance[1], 0.1);
  EXPECT_TRUE(found.best.left_out.empty());
  problem.parts[1] = {fixed_process(2.0)};
  found = solved(problem);
  EXPECT_NEAR(found.best.tolerance[0], std::sqrt(1.0 / 1.25), 1e-9);
  EXPECT_EQ(found.best.left_out, std::vector<std::size_t>{1});
}

TEST(PairOfParts, WithoutEffectNeedsAnEnd) {
  AllocationProblem problem{{Stacking::root_sum_square, 3, {0, 0, 1}, {1.0}}, {}, {{1, 0, 0.5, LeftOut::never}}};
  const CostLaw law = CostLaw::reciprocal(0.0, 1.0);
  problem.parts = {{{law, 0.0, kInfinity}}, {{law, 0.0, kInfinity}}, {{law, 0.0, kInfinity}}};
  EXPECT_EQ(std::get<Unbounded>(least_cost(problem)).parts, std::vector<std::size_t>{0});
  problem.parts[0][0].hi = 4.0;
  const LeastCost found = solved(problem);
  EXPECT_EQ(found.best.tolerance[0], 4.0);
  EXPECT_DOUBLE_EQ(found.best.tolerance[1], 4.0 * std::sqrt(0.5));
  EXPECT_NEAR(found.best.tolerance[2], 1.0, 1e-12);
}

TEST(PairOfParts, ThatBreaksALimitAtItsLowestIsInfeasible) {
  // The limit needs least room if the tilt is as coarse as the location allows: 4 (1 - 0.5 x 0.5) = 3.
  AllocationProblem problem{{Stacking::root_sum_square, 2, {1.0, -0.5}, {2.9}}, {}, {{1, 0, 0.5, LeftOut::never}}};
  problem.parts = {{{CostLaw::reciprocal(0.0, 1.0), 2.0, 9.0}}, {{CostLaw::reciprocal(0.0, 1.0), 0.1, 9.0}}};
  const auto broken = std::get<Infeasible>(least_cost(problem));
  EXPECT_EQ(broken.limit, 0u);
  EXPECT_NEAR(broken.need, 3.0, 1e-12);
  EXPECT_EQ(broken.room, 2.9);
  problem.limits.room = {3.1};
  const LeastCost found = solved(problem);
  EXPECT_LE(found.gap(), 1e-9 * found.best.cost);
  // One limit wants a fine tilt, the other a coarse one: each can be kept, but not both.
  problem.limits.effects = {1.0, -0.5, 0.0, 1.0};
  problem.limits.room = {3.5, 0.9};
  EXPECT_TRUE(std::holds_alternative<Infeasible>(least_cost(problem)));
  problem.limits.room = {3.5, 1.1};
  EXPECT_LE(solved(problem).use.share, 1.0);
}

TEST(PairOfParts, WithHardlyAnyRoomIsSolved) {
  AllocationProblem problem{{Stacking::root_sum_square, 2, {1.0, -0.5}, {3.0}}, {}, {{1, 0, 0.5, LeftOut::by_choice}}};
  problem.parts = {{{CostLaw::reciprocal(0.0, 1.0), 2.0, 9.0}}, {{CostLaw::reciprocal(0.0, 1.0), 0.1, 9.0}}};
  for (const double more : {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3}) {
    problem.limits.room = {3.0 * (1.0 + more)};
    const LeastCost found = solved(problem);
    EXPECT_LE(found.use.share, 1.0) << more;
    EXPECT_EQ(found.best.left_out, std::vector<std::size_t>{1}) << more;
    EXPECT_NEAR(found.best.cost, 0.5, 1e-3) << more;
  }
}

}  // namespace
}  // namespace poesy
