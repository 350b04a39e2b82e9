#include "engine/stats/chebyshev_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace poesy {
namespace {

constexpr std::size_t kNodes = ChebyshevSeries::kNodes;

ChebyshevSeries series_of(double (*function)(double)) {
  std::vector<double> values;
  for (const double x : ChebyshevSeries::nodes()) values.push_back(function(x));
  return ChebyshevSeries(values);
}

std::vector<double> evaluated(const ChebyshevSeries& series, const std::vector<double>& x) {
  std::vector<double> values(x.size());
  series.evaluate(x, values);
  return values;
}

std::vector<double> positions(std::size_t count) {
  std::vector<double> x;
  for (std::size_t k = 0; k < count; ++k)
    x.push_back(2.0 * static_cast<double>(k) / static_cast<double>(count - 1) - 1);
  return x;
}

TEST(ChebyshevSeries, IsASmoothFunction) {
  const ChebyshevSeries series = series_of([](double x) { return std::exp(0.5 * x); });
  EXPECT_LT(series.tail(), 1e-15);
  const std::vector<double> x = positions(101);
  const std::vector<double> values = evaluated(series, x);
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(values[k], std::exp(0.5 * x[k]), 2e-15);
}

TEST(ChebyshevSeries, HasATailIfTheFunctionIsNotSmooth) {
  EXPECT_GT(series_of([](double x) { return std::abs(x - 0.3); }).tail(), 1e-3);
  EXPECT_GT(series_of([](double x) { return 1.0 / (1.0 + 25.0 * x * x); }).tail(), 1e-3);
}

TEST(ChebyshevSeries, WithoutTermsIsZero) {
  EXPECT_EQ(evaluated(ChebyshevSeries(), {-1.0, 0.2}), (std::vector<double>{0.0, 0.0}));
  EXPECT_EQ(evaluated(series_of([](double) { return 0.0; }), {0.5}), std::vector<double>{0.0});
}

TEST(ChebyshevSeries, AValueDoesNotDependOnOtherPositions) {
  const ChebyshevSeries series = series_of([](double x) { return std::sin(2.0 * x); });
  const std::vector<double> x = positions(77);
  const std::vector<double> together = evaluated(series, x);
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_EQ(evaluated(series, {x[k]})[0], together[k]);
}

}  // namespace
}  // namespace poesy
