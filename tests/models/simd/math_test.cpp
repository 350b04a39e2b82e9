#include "models/simd/math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "models/simd/number.h"
#include "tests/models/simd/batch.h"
#include "tests/support/isa.h"

namespace poesy::simd {

Batch plain_batch() { return {sin_cos_rows<Number>, operate_rows<Number>}; }

namespace {

Batch batch_of(const std::string& isa) {
#if defined(__x86_64__)
  if (isa == "avx2") return avx2_batch();
  if (isa == "avx512") return avx512_batch();
#elif defined(__aarch64__)
  if (isa == "neon") return neon_batch();
#endif
  return plain_batch();
}

struct Angles {
  std::vector<double> x;
  std::vector<double> sines;
  std::vector<double> cosines;
};

Angles angles_of(const Batch& batch, std::vector<double> x) {
  while (x.size() % 8 != 0) x.push_back(0.0);
  Angles angles{x, std::vector<double>(x.size()), std::vector<double>(x.size())};
  batch.sin_cos(x.data(), x.size(), angles.sines.data(), angles.cosines.data());
  return angles;
}

/// Random angles (rad) of both signs with magnitudes from 1e-12 to 100.
std::vector<double> wide_angles(std::size_t count) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> uniform(-100.0, 100.0);
  std::uniform_real_distribution<double> decades(-12.0, 2.0);
  std::vector<double> x;
  for (std::size_t n = 0; n < count; ++n) {
    const double value = uniform(engine);
    x.push_back(n % 2 == 0 ? value : std::copysign(std::pow(10.0, decades(engine)), value));
  }
  return x;
}

/// All multiples of pi/4 within +-100, their neighbouring doubles, and angles close to them.
std::vector<double> near_quarter_turns() {
  std::vector<double> x;
  for (int n = -127; n <= 127; ++n) {
    const double at = n * std::numbers::pi / 4.0;
    x.insert(x.end(), {at, std::nextafter(at, 1e3), std::nextafter(at, -1e3)});
    for (double off = 1e-15; off < 0.1; off *= 10.0) x.insert(x.end(), {at + off, at - off});
  }
  return x;
}

double ulp(double x) {
  const double size = std::abs(x);
  return std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
}

/// The error in units in the last place of the truth. Errors below `floor` count as 0.
double error_in_ulps(double value, long double truth, double floor) {
  const long double error = std::abs(static_cast<long double>(value) - truth);
  if (error < static_cast<long double>(floor)) return 0.0;
  return static_cast<double>(error) / ulp(static_cast<double>(truth));
}

double worst_error(const Angles& angles, double floor) {
  double worst = 0.0;
  for (std::size_t n = 0; n < angles.x.size(); ++n) {
    const auto x = static_cast<long double>(angles.x[n]);
    worst = std::max(worst, error_in_ulps(angles.sines[n], std::sin(x), floor));
    worst = std::max(worst, error_in_ulps(angles.cosines[n], std::cos(x), floor));
  }
  return worst;
}

class EveryBatch : public test::WithIsa {
 protected:
  Batch batch() const { return batch_of(GetParam()); }
};

TEST_P(EveryBatch, SineAndCosineAreWithinTwoUlps) {
  EXPECT_LE(worst_error(angles_of(batch(), wide_angles(400000)), 0.0), 2.0);
}

TEST_P(EveryBatch, SineAndCosineKeepTheirErrorNearQuarterTurns) {
  // Near a zero of sine or cosine the error is that of pi/2 stored in two parts: 1e-26 per quarter turn. This is many
  // units in the last place of the small value, but far below the rounding of the other function.
  EXPECT_LE(worst_error(angles_of(batch(), near_quarter_turns()), 64 * 1e-26), 2.0);
}

TEST_P(EveryBatch, SineAndCosineKeepTheirSymmetry) {
  const Angles angles = angles_of(batch(), wide_angles(20000));
  std::vector<double> negative = angles.x;
  for (double& x : negative) x = -x;
  const Angles mirrored = angles_of(batch(), negative);
  for (std::size_t n = 0; n < angles.x.size(); ++n) {
    ASSERT_EQ(mirrored.sines[n], -angles.sines[n]) << angles.x[n];
    ASSERT_EQ(mirrored.cosines[n], angles.cosines[n]) << angles.x[n];
  }
}

TEST_P(EveryBatch, SineAndCosineOfNothingAreNotNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Angles angles = angles_of(batch(), {nan, infinity, -infinity, 0.0, -0.0});
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_TRUE(std::isnan(angles.sines[n]));
    EXPECT_TRUE(std::isnan(angles.cosines[n]));
  }
  for (std::size_t n = 3; n < 5; ++n) {
    EXPECT_EQ(angles.sines[n], 0.0);
    EXPECT_EQ(angles.cosines[n], 1.0);
  }
}

/// Operands of all kinds (zeros, infinities, subnormals, ...) in all combinations, and random ones.
struct Operands {
  std::vector<double> a, b, c;
};

Operands operands() {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> kinds{0.0,  -0.0,  1.0,  -1.0,     0.5,       -0.5, 1.5,    2.5,
                                  -2.5, 1e300, -3.7, infinity, -infinity, 0.1,  5e-324, -1e-310};
  Operands all;
  for (const double a : kinds) {
    for (const double b : kinds) {
      for (const double c : kinds) {
        all.a.push_back(a);
        all.b.push_back(b);
        all.c.push_back(c);
      }
    }
  }
  std::mt19937_64 engine(6);
  std::normal_distribution<double> normal;
  for (std::size_t n = 0; n < 8000; ++n) {
    all.a.push_back(normal(engine));
    all.b.push_back(normal(engine));
    // Where the product cancels, a fused multiply-add differs from two roundings.
    all.c.push_back(n % 2 == 0 ? normal(engine) : -all.a.back() * all.b.back());
  }
  return all;
}

/// The expected results of the operations, in plain C++. fused: whether a multiply-add rounds once.
std::vector<double> expected(double a, double b, double c, bool fused) {
  const double product_sum = fused ? std::fma(a, b, c) : a * b + c;
  const double sum_less_product = fused ? std::fma(-a, b, c) : c - a * b;
  const double words = (a < b ? 5.0 : 0.0) + ((a > b && !(b < c)) || c > a ? 2.0 : 0.0);
  return {a + b,
          a - b,
          a * b,
          a / b,
          product_sum,
          sum_less_product,
          std::sqrt(std::abs(a)),
          std::nearbyint(a),
          a > b ? a : b,
          a < b ? a : b,
          words};
}

TEST_P(EveryBatch, OperationsRoundOnce) {
  const Operands all = operands();
  const std::size_t count = all.a.size();
  std::vector<double> out(kOperations * count);
  batch().operate(all.a.data(), all.b.data(), all.c.data(), count, out.data());
  const bool fused = std::string(GetParam()) != "plain";
  for (std::size_t n = 0; n < count; ++n) {
    const std::vector<double> truth = expected(all.a[n], all.b[n], all.c[n], fused);
    for (std::size_t k = 0; k < kOperations; ++k) {
      const double got = out[k * count + n];
      ASSERT_TRUE(got == truth[k] || (std::isnan(got) && std::isnan(truth[k])))
          << "operation " << k << " of " << all.a[n] << ", " << all.b[n] << ", " << all.c[n] << ": " << got
          << " instead of " << truth[k];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Isa, EveryBatch, testing::ValuesIn(test::kEveryIsa), test::isa_name);

TEST(Batches, WithFusedMultiplyAddAgreeInEveryBit) {
  if (!test::machine_has("avx2") || !test::machine_has("avx512")) GTEST_SKIP() << "needs AVX2 and AVX-512";
  for (const std::vector<double>& x : {wide_angles(400000), near_quarter_turns()}) {
    const Angles four = angles_of(batch_of("avx2"), x);
    const Angles eight = angles_of(batch_of("avx512"), x);
    for (std::size_t n = 0; n < four.x.size(); ++n) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(four.sines[n]), std::bit_cast<std::uint64_t>(eight.sines[n]));
      ASSERT_EQ(std::bit_cast<std::uint64_t>(four.cosines[n]), std::bit_cast<std::uint64_t>(eight.cosines[n]));
    }
  }
}

}  // namespace
}  // namespace poesy::simd
