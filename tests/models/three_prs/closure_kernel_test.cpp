#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/models/three_prs/closure_samples.h"
#include "tests/support/isa.h"

// Compares the kernels of every instruction set with close_limbs().

namespace poesy::three_prs {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Blocks of samples with errors of this standard deviation (m, rad): all errors vary, or a single one.
std::vector<ClosureSamples> every_block(double size, std::size_t count) {
  std::mt19937_64 engine(11);
  std::vector<ClosureSamples> all;
  for (const std::vector<double>& pose : random_poses(6, 12)) {
    all.push_back(all_varied(pose, size, 4 * count, engine));
    for (std::size_t factor = all.size() % 7; factor < kFactors; factor += 7) {
      all.push_back(one_varied(pose, factor, size, count, engine));
    }
  }
  return all;
}

class EveryClosureKernel : public test::WithIsa {};

TEST_P(EveryClosureKernel, EndsAsTheReferenceDoes) {
  // A tolerance far above rounding, so that rounding does not decide which step is the last one.
  SolverOptions options;
  options.tolerance = 1e-9;
  std::size_t compared = 0, total = 0;
  for (const double size : {1e-6, 1e-4, 1e-3, 1e-2, 5e-2}) {
    for (const ClosureSamples& samples : every_block(size, 19)) {
      const ClosureOutcome found = solve(samples, options);
      const ClosureOutcome truth = solve_by_reference(samples, options);
      for (std::size_t b = 0; b < samples.count; ++b, ++total) {
        // If Newton takes long to converge, rounding errors become large.
        if (truth.iterations[b] > 8) continue;
        ++compared;
        ASSERT_EQ(found.status[b], truth.status[b]) << size;
        ASSERT_EQ(found.iterations[b], truth.iterations[b]) << size;
        if (!solved(truth.status[b])) continue;
        ASSERT_LE((found.motion(b) - truth.motion(b)).cwiseAbs().maxCoeff(), 1e-13) << size;
      }
    }
  }
  EXPECT_GT(compared, total * 85 / 100) << "of " << total;
}

TEST_P(EveryClosureKernel, SolvesToRounding) {
  for (const double size : {1e-6, 1e-4, 1e-3, 1e-2}) {
    for (const ClosureSamples& samples : every_block(size, 19)) {
      const ClosureOutcome found = solve(samples, {});
      const ClosureOutcome truth = solve_by_reference(samples, {});
      for (std::size_t b = 0; b < samples.count; ++b) {
        ASSERT_TRUE(solved(found.status[b]) && solved(truth.status[b]));
        ASSERT_LE((found.motion(b) - truth.motion(b)).cwiseAbs().maxCoeff(), 1e-13) << size;
      }
    }
  }
}

TEST_P(EveryClosureKernel, StopsAtTheCap) {
  SolverOptions options;
  for (const int cap : {0, 1, 2}) {
    options.max_iterations = cap;
    options.tolerance = 1e-300;
    for (const ClosureSamples& samples : every_block(1e-2, 5)) {
      const ClosureOutcome found = solve(samples, options);
      const ClosureOutcome truth = solve_by_reference(samples, options);
      for (std::size_t b = 0; b < samples.count; ++b) {
        ASSERT_EQ(found.status[b], SolveStatus::iteration_cap);
        ASSERT_EQ(found.iterations[b], static_cast<std::uint32_t>(cap));
        ASSERT_LE((found.motion(b) - truth.motion(b)).cwiseAbs().maxCoeff(), 1e-13);
      }
    }
  }
}

TEST_P(EveryClosureKernel, SaysWhereNothingIsFinite) {
  std::mt19937_64 engine(13);
  ClosureSamples samples = all_varied({0.1, 0.2, 0.7}, 1e-3, 3 * kFactors, engine);
  for (std::size_t v = 0; v < kFactors; ++v) {
    samples.values[v * samples.count + v] = kNaN;
    samples.values[v * samples.count + kFactors + v] = kInfinity;
  }
  const ClosureOutcome found = solve(samples, {});
  for (std::size_t b = 0; b < samples.count; ++b) {
    if (b < 2 * kFactors) {
      EXPECT_EQ(found.status[b], SolveStatus::non_finite) << b;
      EXPECT_EQ(found.iterations[b], 0u);
    } else {
      EXPECT_TRUE(solved(found.status[b]));
    }
  }
}

TEST_P(EveryClosureKernel, SaysWhereThePoseIsSingular) {
  // The rods are horizontal, which is singular.
  std::mt19937_64 engine(17);
  ClosureSamples samples = all_varied({0.0, 0.0, 0.7}, 0.0, 21, engine);
  samples.geometry.l = samples.geometry.a - samples.geometry.c;
  for (LimbConfiguration& limb : samples.nominal.limbs) limb.q = samples.nominal.platform.p.z();
  const ClosureOutcome found = solve(samples, {});
  for (std::size_t b = 0; b < samples.count; ++b) {
    EXPECT_EQ(found.status[b], SolveStatus::singular);
    EXPECT_EQ(found.iterations[b], 0u);
    EXPECT_LE(found.motion(b).norm(), 1e-15);
  }
}

/// An error that has no effect alone is so large that its sine and cosine are out of the kernels' range.
TEST_P(EveryClosureKernel, TakesAnglesOfManyTurns) {
  std::mt19937_64 engine(19);
  ClosureSamples samples =
      varied_samples({0.1, 0.2, 0.7}, {FactorIndex(factor_of(1, Source::theta_B) + 1)}, 100.0, 50, engine);
  const ClosureOutcome found = solve(samples, {});
  for (std::size_t b = 0; b < samples.count; ++b) {
    EXPECT_TRUE(solved(found.status[b]));
    EXPECT_LE(found.motion(b).norm(), 1e-14);
  }
}

/// Carriage errors that move the platform from one pose to another, with rotations of up to more than 1.5 rad.
TEST_P(EveryClosureKernel, TurnsThePlatformByLargeAngles) {
  double largest = 0.0;
  for (const double tilt : {0.1, 0.3, 0.6, 0.8}) {
    ClosureSamples samples;
    samples.nominal = configuration(samples.geometry, {-tilt, 0.0, 0.8});
    const Configuration goal = configuration(samples.geometry, {tilt, 0.0, 0.8});
    samples.errors.assign(kFactors, 0.0);
    for (std::size_t i = 0; i < kLimbs; ++i) {
      samples.errors[factor_of(i, Source::q)] = goal.limbs[i].q - samples.nominal.limbs[i].q;
    }
    samples.count = 3;
    const ClosureOutcome found = solve(samples, {});
    const lie::Vector3<double> turn = lie::log<double>(goal.platform.R * samples.nominal.platform.R.transpose());
    for (std::size_t b = 0; b < samples.count; ++b) {
      ASSERT_TRUE(solved(found.status[b]));
      EXPECT_LE((found.motion(b).head<3>() - turn).norm(), 1e-13) << tilt;
      EXPECT_LE((found.motion(b).segment<3>(3) - (goal.platform.p - samples.nominal.platform.p)).norm(), 1e-13);
    }
    largest = std::max(largest, turn.norm());
  }
  EXPECT_GT(largest, 1.5);
}

/// The spherical joints are turned about z on a circle of another radius, which turns the platform back. The largest
/// angles are beyond the range of the kernels' logarithm.
TEST_P(EveryClosureKernel, TurnsThePlatformAThirdOfATurn) {
  struct Turn {
    double radius;
    double angle;
  };
  for (const Turn& turn : {Turn{1.0, 1.5}, Turn{1.0, 2.0}, Turn{0.4, 2.12}, Turn{0.4, 2.2}}) {
    ClosureSamples samples;
    samples.nominal = configuration(samples.geometry, {0.0, 0.0, 0.8});
    samples.errors.assign(kFactors, 0.0);
    for (std::size_t i = 0; i < kLimbs; ++i) {
      double* c = samples.errors.data() + factor_of(i, Source::c);
      c[0] = samples.geometry.c * (turn.radius * std::cos(turn.angle) - 1.0);
      c[1] = -samples.geometry.c * turn.radius * std::sin(turn.angle);
    }
    samples.count = 3;
    const ClosureOutcome found = solve(samples, {});
    for (std::size_t b = 0; b < samples.count; ++b) {
      ASSERT_TRUE(solved(found.status[b]));
      EXPECT_LE((found.motion(b).head<3>() - lie::Vector3<double>(0.0, 0.0, turn.angle)).norm(), 1e-13) << turn.angle;
      EXPECT_LE(found.motion(b).segment<2>(3).norm(), 1e-13);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Isa, EveryClosureKernel, testing::ValuesIn(test::kEveryIsa), test::isa_name);

}  // namespace
}  // namespace poesy::three_prs
