#include "models/lie/se3.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/models/lie/samples.h"

namespace poesy::lie {
namespace {

using Matrix4 = Eigen::Matrix4d;

Matrix4 homogeneous(const Transform<double>& g) {
  Matrix4 m = Matrix4::Identity();
  m.topLeftCorner<3, 3>() = g.R;
  m.topRightCorner<3, 1>() = g.p;
  return m;
}

double difference(const Transform<double>& a, const Transform<double>& b) {
  return (homogeneous(a) - homogeneous(b)).cwiseAbs().maxCoeff();
}

/// The logarithm by Du et al. 2022, Eqs. A6-A7, as printed.
Screw<double> printed_log(const Transform<double>& transform) {
  const Matrix4 g = homogeneous(transform);
  const double t = std::acos((g.trace() - 2.0) / 2.0);
  const double scale = 1.0 / (8.0 * std::pow(std::sin(t / 2), 3) * std::cos(t / 2));
  const double c0 = t * std::cos(2 * t) - std::sin(t);
  const double c1 = -t * std::cos(t) - 2 * t * std::cos(2 * t) + std::sin(t) + std::sin(2 * t);
  const double c2 = 2 * t * std::cos(t) + t * std::cos(2 * t) - std::sin(t) - std::sin(2 * t);
  const double c3 = -t * std::cos(t) + std::sin(t);
  const Matrix4 l = scale * (c0 * Matrix4::Identity() + c1 * g + c2 * g * g + c3 * g * g * g);
  Screw<double> screw;
  screw << l(2, 1), l(0, 2), l(1, 0), l(0, 3), l(1, 3), l(2, 3);
  return screw;
}

class Se3 : public testing::TestWithParam<Regime> {
 protected:
  Screw<double> screw() { return random_screw(GetParam().angle, engine_); }
  std::mt19937_64 engine_{23};
};

TEST_P(Se3, LogUndoesExp) {
  for (int n = 0; n < 50; ++n) {
    const Screw<double> s = screw();
    EXPECT_LE((log(exp(s)) - s).norm(), 8e-15) << s.transpose();
  }
}

TEST_P(Se3, ExpUndoesLog) {
  for (int n = 0; n < 50; ++n) {
    const Transform<double> g = exp(screw());
    EXPECT_LE(difference(exp(log(g)), g), 8e-15);
  }
}

TEST_P(Se3, InverseUndoes) {
  const Transform<double> g = exp(screw());
  EXPECT_LE(difference(g * g.inverse(), Transform<double>{}), 1e-15);
  EXPECT_LE(difference(exp(Screw<double>(-log(g))), g.inverse()), 8e-15);
}

TEST_P(Se3, AdjointIsConjugation) {
  for (int n = 0; n < 20; ++n) {
    const Transform<double> g = exp(screw());
    const Screw<double> s = random_screw(0.7, engine_);
    EXPECT_LE(difference(exp(Screw<double>(adjoint(g) * s)), g * exp(s) * g.inverse()), 8e-15);
  }
}

TEST_P(Se3, AdjointKeepsProducts) {
  const Transform<double> a = exp(screw()), b = exp(screw());
  EXPECT_LE((adjoint(a * b) - adjoint(a) * adjoint(b)).cwiseAbs().maxCoeff(), 4e-15);
}

TEST_P(Se3, BracketIsTheDerivativeOfAdjoint) {
  const Screw<double> a = screw(), b = random_screw(1.1, engine_);
  const double h = 1e-6;
  const Screw<double> difference_quotient =
      (adjoint(exp(Screw<double>(h * a))) * b - adjoint(exp(Screw<double>(-h * a))) * b) / (2 * h);
  EXPECT_LE((bracket(a, b) - difference_quotient).norm(), 1e-8);
}

TEST_P(Se3, BracketObeysJacobi) {
  const Screw<double> a = screw(), b = random_screw(1.1, engine_), c = random_screw(0.3, engine_);
  const Screw<double> sum = bracket(a, bracket(b, c)) + bracket(b, bracket(c, a)) + bracket(c, bracket(a, b));
  EXPECT_LE(sum.norm(), 2e-14);
  EXPECT_LE((bracket(a, b) + bracket(b, a)).norm(), 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Angles, Se3, testing::ValuesIn(regimes()),
                         [](const auto& regime) { return regime.param.name; });

TEST(Se3Log, EqualsThePrintedFormulaAtOrdinaryAngles) {
  std::mt19937_64 engine(31);
  for (const double angle : {0.3, 0.8, 1.3, 2.0, 2.6}) {
    for (int n = 0; n < 20; ++n) {
      const Transform<double> g = exp(random_screw(angle, engine));
      EXPECT_LE((log(g) - printed_log(g)).norm(), 1e-12) << "angle " << angle;
    }
  }
}

TEST(Se3Transform, RotatesAndTranslatesAlongAxes) {
  const Transform<double> quarter = rotation(Axis::z, std::numbers::pi / 2);
  EXPECT_LE((quarter.R * Vector3<double>::UnitX() - Vector3<double>::UnitY()).norm(), 1e-15);
  EXPECT_EQ(translation(Axis::y, 2.0).p, Vector3<double>(0, 2, 0));
}

}  // namespace
}  // namespace poesy::lie
