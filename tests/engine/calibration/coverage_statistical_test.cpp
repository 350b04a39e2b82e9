#include <gtest/gtest.h>

#include <cmath>

#include "engine/calibration/inference.h"
#include "tests/engine/calibration/read_mechanism.h"
#include "tests/engine/calibration/simulated_machines.h"

namespace poesy::calibration {
namespace {

constexpr std::size_t kMachines = 4000;
constexpr double kSigma = 0.3e-3;  // m, of each error
constexpr double kNoise = 5e-6;    // m, of a height

/// A delta printer (delta-puu.toml) whose heights are measured at seven places. Fitted: three end stops and the radius.
class Coverage : public testing::Test {
 protected:
  Coverage() : model_(model_of(mechanism_text("delta-puu.toml"))), machine_(*model_, {}) {
    const Matrix F = columns_for(*model_, {{"zero_1"}, {"zero_2"}, {"zero_3"}, {"foot_x_1", "foot_x_2", "foot_x_3"}});
    directions_ = directions_for(machine_, F, kSigma);
    for (std::size_t place = 0; place < 7; ++place) {
      const double angle = M_PI / 3.0 * static_cast<double>(place);
      const double radius = place == 6 ? 0.0 : 0.05;
      poses_.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.0});
    }
  }

  /// For each fitted number, the share of machines whose interval contains the true value. sigma: standard deviations
  /// of the true values (m).
  Vector held(const Prior& prior, const Vector& sigma, const InferenceOptions& options) {
    std::vector<MeasuredPose> at;
    std::vector<MeasuredValue> values;
    for (const std::vector<double>& pose : poses_) {
      values.push_back({.what = Measured::deviation, .row = at.size(), .component = 5, .sd = kNoise});
      at.push_back({pose, pose});
    }
    const Measurement perfect(machine_, at, values, Frame::known, Target::known);
    const Vector sd = Vector::Constant(static_cast<Eigen::Index>(values.size()), kNoise);
    const auto k = static_cast<std::size_t>(directions_.F.cols());
    const std::vector<double> drawn = normal_numbers(0, kMachines * k);
    const std::vector<double> noise = normal_numbers(1, kMachines * values.size());
    Vector count = Vector::Zero(static_cast<Eigen::Index>(k));
    for (std::size_t s = 0; s < kMachines; ++s) {
      Vector theta(static_cast<Eigen::Index>(k));
      for (std::size_t j = 0; j < k; ++j) {
        theta(static_cast<Eigen::Index>(j)) = sigma(static_cast<Eigen::Index>(j)) * drawn[s * k + j];
      }
      const auto exact = FittedMeasurement(perfect, directions_).values(theta, Vector(0));
      EXPECT_TRUE(exact.has_value());
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i].value = (*exact)(static_cast<Eigen::Index>(i)) + kNoise * noise[s * values.size() + i];
      }
      const Measurement measurement(machine_, at, values, Frame::known, Target::known);
      const FitResult found = fit({measurement, directions_, sd, prior});
      EXPECT_TRUE(found.solved && found.converged);
      const Inference sure = infer(found, sd, directions_.scale, prior, options);
      count.array() += (sure.low.array() <= theta.array() && theta.array() <= sure.high.array()).cast<double>();
    }
    return count / static_cast<double>(kMachines);
  }

  std::unique_ptr<Model> model_;
  ExactMachine machine_;
  FittedDirections directions_;
  std::vector<std::vector<double>> poses_;
};

TEST_F(Coverage, OfLeastSquares) { expect_nominal(held({}, Vector::Constant(4, kSigma), {false, 0.95, 7}), kMachines); }

TEST_F(Coverage, OfEstimatedNoiseByStudentsT) {
  expect_nominal(held({}, Vector::Constant(4, kSigma), {true, 0.95, 7}), kMachines);
}

TEST_F(Coverage, WithTheTolerancesAsPrior) {
  // The radius is the mean of three independent errors with the standard deviation kSigma.
  Vector sigma = Vector::Constant(4, kSigma);
  sigma(3) /= std::sqrt(3.0);
  const Prior prior{sigma.cwiseInverse().asDiagonal(), Vector::Zero(4)};
  expect_nominal(held(prior, sigma, {false, 0.95, 7}), kMachines);
}

}  // namespace
}  // namespace poesy::calibration
