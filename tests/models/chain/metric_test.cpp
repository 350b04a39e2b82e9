#include "models/chain/metric.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/models/chain/random_chain.h"

namespace poesy::chain {
namespace {

using Vector3 = lie::Vector3<double>;

std::vector<Vector3> random_points(std::size_t count, std::mt19937_64& engine) {
  std::vector<Vector3> points;
  for (std::size_t n = 0; n < count; ++n) points.emplace_back(lie::random_screw(1.0, engine).tail<3>());
  return points;
}

TEST(MetricOfPoints, IsTheirRootMeanSquareDisplacement) {
  std::mt19937_64 engine(3);
  for (int n = 0; n < 100; ++n) {
    const std::vector<Vector3> points = random_points(3 + static_cast<std::size_t>(n) % 4, engine);
    const lie::Screw<double> twist = lie::random_screw(1.0, engine);
    double sum = 0.0;
    for (const Vector3& point : points) {
      // The velocity of the point by finite differences of the motion.
      constexpr double kStep = 1e-6;
      const auto moved = [&](double t) -> Vector3 {
        const auto g = lie::exp(lie::Screw<double>(t * twist));
        return g.R * point + g.p;
      };
      sum += ((moved(kStep) - moved(-kStep)) / (2.0 * kStep)).squaredNorm();
    }
    const double found = twist.dot(metric_of_points(points) * twist);
    EXPECT_NEAR(found, sum / static_cast<double>(points.size()), 1e-8 * (1.0 + found));
  }
}

TEST(MetricOfPoints, AreOnALineWhereOneTurnMovesNone) {
  std::mt19937_64 engine(5);
  for (int n = 0; n < 50; ++n) {
    const std::vector<Vector3> ends = random_points(2, engine);
    std::vector<Vector3> points{ends[0], ends[1], ends[0] + 0.3 * (ends[1] - ends[0])};
    EXPECT_TRUE(are_on_a_line(points));
    EXPECT_TRUE(are_on_a_line(std::vector{ends[0], ends[0], ends[0]}));
    const Vector3 aside = (ends[1] - ends[0]).cross(Vector3(1.0, 2.0, 3.0)).normalized();
    points.push_back(ends[0] + 1e-4 * (ends[1] - ends[0]).norm() * aside);
    EXPECT_FALSE(are_on_a_line(points));
  }
}

}  // namespace
}  // namespace poesy::chain
