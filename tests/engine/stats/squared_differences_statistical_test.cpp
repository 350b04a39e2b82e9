// Coverage of the intervals of Sobol' indices from squared differences, by simulation.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"
#include "engine/stats/squared_differences.h"

namespace poesy {
namespace {

using Errors = std::vector<double>;

/// A function with known indices. normal: its errors are standard normal; otherwise uniform in (0, 1).
struct Known {
  std::string name;
  bool normal;
  std::function<double(const Errors&)> function;
  std::vector<double> S1;
  std::vector<double> ST;
};

double linear(const Errors& z) { return z[0] + 2.0 * z[1] + 0.5 * z[2]; }

double ishigami(const Errors& u) {
  const auto x = [&](std::size_t p) { return std::numbers::pi * (2.0 * u[p] - 1.0); };
  const double s = std::sin(x(1));
  return std::sin(x(0)) + 7.0 * s * s + 0.1 * std::pow(x(2), 4) * std::sin(x(0));
}

double folded(const Errors& z) { return std::abs(std::sqrt(0.8) * z[0] + std::sqrt(0.2) * z[1]); }

/// A log-normal response: skewed, and a product of functions of its errors.
double skewed(const Errors& z) { return std::exp(0.6 * z[0] + 0.3 * z[1]); }

std::vector<Known> known() {
  const double a = std::expm1(0.36);
  const double b = std::expm1(0.09);
  const double all = (1.0 + a) * (1.0 + b) - 1.0;
  return {{"linear", true, linear, {1.0 / 5.25, 4.0 / 5.25, 0.25 / 5.25}, {1.0 / 5.25, 4.0 / 5.25, 0.25 / 5.25}},
          {"Ishigami",
           false,
           ishigami,
           {0.31390519114781, 0.44241114479004, 0.0},
           {0.55758885520996, 0.44241114479004, 0.24368366406215}},
          {"folded", true, folded, {0.59887592, 0.03515699}, {0.96484301, 0.40112408}},
          {"skewed", true, skewed, {a / all, b / all}, {a * (1.0 + b) / all, b * (1.0 + a) / all}}};
}

/// [errors][n] Random errors of n samples, normal or uniform as the function asks.
std::vector<std::vector<double>> draws(const Known& known, std::size_t sample_set, std::size_t repetition,
                                       std::size_t n) {
  std::vector<std::vector<double>> rows(known.S1.size(), std::vector<double>(n));
  for (std::size_t p = 0; p < rows.size(); ++p) {
    fill_uniforms({11, Purpose::error_samples, FactorIndex(2 * p + sample_set), PoseIndex(repetition)}, SampleIndex(0),
                  rows[p]);
    if (known.normal) normal_quantiles(1.0, rows[p]);
  }
  return rows;
}

std::vector<double> values(const Known& known, const std::vector<std::vector<double>>& rows) {
  std::vector<double> list(rows.front().size());
  Errors errors(rows.size());
  for (std::size_t b = 0; b < list.size(); ++b) {
    for (std::size_t p = 0; p < rows.size(); ++p) errors[p] = rows[p][b];
    list[b] = known.function(errors);
  }
  return list;
}

struct CoverageOfBoth {
  double S1;
  double ST;
};

/// The shares of repetitions in which the 95 % intervals of S1 and ST contain the true indices of error p. n: samples.
CoverageOfBoth coverage(const Known& known, std::size_t p, std::size_t n, std::size_t repetitions) {
  std::size_t has_S1 = 0;
  std::size_t has_ST = 0;
  const std::vector<std::uint8_t> all(n, 1);
  for (std::size_t repetition = 0; repetition < repetitions; ++repetition) {
    auto rows = draws(known, 0, repetition, n);
    const auto others = draws(known, 1, repetition, n);
    const std::vector<double> a = values(known, rows);
    const std::vector<double> b = values(known, others);
    rows[p] = others[p];
    const std::vector<double> c = values(known, rows);
    std::vector<double> between(n);
    std::vector<double> total(n);
    std::vector<double> first(n);
    for (std::size_t k = 0; k < n; ++k) {
      between[k] = (a[k] - b[k]) * (a[k] - b[k]);
      total[k] = (a[k] - c[k]) * (a[k] - c[k]);
      first[k] = between[k] - (b[k] - c[k]) * (b[k] - c[k]);
    }
    const auto has = [&](const std::vector<double>& x, double index) {
      RatioSums sums;
      sums.add(x, between, all);
      const Interval interval = sums.estimate(0.95).interval;
      return interval.low <= index && index <= interval.high;
    };
    has_S1 += has(first, known.S1[p]) ? 1 : 0;
    has_ST += has(total, known.ST[p]) ? 1 : 0;
  }
  return {static_cast<double>(has_S1) / static_cast<double>(repetitions),
          static_cast<double>(has_ST) / static_cast<double>(repetitions)};
}

class Intervals : public ::testing::TestWithParam<std::size_t> {};

// The coverage may differ from 95 % by 1.5 percentage points plus 3.3 standard errors of the simulation (alpha = 0.1 %
// for each of 20 intervals).
TEST_P(Intervals, HaveTheIndexAsOftenAsTheySay) {
  const std::size_t n = GetParam();
  const std::size_t repetitions = n == 256 ? 3000 : 1000;
  const double allowed = 0.015 + 3.3 * std::sqrt(0.95 * 0.05 / static_cast<double>(repetitions));
  for (const Known& one : known()) {
    for (std::size_t p = 0; p < one.S1.size(); ++p) {
      const auto [S1, ST] = coverage(one, p, n, repetitions);
      EXPECT_NEAR(S1, 0.95, allowed) << one.name << " S1 of error " << p;
      EXPECT_NEAR(ST, 0.95, allowed) << one.name << " ST of error " << p;
      RecordProperty(one.name + "_S1_" + std::to_string(p), std::to_string(S1));
      RecordProperty(one.name + "_ST_" + std::to_string(p), std::to_string(ST));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, Intervals, ::testing::Values(256, 1024));

}  // namespace
}  // namespace poesy
