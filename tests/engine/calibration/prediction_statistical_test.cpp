// Coverage of the intervals that calibrate predicts for a machine: how often they contain the true value if more errors
// vary than are fitted.
#include <gtest/gtest.h>

#include <string>

#include "engine/calibration/inference.h"
#include "engine/calibration/left.h"
#include "tests/engine/calibration/read_mechanism.h"
#include "tests/engine/calibration/simulated_machines.h"

namespace poesy::calibration {
namespace {

constexpr std::size_t kMachines = 1000;
constexpr double kLevel = 0.95;
constexpr double kQuantile = 1.959963984540054;  // of the standard normal, for two-sided 95 % intervals

/// The measured components of each machine and the poses at which they are measured.
struct Measuring {
  std::vector<std::vector<double>> poses;
  std::vector<std::size_t> components;  ///< indices of the measured components in kComponents
  double noise;                         ///< m
  double noise_of_angles = 0.0;         ///< rad
  Frame frame = Frame::known;
  Vector place = Vector();  ///< true values of the frame's unknowns (m, slopes); empty for Frame::known
};

/// Machines of one mechanism. All `varied` errors are normal; only the `fitted` combinations of errors are fitted.
class Machines {
 public:
  Machines(const std::string& mechanism, const std::vector<std::vector<std::string>>& fitted,
           const std::vector<std::string>& varied, double sigma_of_lengths, double sigma_of_angles)
      : model_(model_of(mechanism)), machine_(*model_, {}) {
    std::vector<std::vector<std::string>> alone;
    for (const std::string& name : varied) alone.push_back({name});
    all_ = directions_for(machine_, columns_for(*model_, alone), 1.0);
    for (std::size_t n = 0; n < varied.size(); ++n) {
      const bool is_length =
          model_->description().factors[model_->description().find_factor(varied[n])->value].dimension ==
          Dimension::length;
      all_.scale(static_cast<Eigen::Index>(n)) = is_length ? sigma_of_lengths : sigma_of_angles;
    }
    fitted_ = directions_for(machine_, columns_for(*model_, fitted), sigma_of_lengths);
    for (Eigen::Index j = 0; j < fitted_.F.cols(); ++j) {
      Eigen::Index first = 0;
      for (first = 0; first < all_.F.cols() && all_.F.col(first).dot(fitted_.F.col(j)) == 0.0;) ++first;
      fitted_.scale(j) = all_.scale(first) / fitted_.F.col(j).norm();
    }
  }

  /// The prior with the standard deviations of the directions.
  static Prior prior_of(const FittedDirections& directions) {
    return {directions.scale.cwiseInverse().asDiagonal(), Vector::Zero(directions.scale.size())};
  }
  const FittedDirections& fitted() const { return fitted_; }
  const FittedDirections& all() const { return all_; }

  /// For each error, the share of machines whose interval of the estimate contains the true error. All errors are
  /// fitted with this prior.
  Vector held_by_estimates(const Measuring& measuring, const Prior& prior) {
    const Eigen::Index k = all_.F.cols();
    Measurement measurement = measured(measuring);
    const Matrix theta = all_.scale.asDiagonal() * normal_matrix(0, k, static_cast<Eigen::Index>(kMachines));
    const Matrix values = values_of(measurement, measuring, theta);
    Vector count = Vector::Zero(k);
    for (Eigen::Index s = 0; s < theta.cols(); ++s) {
      measurement.set_measured(values.col(s));
      const FitResult found = fit({measurement, all_, sd_of_values(measurement, measuring), prior});
      EXPECT_TRUE(found.solved && found.converged);
      const Inference sure = infer(found, sd_of_values(measurement, measuring), all_.scale, prior,
                                   {false, kLevel, measuring.poses.size()});
      count.array() +=
          (sure.low.array() <= theta.col(s).array() && theta.col(s).array() <= sure.high.array()).cast<double>();
    }
    return count / static_cast<double>(kMachines);
  }

  /// [poses x components] The share of machines whose predicted interval contains the true remaining error of a
  /// component, after a controller has corrected the machine with the fitted numbers. prior: for the fit of these
  /// numbers.
  Vector held_by_predictions(const Measuring& measuring, const Prior& prior, const CoordinateError& commanded,
                             const std::vector<std::vector<double>>& poses,
                             const std::vector<std::size_t>& components) {
    const DriveCorrection correction(machine_, commanded);
    Measurement measurement = measured(measuring);
    const Vector sd = sd_of_values(measurement, measuring);
    const Matrix theta =
        all_.scale.asDiagonal() * normal_matrix(0, all_.F.cols(), static_cast<Eigen::Index>(kMachines));
    const Matrix values = values_of(measurement, measuring, theta);
    Vector count = Vector::Zero(static_cast<Eigen::Index>(poses.size() * components.size()));
    for (Eigen::Index s = 0; s < theta.cols(); ++s) {
      measurement.set_measured(values.col(s));
      const FitResult typed = fit({measurement, fitted_, sd, prior});
      const FitResult found = fit({measurement, all_, sd, prior_of(all_)});
      EXPECT_TRUE(typed.solved && typed.converged && found.solved && found.converged);
      const Knowledge known = knowledge(found, all_, sd, prior_of(all_), 1.0);
      const Corrected corrected{fitted_.F * typed.theta, typed.phi, measuring.frame};
      Eigen::Index at = 0;
      for (const std::vector<double>& pose : poses) {
        const auto left = left_at(machine_, correction, pose, corrected, known);
        if (!left) throw std::runtime_error("a corrected pose was not found");
        const Vector truth =
            left_of_machines(machine_, pose, left->drive_at, all_.F * theta.col(s), measuring.place, corrected);
        for (const std::size_t c : components) {
          const auto component = static_cast<Eigen::Index>(c);
          count(at++) +=
              std::abs(truth(component) - left->mean(component)) <= kQuantile * left->sd(component) ? 1.0 : 0.0;
        }
      }
    }
    return count / static_cast<double>(kMachines);
  }

 private:
  Measurement measured(const Measuring& measuring) {
    std::vector<MeasuredPose> at;
    std::vector<MeasuredValue> values;
    for (const std::vector<double>& pose : measuring.poses) {
      for (const std::size_t component : measuring.components) {
        values.push_back({.what = Measured::deviation, .row = at.size(), .component = component});
      }
      at.push_back({pose, pose});
    }
    return {machine_, at, values, measuring.frame, Target::known};
  }

  static Vector sd_of_values(const Measurement& measurement, const Measuring& measuring) {
    Vector sd(static_cast<Eigen::Index>(measurement.size()));
    for (std::size_t i = 0; i < measurement.size(); ++i) {
      const bool is_angle = measurement.values()[i].component < 3;
      sd(static_cast<Eigen::Index>(i)) = is_angle ? measuring.noise_of_angles : measuring.noise;
    }
    return sd;
  }

  /// [values x machines] The measured values, with noise, of machines. theta: [errors x machines] the errors (m, rad).
  Matrix values_of(const Measurement& measurement, const Measuring& measuring, const Matrix& theta) {
    const auto displacements = measurement.displacements(Matrix(all_.F * theta));
    const auto values = static_cast<Eigen::Index>(measurement.size());
    Matrix found = sd_of_values(measurement, measuring).asDiagonal() * normal_matrix(1, values, theta.cols());
    for (Eigen::Index s = 0; s < theta.cols(); ++s) {
      found.col(s) += measurement.values_of(displacements.value()[static_cast<std::size_t>(s)], measuring.place);
    }
    return found;
  }

  std::unique_ptr<Model> model_;
  ExactMachine machine_;
  FittedDirections all_;
  FittedDirections fitted_;
};

/// The delta printer. 12 errors vary with this standard deviation (m); the three end stops and the radius are fitted.
Machines printer(double sigma) {
  return {mechanism_text("delta-puu.toml"),
          {{"zero_1"}, {"zero_2"}, {"zero_3"}, {"foot_x_1", "foot_x_2", "foot_x_3"}},
          {"foot_x_1", "foot_x_2", "foot_x_3", "foot_y_1", "foot_y_2", "foot_y_3", "zero_1", "zero_2", "zero_3",
           "rod_1", "rod_2", "rod_3"},
          sigma,
          0.0};
}

/// The middle of the bed and places on a circle of this radius, m.
std::vector<std::vector<double>> places(std::size_t count, double radius) {
  std::vector<std::vector<double>> list{{0.0, 0.0, 0.0}};
  for (std::size_t n = 0; n < count; ++n) {
    const double angle = 2.0 * M_PI * static_cast<double>(n) / static_cast<double>(count);
    list.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.0});
  }
  return list;
}

const std::vector<std::size_t> kHeight{5};
const std::vector<std::size_t> kPosition{3, 4, 5};
const std::vector<std::vector<double>> kStudied{{0.03, 0.02, 0.0}, {-0.04, 0.01, 0.02}};

TEST(CoverageOfPredictions, AfterLeastSquares) {
  Machines machines = printer(0.3e-3);
  expect_nominal(machines.held_by_predictions({.poses = places(6, 0.05), .components = kHeight, .noise = 5e-6}, {},
                                              coordinates_of_components(kPosition), kStudied, kPosition),
                 kMachines);
}

/// The heights are measured from a bed of unknown height and tilt. The errors have sigma 0.1 mm. With 0.3 mm the
/// intervals of z contain the true value for only 93 % of the machines, because they ignore second-order terms: the
/// product of the bed's slopes, which the heights hardly determine, with errors of x and y, which are not measured.
TEST(CoverageOfPredictions, OverAnUnknownPlane) {
  Machines machines = printer(0.1e-3);
  Vector plane(3);
  plane << 0.2e-3, 1e-3, -0.5e-3;
  const Measuring measuring{
      .poses = places(12, 0.05), .components = kHeight, .noise = 5e-6, .frame = Frame::plane, .place = plane};
  expect_nominal(machines.held_by_predictions(measuring, Machines::prior_of(machines.fitted()),
                                              coordinates_of_components(kPosition), kStudied, kPosition),
                 kMachines);
}

/// An over-constrained mechanism with ten errors, most of which deform it. The pose of its platform minimises the
/// mismatch of the limbs in the metric, or their elastic energy if the file states stiffness.
Machines over_constrained(const std::string& file) {
  const std::vector<std::string> varied{"delta_1_0_z", "delta_1_0_y",   "epsilon_1_4_z", "delta_1_4_x",
                                        "delta_2_0_z", "epsilon_2_1_x", "delta_2_4_y",   "delta_3_0_x",
                                        "delta_3_4_z", "epsilon_3_2_z"};
  return {
      mechanism_text(file, "mechanisms"), {{"delta_1_0_z"}, {"delta_2_0_z"}, {"delta_3_4_z"}}, varied, 0.1e-3, 1e-3};
}

Measuring of_whole_poses() {
  return {.poses = {{-0.2, 0.0, 0.0}, {-0.25, 0.3, 0.2}, {-0.22, -0.3, 0.4}, {-0.28, 0.1, -0.4}, {-0.21, -0.2, -0.3}},
          .components = {0, 1, 2, 3, 4, 5},
          .noise = 5e-6,
          .noise_of_angles = 2e-5};
}

class OverConstrained : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Coverage, OverConstrained, testing::Values("upr2-rpu.toml", "upr2-rpu-beams.toml"));

TEST_P(OverConstrained, OfEstimates) {
  Machines machines = over_constrained(GetParam());
  expect_nominal(machines.held_by_estimates(of_whole_poses(), {}), kMachines);
}

TEST_P(OverConstrained, OfEstimatesWithPrior) {
  Machines machines = over_constrained(GetParam());
  expect_nominal(machines.held_by_estimates(of_whole_poses(), Machines::prior_of(machines.all())), kMachines);
}

TEST_P(OverConstrained, OfPredictions) {
  Machines machines = over_constrained(GetParam());
  /// The commanded coordinates: z, and the rotations about x and then y.
  const auto commanded = [](const Placement& nominal, const Displacement& by) {
    const auto coordinates = [](const Matrix3& turn, double z) {
      return Vector3(z, std::atan2(-turn(1, 2), turn(2, 2)), std::asin(turn(0, 2)));
    };
    return Vector(coordinates(by.turn * nominal.turn, nominal.origin.z() + by.moved.z()) -
                  coordinates(nominal.turn, nominal.origin.z()));
  };
  expect_nominal(
      machines.held_by_predictions(of_whole_poses(), {}, commanded, {{-0.23, 0.2, -0.1}}, {0, 1, 2, 3, 4, 5}),
      kMachines);
}

/// A hexapod measured in all six components. The errors are the strut lengths and one coordinate of each joint centre
/// on the base and on the platform.
TEST(CoverageOfHexapod, OfEstimates) {
  std::vector<std::string> varied;
  std::vector<std::vector<std::string>> fitted;
  for (const char limb : {'1', '2', '3', '4', '5', '6'}) {
    varied.push_back(std::string("delta_") + limb + "_3_z");
    fitted.push_back({varied.back()});
    varied.push_back(std::string("delta_") + limb + "_0_x");
    varied.push_back(std::string("delta_") + limb + "_6_y");
  }
  Machines machines{mechanism_text("ups6.toml", "mechanisms"), fitted, varied, 0.1e-3, 0.0};
  const Measuring measuring{.poses = {{0.0, 0.0, 0.8, 0.0, 0.0, 0.0},
                                      {0.05, 0.02, 0.78, 0.1, 0.05, -0.1},
                                      {-0.05, 0.03, 0.84, -0.1, 0.1, 0.1},
                                      {0.02, -0.05, 0.85, 0.05, -0.1, 0.12},
                                      {-0.03, -0.04, 0.77, -0.12, -0.05, 0.05}},
                            .components = {0, 1, 2, 3, 4, 5},
                            .noise = 5e-6,
                            .noise_of_angles = 2e-5};
  expect_nominal(machines.held_by_estimates(measuring, Machines::prior_of(machines.all())), kMachines);
}

}  // namespace
}  // namespace poesy::calibration
