#include "models/assembly/continuation.h"

#include <cmath>

#include "tests/models/assembly/made.h"

// Compares solutions that are followed from the perfect machine with closed forms.
namespace poesy::assembly {
namespace {

/// Geometry of flat-delta (m): three rods of length kRod hold the platform kBelow below their other ends, at the
/// horizontal distance kAcross.
constexpr double kAcross = 0.160;
constexpr double kBelow = 0.005;
const double kRod = std::hypot(kAcross, kBelow);

/// The solution of flat-delta if its three rods are longer by this (m).
Solution with_rods(double longer, const SolverOptions& options = kOptions) {
  const std::string text = file::text_of("flat-delta");
  const AssemblyModel model = made(text, Metric::platform);
  EXPECT_FALSE(model.over_constrained);
  const Nominal pose = model.at(std::vector<double>{0.0, 0.0, 0.2});
  return Continuation(model, options)
      .solve(pose, named_errors(text, {{"rod_1", longer}, {"rod_2", longer}, {"rod_3", longer}}));
}

TEST(Continuation, FollowsThePlatformOfThreeRods) {
  for (const double longer : {1e-6, 1e-4, 1e-3, 1e-2, 4e-2}) {
    const Solution found = with_rods(longer);
    ASSERT_TRUE(solved(found.status)) << longer;
    const double below = std::sqrt((kRod + longer) * (kRod + longer) - kAcross * kAcross);
    EXPECT_NEAR(found.bodies[kPlatform].p.z(), 0.205 - below, 1e-12) << longer;
  }
}

TEST(Continuation, ShortensItsStrides) {
  const Solution near = with_rods(1e-6);
  EXPECT_LE(near.iterations, 8U);  // one step of the continuation, then the last solve
  EXPECT_EQ(near.steps.size(), near.iterations);
  const Solution far = with_rods(1e-2);  // then the platform is eleven times as far from the singularity
  EXPECT_GT(far.iterations, 2 * near.iterations);
  EXPECT_EQ(far.steps.size(), far.iterations);
}

TEST(Continuation, EndsWhereThreeRodsAreFlat) {
  const double most = kRod - kAcross;
  EXPECT_TRUE(solved(with_rods(-0.9999 * most).status));
  for (const double share : {1.0001, 2.0, 50.0}) {
    EXPECT_EQ(with_rods(-share * most).status, SolveStatus::not_assembled) << share;
  }
}

TEST(Continuation, SaysHowElseItEnds) {
  EXPECT_EQ(with_rods(std::nan("")).status, SolveStatus::non_finite);
  SolverOptions few = kOptions;
  few.max_iterations = 2;
  EXPECT_EQ(with_rods(1e-3, few).status, SolveStatus::iteration_cap);
}

}  // namespace
}  // namespace poesy::assembly
