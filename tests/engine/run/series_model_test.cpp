#include "engine/run/series_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "models/registry.h"
#include "tests/support/function_model.h"

namespace poesy {
namespace {

/// The outcomes of samples in which one error varies.
struct Outcomes {
  std::vector<double> responses;  ///< [responses x samples]
  std::vector<SolveStatus> status;

  std::size_t by_series() const { return static_cast<std::size_t>(std::ranges::count(status, SolveStatus::by_series)); }
};

Outcomes evaluated(const Model& model, const std::vector<double>& pose, FactorIndex factor,
                   const std::vector<double>& values, double range) {
  const std::vector<double> errors(model.description().factors.size(), 0.0);
  const std::vector<FactorIndex> varied{factor};
  Outcomes found{std::vector<double>(model.description().responses.size() * values.size()),
                 std::vector<SolveStatus>(values.size())};
  std::vector<std::uint32_t> iterations(values.size());
  model.evaluator({.tolerance = model.description().tolerance})
      ->evaluate({pose, errors, varied, values, values.size(), range}, {found.responses, found.status, iterations, {}});
  return found;
}

/// A model with one error e and the response y = f(e).
class Curve : public test::FunctionModel {
 public:
  using Function = std::function<double(double error)>;
  explicit Curve(const Function& f, bool is_magnitude = false)
      : FunctionModel(1, {"y"},
                      [f](std::span<const double> errors, double, std::span<double> y) { y[0] = f(errors[0]); }),
        description_(FunctionModel::description()) {
    description_.responses[0].has_no_sign = is_magnitude;
  }
  const ModelDescription& description() const override { return description_; }

 private:
  ModelDescription description_;
};

constexpr double kRange = 2.0;

std::vector<double> drawn(double largest, std::size_t count = 1000) {
  std::mt19937_64 random(5);
  std::vector<double> values;
  while (values.size() < count) values.push_back(largest * (static_cast<double>(random()) / 0x1p63 - 1.0));
  return values;
}

/// Compares the responses of the series model with the function. Returns the number of samples that were evaluated by
/// series.
std::size_t by_series(const Curve::Function& f, bool is_magnitude, double largest = kRange) {
  const auto model = with_series(std::make_shared<Curve>(f, is_magnitude));
  const std::vector<double> values = drawn(largest);
  const Outcomes found = evaluated(*model, {0.0}, FactorIndex(0), values, kRange);
  double most = 0.0;
  for (const double e : {-kRange, kRange}) most = std::max(most, std::abs(f(e)));
  for (std::size_t b = 0; b < values.size(); ++b) {
    EXPECT_NEAR(found.responses[b], f(values[b]), 1e-14 * most) << values[b];
  }
  return found.by_series();
}

TEST(SeriesModel, ReplacesSolvesOfSmoothResponses) {
  EXPECT_EQ(by_series([](double e) { return std::sin(0.3 * e + 0.1); }, false), 1000u);
  EXPECT_EQ(by_series([](double e) { return std::abs(std::sin(0.3 * e)) * (1.0 + 0.1 * e); }, true), 1000u);
  EXPECT_EQ(by_series([](double e) { return e * e * std::exp(0.1 * e); }, true), 1000u);
  EXPECT_EQ(by_series([](double e) { return std::hypot(1.0, 0.3 * e - 0.2); }, true), 1000u);
  EXPECT_EQ(by_series([](double) { return 0.0; }, true), 1000u);
}

TEST(SeriesModel, SolvesWhatIsNotSmooth) {
  EXPECT_EQ(by_series([](double e) { return std::abs(e - 0.3); }, false), 0u);
  EXPECT_EQ(by_series([](double e) { return std::cos(9.0 * e); }, false), 0u);
}

TEST(SeriesModel, SolvesWhereTheCertificateFails) {
  // The function is constant at all nodes of the series, but not at the first check point, 0.
  EXPECT_EQ(by_series([](double e) { return std::abs(e) < 0.05 ? 2.0 : 1.0; }, false), 0u);
}

TEST(SeriesModel, SolvesBeyondTheRangeAndNearARoot) {
  const std::size_t inside = by_series([](double e) { return std::sin(0.3 * e); }, false, 1.5 * kRange);
  EXPECT_GT(inside, 600u);
  EXPECT_LT(inside, 730u);
  // The series is of the square of the response, which has too few digits near its zero at 0.7.
  const std::size_t far_from_root = by_series([](double e) { return std::abs(0.7 - e); }, true);
  EXPECT_GT(far_from_root, 900u);
  EXPECT_LT(far_from_root, 1000u);
}

TEST(SeriesModel, DoesNotDependOnTheBlock) {
  const auto model = with_series(std::make_shared<Curve>([](double e) { return std::abs(std::sin(0.3 * e)); }, true));
  const std::vector<double> values = drawn(1.1 * kRange, 100);
  const Outcomes together = evaluated(*model, {0.0}, FactorIndex(0), values, kRange);
  for (std::size_t b = 0; b < values.size(); ++b) {
    const Outcomes alone = evaluated(*model, {0.0}, FactorIndex(0), {values[b]}, kRange);
    EXPECT_EQ(alone.responses[0], together.responses[b]);
    EXPECT_EQ(alone.status[0], together.status[b]);
  }
}

TEST(SeriesModel, LeavesOtherBlocksToTheModel) {
  const auto model = with_series(std::make_shared<Curve>([](double e) { return e; }));
  EXPECT_EQ(evaluated(*model, {0.0}, FactorIndex(0), {0.5}, 0.0).by_series(), 0u);
}

/// The largest differences between series and solves (rad, m), and the number of samples evaluated by series.
struct Differences {
  double angle = 0.0;
  double length = 0.0;
  std::size_t by_series = 0;
};

/// Compares series and solves for each error at one pose. size: standard deviation of the errors (mm or deg).
void compare(const std::shared_ptr<const Model>& solved, const std::vector<double>& pose, double size,
             std::size_t samples, Differences& most) {
  const auto model = with_series(solved);
  const ModelDescription& description = solved->description();
  for (std::size_t f = 0; f < description.factors.size(); ++f) {
    const double unit = description.factors[f].dimension == Dimension::angle ? std::numbers::pi / 180.0 : 1e-3;
    const double range = 4.0 * size * unit;
    const std::vector<double> values = drawn(range, samples);
    const Outcomes found = evaluated(*model, pose, FactorIndex(f), values, range);
    const Outcomes truth = evaluated(*solved, pose, FactorIndex(f), values, range);
    most.by_series += found.by_series();
    for (std::size_t k = 0; k < found.responses.size(); ++k) {
      const bool is_angle = description.responses[k / samples].dimension == Dimension::angle;
      double& largest = is_angle ? most.angle : most.length;
      largest = std::max(largest, std::abs(found.responses[k] - truth.responses[k]));
    }
  }
}

TEST(SeriesModel, IsAsPreciseAsSolves) {
  const CatalogEntry& entry = by_metric(*find(registry(), "2upr-rpu"), "platform");
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  const std::shared_ptr<const Model> solved = entry.build(geometry, 0);
  for (const double size : {0.01, 0.1, 1.0}) {
    Differences most;
    for (const double z : {-0.2, -0.22, -0.25, -0.28}) compare(solved, {z, 6.0 * z + 1.4, 0.3}, size, 36, most);
    EXPECT_LE(most.angle, 1e-13) << size;
    EXPECT_LE(most.length, 1e-14) << size;
    EXPECT_GT(most.by_series, 9000u) << size;  // of 10 224 samples
  }
}

}  // namespace
}  // namespace poesy
