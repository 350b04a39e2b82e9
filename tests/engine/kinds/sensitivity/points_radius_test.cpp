#include "engine/kinds/sensitivity/points_radius.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "tests/engine/kinds/study_kinds.h"
#include "tests/support/kinds.h"

namespace poesy::sensitivity {
namespace {

using namespace test;

using Points = std::vector<PlatformPoint>;

/// Three points (m) whose centroid is not the origin of the platform. The first is 0.2 m from the centroid.
const Points kPoints{{1.2, 2.0, 0.0}, {0.9, 2.1, 0.0}, {0.9, 1.9, 0.0}};

/// The distance (m) of the first point from the centroid.
double radius_of(const Points& points) {
  double squares = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double middle = (points[0][k] + points[1][k] + points[2][k]) / 3.0;
    squares += (points[0][k] - middle) * (points[0][k] - middle);
  }
  return std::sqrt(squares);
}

/// A model with three errors. Their effects on the first response are as 1 : rho : 2 rho^2, with rho = own x radius /
/// 0.2 m. Their effects on the second response are as 1 : 2 : 3 and do not depend on the radius.
class RadiusModel final : public FakeModel {
 public:
  explicit RadiusModel(const Points& points, double own) : points_(points), rho_(own * radius_of(points) / 0.2) {}

  std::vector<PlatformPoint> metric_points() const override { return points_; }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions&) const override {
    return std::make_unique<RadiusEvaluator>(rho_);
  }

 private:
  class RadiusEvaluator final : public Evaluator {
   public:
    explicit RadiusEvaluator(double rho) : effects_{1.0, rho, 2.0 * rho * rho} {}

    void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
      const std::size_t factor = samples.varied[0].value;
      const double error = std::abs(samples.values[0]);
      outcomes.responses[0] = effects_[factor] * error;
      outcomes.responses[1] = static_cast<double>(factor + 1) * error;
      outcomes.status[0] = SolveStatus::converged;
      outcomes.iterations[0] = 1;
    }

   private:
    std::array<double, 3> effects_;
  };

  Points points_;
  double rho_;
};

CatalogEntry radius_entry(double own) {
  CatalogEntry entry;
  entry.description = FakeModel::describe();
  entry.description.fidelities = {"exact", "first-order"};
  entry.build = [own](auto, std::size_t) { return std::make_unique<RadiusModel>(kPoints, own); };
  entry.build_with_points = [own](auto, std::size_t, std::span<const PlatformPoint> points) {
    return std::make_unique<RadiusModel>(Points(points.begin(), points.end()), own);
  };
  return entry;
}

Array<double, axis::RadiusMultiple, axis::Response> correlations(const CatalogEntry& entry) {
  Study study = study_of(&kStudy, 10);
  study.mechanism.entry = &entry;
  study.analysis.factors = {FactorIndex(0), FactorIndex(1), FactorIndex(2)};
  return radius_rank_correlations(study, Prepared(study).plan);
}

// With own = 0.7 the effects are 1, 0.7, 0.98; with half the radius 1, 0.35, 0.245; with twice the radius 1, 1.4, 3.92.
// So one of three pairs changes its order with half the radius, and two pairs with twice the radius.
TEST(PointsRadius, IsComparedByTheOrderOfEffects) {
  const auto tau = correlations(radius_entry(0.7));
  ASSERT_EQ(tau.size(), 4U);
  EXPECT_DOUBLE_EQ(tau(0, 0), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(tau(1, 0), -1.0 / 3.0);
}

TEST(PointsRadius, IsNothingToAResponseThatDoesNotDependOnIt) {
  const auto tau = correlations(radius_entry(0.7));
  EXPECT_DOUBLE_EQ(tau(0, 1), 1.0);
  EXPECT_DOUBLE_EQ(tau(1, 1), 1.0);
}

// Refused points must not throw, because the study's result would be lost. The correlations are NaN.
TEST(PointsRadius, IsNotKnownWhereTheMechanismRefusesThePoints) {
  CatalogEntry entry = radius_entry(0.7);
  entry.build_with_points = [](auto, std::size_t, std::span<const PlatformPoint> points) {
    if (radius_of(Points(points.begin(), points.end())) > 0.3) throw std::invalid_argument("too far apart");
    return std::make_unique<RadiusModel>(Points(points.begin(), points.end()), 0.7);
  };
  const auto tau = correlations(entry);
  ASSERT_EQ(tau.size(), 4U);
  EXPECT_DOUBLE_EQ(tau(0, 0), 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(tau(1, 0)) && std::isnan(tau(1, 1)));
}

TEST(PointsRadius, IsNothingToAMechanismWithoutPointsOrFirstOrder) {
  CatalogEntry entry = radius_entry(0.7);
  entry.description.fidelities = {"exact"};
  EXPECT_TRUE(correlations(entry).empty());
  entry = radius_entry(0.7);
  entry.build_with_points = nullptr;
  EXPECT_TRUE(correlations(entry).empty());
}

}  // namespace
}  // namespace poesy::sensitivity
