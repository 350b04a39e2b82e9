#include "models/lie/so3.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/models/lie/samples.h"

namespace poesy::lie {
namespace {

using Wide = long double;

/// The exponential of a 3x3 matrix by scaling, a Taylor series and squaring, in long double. It shares no formula with
/// the tested code.
Matrix3<Wide> matrix_exponential(const Matrix3<Wide>& m) {
  Matrix3<Wide> power = Matrix3<Wide>::Identity();
  Matrix3<Wide> sum = power;
  const Matrix3<Wide> scaled = m / Wide(16);
  for (int k = 1; k < 30; ++k) {
    power = power * scaled / Wide(k);
    sum += power;
  }
  for (int k = 0; k < 4; ++k) sum = (sum * sum).eval();
  return sum;
}

class So3 : public testing::TestWithParam<Regime> {
 protected:
  std::mt19937_64 engine_{7};
};

TEST_P(So3, ExpEqualsTheMatrixExponential) {
  for (int n = 0; n < 50; ++n) {
    const Vector3<double> w = GetParam().angle * random_axis(engine_);
    const Matrix3<Wide> expected = matrix_exponential(hat<Wide>(w.cast<Wide>()));
    EXPECT_LE((exp(w).cast<Wide>() - expected).cwiseAbs().maxCoeff(), 8e-16L);
  }
}

TEST_P(So3, LogUndoesExp) {
  for (int n = 0; n < 50; ++n) {
    const Vector3<double> w = GetParam().angle * random_axis(engine_);
    EXPECT_LE((log(exp(w)) - w).norm(), 4e-15) << w.transpose();
  }
}

TEST_P(So3, LeftJacobianIsTheIntegralOfExp) {
  // V(w) is the mean of exp(t w) over t in [0, 1]: Gauss-Legendre with 5 nodes on 40 pieces.
  constexpr std::array<Wide, 5> node{0.0L, -0.538469310105683091036314420700L, 0.538469310105683091036314420700L,
                                     -0.906179845938663992797626878299L, 0.906179845938663992797626878299L};
  constexpr std::array<Wide, 5> weight{0.568888888888888888888888888889L, 0.478628670499366468041291514836L,
                                       0.478628670499366468041291514836L, 0.236926885056189087514264040720L,
                                       0.236926885056189087514264040720L};
  const Vector3<double> w = GetParam().angle * random_axis(engine_);
  Matrix3<Wide> mean = Matrix3<Wide>::Zero();
  constexpr int pieces = 40;
  for (int k = 0; k < pieces; ++k) {
    for (std::size_t g = 0; g < node.size(); ++g) {
      const Wide t = (Wide(k) + (Wide(1) + node[g]) / 2) / pieces;
      mean += weight[g] / (2 * pieces) * matrix_exponential(hat<Wide>(t * w.cast<Wide>()));
    }
  }
  EXPECT_LE((left_jacobian(w).cast<Wide>() - mean).cwiseAbs().maxCoeff(), 8e-16L);
}

TEST_P(So3, LeftJacobianInverseIsTheInverse) {
  for (int n = 0; n < 50; ++n) {
    const Vector3<double> w = GetParam().angle * random_axis(engine_);
    const Matrix3<double> product = left_jacobian_inverse(w) * left_jacobian(w);
    EXPECT_LE((product - Matrix3<double>::Identity()).cwiseAbs().maxCoeff(), 2e-15);
  }
}

TEST_P(So3, DoubleAgreesWithLongDouble) {
  for (int n = 0; n < 50; ++n) {
    const Vector3<double> w = GetParam().angle * random_axis(engine_);
    const Vector3<Wide> wide = w.cast<Wide>();
    EXPECT_LE((exp(w).cast<Wide>() - exp(wide)).cwiseAbs().maxCoeff(), 8e-16L);
    EXPECT_LE((log(exp(wide)) - wide).norm(), 1e-17L);
  }
}

INSTANTIATE_TEST_SUITE_P(Angles, So3, testing::ValuesIn(regimes()),
                         [](const auto& regime) { return regime.param.name; });

TEST(So3Log, IsExactRelativeToSmallAngles) {
  std::mt19937_64 engine(13);
  for (const double angle : {1e-12, 1e-8, 1e-4, 0.1, 0.4999, 0.5001, 1.0}) {
    for (int n = 0; n < 50; ++n) {
      const Vector3<double> w = angle * random_axis(engine);
      EXPECT_LE((log(exp(w)) - w).norm(), 4e-15 * w.norm()) << w.transpose();
    }
  }
}

TEST(So3Log, GivesAHalfTurnAtPi) {
  std::mt19937_64 engine(11);
  for (int n = 0; n < 100; ++n) {
    const Vector3<double> axis = random_axis(engine);
    const Matrix3<double> half_turn = 2.0 * axis * axis.transpose() - Matrix3<double>::Identity();
    const Vector3<double> w = log(half_turn);
    EXPECT_NEAR(w.norm(), std::numbers::pi, 1e-15 * 8);
    EXPECT_NEAR(std::abs(w.normalized().dot(axis)), 1.0, 4e-16 * 4);
  }
}

TEST(So3Hat, IsTheCrossProduct) {
  const Vector3<double> a(1, -2, 3), b(-4, 5, 0.5);
  EXPECT_EQ((hat(a) * b), a.cross(b));
  EXPECT_EQ(vee(hat(a)), a);
}

}  // namespace
}  // namespace poesy::lie
