// Coverage of the yield's interval that takes into account the scatter of machines and of measured parts, over random
// data sets.

#include <gtest/gtest.h>

#include <boost/random/mersenne_twister.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "engine/kinds/monte_carlo/part_sums.h"
#include "engine/random/distribution.h"
#include "engine/random/normal_copula.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"
#include "engine/stats/proportion.h"
#include "engine/stats/rank_correlation.h"
#include "tests/engine/stats/coverage.h"

namespace poesy::test {
namespace {

using Engine = boost::random::mt19937_64;

std::vector<double> normals(std::size_t count, Engine& engine) {
  std::vector<double> values(count);
  for (double& value : values) value = uniform_from_bits(engine());
  normal_quantiles(1.0, values);
  return values;
}

/// A machine is good if the magnitude of the sum of its errors is within a limit. The true errors are standard normal.
struct PartsCase {
  std::string name;
  std::size_t errors;
  std::size_t parts;         ///< number of parts on which each error is measured
  double correlation = 0.0;  ///< of any two errors; 0: the errors are treated as independent
  double yield = 0.95;       ///< true yield

  double limit() const {
    const auto k = static_cast<double>(errors);
    const double deviation = std::sqrt(k * (1.0 + (k - 1.0) * correlation));
    return deviation * normal_quantile(1.0, 0.5 + 0.5 * yield);
  }
};

/// [errors x count] Standard normal numbers. A common normal number gives any two errors this correlation.
std::vector<std::vector<double>> rows(std::size_t errors, std::size_t count, double correlation, Engine& engine) {
  std::vector<std::vector<double>> found(errors);
  const std::vector<double> common = normals(count, engine);
  for (std::vector<double>& row : found) {
    row = normals(count, engine);
    for (std::size_t b = 0; b < count; ++b) {
      row[b] = std::sqrt(correlation) * common[b] + std::sqrt(1.0 - correlation) * row[b];
    }
  }
  return found;
}

monte_carlo::PartGroups groups_of(const PartsCase& one, const std::vector<std::vector<double>>& measured) {
  monte_carlo::PartGroups groups;
  std::vector<SmoothedValues> parts;
  for (const std::vector<double>& values : measured) parts.emplace_back(values);
  if (one.correlation == 0.0) {
    for (std::size_t p = 0; p < parts.size(); ++p) groups.each.push_back(monte_carlo::part_group({p}, {parts[p]}, {}));
    return groups;
  }
  std::vector<double> correlation;
  std::vector<std::size_t> errors;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    errors.push_back(p);
    for (std::size_t q = 0; q < parts.size(); ++q) {
      const double rank = rank_correlation(measured[p], measured[q]);
      correlation.push_back(p == q ? 1.0 : 2.0 * std::sin(std::numbers::pi / 6.0 * rank));
    }
  }
  groups.each.push_back(monte_carlo::part_group(std::move(errors), std::move(parts), correlation));
  return groups;
}

/// Two intervals of the yield from one data set: with the scatter of machines and parts, and with that of machines
/// only.
struct TwoIntervals {
  Interval parts;
  Interval machines;
};

TwoIntervals intervals_of(const PartsCase& one, std::size_t machines, Engine& engine) {
  const monte_carlo::PartGroups groups = groups_of(one, rows(one.errors, one.parts, one.correlation, engine));
  std::vector<double> errors = normals(one.errors * machines, engine);
  std::vector<std::span<double>> drawn;
  for (std::size_t p = 0; p < one.errors; ++p) drawn.push_back(std::span(errors).subspan(p * machines, machines));
  std::vector<double> correlation;
  if (one.correlation != 0.0) {
    std::vector<double> matrix(one.errors * one.errors, 1.0);
    for (std::size_t p = 0; p < one.errors; ++p) {
      for (std::size_t q = 0; q < one.errors; ++q) {
        if (p == q) continue;
        const auto& parts = groups.each[0].parts;
        const double rank = rank_correlation(parts[p].values(), parts[q].values());
        matrix[p * one.errors + q] = 2.0 * std::sin(std::numbers::pi / 6.0 * rank);
      }
    }
    NormalCopula(matrix).correlate(drawn);
  }
  for (const monte_carlo::PartGroup& group : groups.each) {
    for (std::size_t k = 0; k < group.errors.size(); ++k) {
      const std::span<const double> values = group.parts[k].values();
      Distribution::measured({values.begin(), values.end()}).transform_scores(drawn[group.errors[k]]);
    }
  }
  std::vector<std::uint8_t> rejected;
  std::uint64_t rejects = 0;
  for (std::size_t b = 0; b < machines; ++b) {
    double sum = 0.0;
    for (const std::span<double> row : drawn) sum += row[b];
    rejected.push_back(std::abs(sum) > one.limit() ? 1 : 0);
    rejects += rejected.back();
  }
  monte_carlo::PartSums sums(groups);
  sums.add(errors, rejected);
  return {sums.interval(0.95), proportion(machines - rejects, machines, 0.95).interval};
}

class PartsInterval : public ::testing::TestWithParam<PartsCase> {};

TEST_P(PartsInterval, HoldsTheYield) {
  constexpr int kSets = 400;
  constexpr std::size_t kMachines = 10'000;
  const PartsCase& one = GetParam();
  Engine engine(one.parts + one.errors);
  Coverage parts;
  Coverage machines;
  for (int set = 0; set < kSets; ++set) {
    const TwoIntervals found = intervals_of(one, kMachines, engine);
    parts.add(found.parts, one.yield);
    machines.add(found.machines, one.yield);
  }
  RecordProperty(one.name, std::to_string(parts.share()));
  RecordProperty(one.name + "_machines", std::to_string(machines.share()));
  // The coverage may be four percentage points below 95 %, less 3.1 standard errors of this simulation (alpha = 0.1 %).
  EXPECT_GT(parts.share(), 0.91 - 3.1 * std::sqrt(0.09 * 0.91 / kSets)) << one.name;
  EXPECT_LT(machines.share(), 0.5) << one.name;
}

INSTANTIATE_TEST_SUITE_P(Cases, PartsInterval,
                         ::testing::Values(PartsCase{"six_of_8", 6, 8}, PartsCase{"six_of_20", 6, 20},
                                           PartsCase{"six_of_40", 6, 40},
                                           PartsCase{"six_of_40_at_99", 6, 40, 0.0, 0.99},
                                           PartsCase{"one_of_40", 1, 40}, PartsCase{"correlated_of_40", 3, 40, 0.6}),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace poesy::test
