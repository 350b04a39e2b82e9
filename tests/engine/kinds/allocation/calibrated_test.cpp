// Compares mean squares and loads of calibrated machines with the linear algebra of this test, which uses finite
// differences of uncalibrated solves.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/kinds/allocation/machine_loads.h"
#include "engine/kinds/allocation/mean_squares.h"
#include "engine/kinds/allocation/variations.h"
#include "engine/kinds/study_file.h"
#include "tests/engine/calibration/read_mechanism.h"

namespace poesy::allocation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSigma = 3e-6;  // m, so small that second-order effects are a millionth of first-order effects
constexpr double kNoise = 1e-6;  // m
constexpr std::size_t kPlaces = 7;
const char* const kAllocated = R"(
[[analysis.parts]]
factors = "linear"
each    = true
)";

/// The text of an allocation study of the printer. fit: the value of the key `fit`; more: further keys of
/// [analysis.calibration].
std::string study_text(const std::string& fit, const std::string& more) {
  return R"(format = "poesy-study"
version = 1
mechanism.model = "delta-puu"
poses = { count = 7, workspace = { x = ["-60 mm", "60 mm"], y = ["-60 mm", "60 mm"], z = ["0 mm", "60 mm"] } }
errors.linear = { distribution = "normal", sigma = "0.003 mm" }
[analysis]
kind    = "allocation"
samples = 400
yield   = 0.9
sigmas  = 3
limits  = { z = "0.1 mm", position = "0.1 mm" }
[analysis.calibration]
measured = ["z", "x"]
noise    = { z = "1 um", x = "1 um" }
combinations.radius = { foot_x_1 = 1, foot_x_2 = 1, foot_x_3 = 1 }
)" + ("fit = " + fit + "\n" + more + kAllocated);
}

/// A study of calibrated printers, and its calibration.
struct Printers {
  Printers(const std::string& fit, const std::string& more)
      : catalog{registry().from_text(calibration::mechanism_text("delta-puu.toml"), "delta-puu.toml")},
        study(study_of_text(study_text(fit, more), "study.toml", catalog, StudyUse::run)),
        model(build_model(study.mechanism)),
        poses(select_poses(study.poses, *model).poses),
        calibration(study, *model, poses) {}

  MeanSquares squares() const { return squares_at(study); }
  /// The mean squares with the sigmas of `other`, but with the calibration gain for the sigmas of this study.
  MeanSquares squares_at(const Study& other) const {
    return *mean_squares(Plan(other, poses), *model, other.analysis.limits, 0, {.threads = 2}, &calibration);
  }
  Study with_sigmas(const VectorXd& factors) const {
    Study other = study;
    for (Index p = 0; p < factors.size(); ++p) {
      const FactorIndex factor = study.analysis.factors[static_cast<std::size_t>(p)];
      other.errors.by_factor[factor.value] = Distribution::normal(kSigma * factors(p));
    }
    return other;
  }

  Catalog catalog;
  Study study;
  std::unique_ptr<Model> model;
  PoseSet poses;
  MachineCalibration calibration;
};

/// [3 poses x errors] The derivatives of x, y and z at each pose by the errors that vary, by central differences.
MatrixXd derivatives(const Printers& printers) {
  constexpr double kStep = 1e-5;  // m
  const ModelDescription& description = printers.model->description();
  const auto evaluator = printers.model->evaluator(printers.study.solver);
  const std::vector<double> none(description.factors.size(), 0.0);
  const std::size_t responses = description.responses.size();
  MatrixXd G(static_cast<Index>(3 * kPlaces), static_cast<Index>(printers.study.analysis.factors.size()));
  for (std::size_t m = 0; m < kPlaces; ++m) {
    for (Index p = 0; p < G.cols(); ++p) {
      const std::array varied{printers.study.analysis.factors[static_cast<std::size_t>(p)]};
      const std::array values{kStep, -kStep};
      std::vector<double> found(2 * responses);
      std::array<SolveStatus, 2> status{};
      std::array<std::uint32_t, 2> iterations{};
      evaluator->evaluate({printers.poses[PoseIndex(m)], none, varied, values, 2}, {found, status, iterations, {}});
      Index row = static_cast<Index>(3 * m);
      for (const std::string_view name : {"x", "y", "z"}) {
        const auto r = static_cast<std::size_t>(std::ranges::find(description.responses, name, &Response::name) -
                                                description.responses.begin());
        G(row++, p) = (found[2 * r] - found[2 * r + 1]) / (2.0 * kStep);
      }
    }
  }
  return G;
}

/// The first-order maps from the errors and from the measurement noise to x, y and z at each pose after calibration.
struct LeftMap {
  MatrixXd errors;  ///< [3 poses x errors]
  MatrixXd noise;   ///< [3 poses x 2 poses]

  /// fitted: for each fitted number, the names of its errors. with_prior: whether the fit uses kSigma of the errors as
  /// prior.
  LeftMap(const Printers& printers, const std::vector<std::vector<std::string>>& fitted, bool with_prior) {
    const MatrixXd G = derivatives(printers);
    MatrixXd F = MatrixXd::Zero(G.cols(), static_cast<Index>(fitted.size()));
    const std::vector<Factor>& factors = printers.model->description().factors;
    for (Index p = 0; p < G.cols(); ++p) {
      const std::string& name = factors[printers.study.analysis.factors[static_cast<std::size_t>(p)].value].name;
      for (std::size_t j = 0; j < fitted.size(); ++j) {
        F(p, static_cast<Index>(j)) = static_cast<double>(std::ranges::count(fitted[j], name));
      }
    }
    MatrixXd J(static_cast<Index>(2 * kPlaces), G.cols());  // z and x at each pose
    for (Index m = 0; m < static_cast<Index>(kPlaces); ++m) {
      J.row(2 * m) = G.row(3 * m + 2);
      J.row(2 * m + 1) = G.row(3 * m);
    }
    const MatrixXd A = J * F / kNoise;
    MatrixXd information = A.transpose() * A;
    if (with_prior) information += F.transpose() * F / (kSigma * kSigma);
    const MatrixXd gain = information.inverse() * A.transpose() / kNoise;
    // All coordinates of the platform are commanded, so the controller removes the whole displacement of a fitted
    // number.
    errors = G - G * F * gain * J;
    noise = -G * F * gain;
  }
};

const std::vector<std::vector<std::string>> kFour{
    {"zero_1"}, {"zero_2"}, {"zero_3"}, {"foot_x_1", "foot_x_2", "foot_x_3"}};
const char* const kFourText = R"(["zero_1", "zero_2", "zero_3", "radius"])";

/// Calibration by least squares, and with the tolerances as prior, which in some directions outweighs the measurements.
TEST(CalibratedMeanSquares, AreThoseOfTheResidualMap) {
  for (const bool with_prior : {false, true}) {
    const Printers printers(kFourText, with_prior ? "prior = \"tolerances\"" : "");
    const LeftMap left(printers, kFour, with_prior);
    const MeanSquares found = printers.squares();
    const std::size_t errors = printers.study.analysis.factors.size();
    ASSERT_EQ(found.value.size(), 2 * kPlaces);
    ASSERT_EQ(found.slope.size(), 2 * kPlaces * errors);
    double of_noise = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t m = 0; m < kPlaces; ++m) {
        const Index first = static_cast<Index>(3 * m);
        const Index rows = k == 0 ? 1 : 3;  // z, then the position
        const VectorXd slope = left.errors.middleRows(first + (k == 0 ? 2 : 0), rows).colwise().squaredNorm();
        const double noise = left.noise.middleRows(first + (k == 0 ? 2 : 0), rows).squaredNorm() * kNoise * kNoise;
        const double value = slope.sum() * kSigma * kSigma + noise;
        EXPECT_NEAR(found.value[k * kPlaces + m], value, 2e-4 * value) << k << " " << m;
        for (std::size_t p = 0; p < errors; ++p) {
          EXPECT_NEAR(found.slope[(k * kPlaces + m) * errors + p], slope(static_cast<Index>(p)),
                      2e-4 * slope.maxCoeff())
              << k << " " << m << " " << p;
        }
        of_noise += noise / value / static_cast<double>(2 * kPlaces);
      }
    }
    EXPECT_GT(of_noise, 0.01);  // the noise matters enough to be tested
  }
}

/// All errors are fitted, with their tolerances as prior. Mean squares with a gain that is kept from the first
/// tolerances are upper bounds: they equal the mean squares with the right gain at the first tolerances and are larger
/// at others.
TEST(CalibratedMeanSquares, TouchTheRightOnesFromAbove) {
  const Printers printers("\"all\"", "prior = \"tolerances\"");
  const MeanSquares kept = printers.squares();
  const std::size_t errors = printers.study.analysis.factors.size();
  // Returns the least and the largest ratio of the kept to the right mean squares, with all sigmas times these factors.
  const auto ratios = [&](const VectorXd& factors) {
    const Study other = printers.with_sigmas(factors);
    const MachineCalibration calibration = printers.calibration.of(other);
    const MeanSquares right = *mean_squares(Plan(other, printers.poses), *printers.model, other.analysis.limits, 0,
                                            {.threads = 2}, &calibration);
    double least = 1e300;
    double largest = 0.0;
    for (std::size_t row = 0; row < right.value.size(); ++row) {
      double linear = kept.value[row];
      for (std::size_t p = 0; p < errors; ++p) {
        const double factor = factors(static_cast<Index>(p));
        linear += kept.slope[row * errors + p] * kSigma * kSigma * (factor * factor - 1.0);
      }
      least = std::min(least, linear / right.value[row]);
      largest = std::max(largest, linear / right.value[row]);
    }
    return std::pair(least, largest);
  };
  VectorXd factors(static_cast<Index>(errors));
  for (Index p = 0; p < factors.size(); ++p) factors(p) = p % 3 == 0 ? 3.0 : (p % 3 == 1 ? 0.4 : 1.0);
  const auto [least, largest] = ratios(factors);
  EXPECT_GT(least, 1.0);
  EXPECT_GT(largest, 1.02);
  const auto [near_least, near_largest] = ratios(VectorXd::Constant(factors.size(), 1.01));
  EXPECT_GT(near_least, 1.0 - 1e-6);
  EXPECT_LT(near_largest, 1.0 + 1e-3);
}

/// A variation of a machine is calibrated with the same noise: it equals the machine of a study with the changed sigma.
TEST(CalibratedVariations, AreMachinesOfThatSize) {
  const Printers printers(kFourText, "");
  const std::vector<std::uint32_t> machines{3, 5, 6, 39, 40, 41, 250};
  const std::vector<Variation> variations{{{2, 1.05}}, {{7, 3.0}, {8, -1.0}}};
  const Plan plan(printers.study, printers.poses);
  const std::vector<ResponseLimit>& limits = printers.study.analysis.limits;
  const auto varied =
      *try_variations(plan, *printers.model, limits, machines, variations, {.threads = 2}, &printers.calibration);
  VectorXd factors = VectorXd::Ones(static_cast<Index>(printers.study.analysis.factors.size()));
  factors(2) = 1.05;
  const Study other = printers.with_sigmas(factors);
  const MachineCalibration calibration = printers.calibration.of(other);
  const auto whole = *machine_loads(Plan(other, printers.poses), *printers.model, limits, {.threads = 1}, &calibration);
  const auto listed =
      *machine_loads(Plan(other, printers.poses), *printers.model, limits, machines, {.threads = 1}, &calibration);
  ASSERT_EQ(varied.size(), 2 * machines.size());
  ASSERT_EQ(whole.load.size(), 400u);
  for (std::size_t n = 0; n < machines.size(); ++n) {
    EXPECT_EQ(listed.load[n], whole.load[machines[n]]);
    EXPECT_NEAR(varied[n], whole.load[machines[n]], 1e-7 * whole.load[machines[n]]);
    EXPECT_NE(varied[machines.size() + n], varied[n]);
  }
}

/// The seed determines the measurement noise too, not only the errors.
TEST(CalibratedLoads, ChangeWithTheSeed) {
  const Printers printers(kFourText, "");
  const std::vector<std::uint32_t> machines{0, 1, 2};
  Study other = printers.study;
  other.seed += 1;
  const MachineCalibration same_errors = printers.calibration.of(other);
  const Plan plan(printers.study, printers.poses);
  const auto loads = [&](const MachineCalibration* calibration) {
    return machine_loads(plan, *printers.model, printers.study.analysis.limits, machines, {.threads = 1}, calibration)
        ->load;
  };
  const std::vector<double> with_noise = loads(&printers.calibration);
  const std::vector<double> other_noise = loads(&same_errors);
  for (std::size_t n = 0; n < machines.size(); ++n) EXPECT_NE(with_noise[n], other_noise[n]);
}

}  // namespace
}  // namespace poesy::allocation
