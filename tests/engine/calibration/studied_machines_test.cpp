#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/calibration/corrected_evaluator.h"
#include "tests/engine/calibration/read_mechanism.h"

namespace poesy::calibration {
namespace {

constexpr double kSigma = 0.3e-3;  // m, of each error of the printer

Eigen::Index index(std::size_t n) { return static_cast<Eigen::Index>(n); }

Vector vector_of(const nlohmann::json& list) {
  const auto numbers = list.get<std::vector<double>>();
  return Eigen::Map<const Vector>(numbers.data(), index(numbers.size()));
}

/// Machines of the printer that another program measured, fitted and corrected (tests/data/calibration.json).
class StudiedMachines : public testing::Test {
 protected:
  StudiedMachines() : model_(model_of(mechanism_text("delta-puu.toml"))), machine_(*model_, {}) {
    std::ifstream file(std::string(POESY_TEST_DATA) + "/calibration.json");
    delta_ = nlohmann::json::parse(file).at("delta");
    for (std::size_t place = 0; place < 7; ++place) {
      const double angle = M_PI / 3.0 * static_cast<double>(place);
      poses_.push_back(place == 6 ? std::vector{0.0, 0.0, 0.0} : pose_at(angle));
    }
    std::rotate(poses_.begin(), poses_.end() - 1, poses_.end());
  }

  /// The pose on the circle of 50 mm, rounded to 0.1 mm as in the other program.
  static std::vector<double> pose_at(double angle) {
    const auto rounded = [](double length) { return std::round(length * 1e4) / 1e4; };
    return {rounded(0.05 * std::cos(angle)), rounded(0.05 * std::sin(angle)), 0.0};
  }

  FittedDirections directions_of(const nlohmann::json& fit) const {
    std::vector<std::vector<std::string>> columns;
    for (const std::string name : fit) {
      auto& column = columns.emplace_back();
      for (const auto& [error, weight] : delta_.at("fit_table").at(name).items()) column.push_back(error);
    }
    const Matrix F = columns_for(*model_, columns);
    FittedDirections directions = directions_for(machine_, F, kSigma);
    for (Eigen::Index j = 0; j < F.cols(); ++j) directions.scale(j) = kSigma / F.col(j).norm();
    return directions;
  }

  Measurement heights() {
    std::vector<MeasuredPose> at;
    std::vector<MeasuredValue> values;
    for (const std::vector<double>& pose : poses_) {
      values.push_back({.what = Measured::deviation, .row = at.size(), .component = 5});
      at.push_back({pose, pose});
    }
    return {machine_, at, values, Frame::known, Target::known};
  }

  /// The errors of a machine in the order of the model's errors. list: in the order of the other program.
  Vector errors_of(const nlohmann::json& list) const {
    Vector errors = Vector::Zero(index(machine_.errors()));
    for (std::size_t n = 0; n < list.size(); ++n) {
      errors(index(model_->description().find_factor(delta_.at("errors")[n].get<std::string>())->value)) = list[n];
    }
    return errors;
  }

  std::unique_ptr<Model> model_;
  ExactMachine machine_;
  nlohmann::json delta_;
  std::vector<std::vector<double>> poses_;
};

/// Fits with the expansion agree with the other program to 3e-4 of each scale, because the expansion neglects terms of
/// second order in error over length. Exact fits agree to 1e-11 m.
TEST_F(StudiedMachines, AreFittedByTheExpansion) {
  for (const nlohmann::json& one : delta_.at("machines")) {
    const FittedDirections directions = directions_of(one.at("fit"));
    Measurement measurement = heights();
    const Expansion expansion(measurement, directions);
    const Vector sd = Vector::Constant(index(poses_.size()), one.at("noise_sd").get<double>());
    Prior prior;
    if (one.at("prior") == "tolerances") {
      prior = {directions.scale.cwiseInverse().asDiagonal(), Vector::Zero(directions.scale.size())};
    }
    for (std::size_t s = 0; s < one.at("measured").size(); ++s) {
      measurement.set_measured(vector_of(one.at("measured")[s]));
      const FitResult found = fit({measurement, directions, sd, prior, &expansion});
      ASSERT_TRUE(found.solved && found.converged);
      const Vector off = (found.theta - vector_of(one.at("estimate")[s])).cwiseQuotient(directions.scale);
      EXPECT_LT(off.cwiseAbs().maxCoeff(), 3e-4) << one.at("fit").dump() << " machine " << s;
      const FitResult exact = fit({measurement, directions, sd, prior});
      EXPECT_LT((exact.theta - vector_of(one.at("estimate")[s])).cwiseAbs().maxCoeff(), 1e-11);
      EXPECT_LE(found.steps, 4U);
    }
  }
}

/// After a correction with the other program's estimates, the remaining pose errors are those that the other program
/// found.
TEST_F(StudiedMachines, AreLeftWhereTheOtherProgramFindsThem) {
  CorrectedEvaluator evaluator(*model_, {}, coordinates_of_components({3, 4, 5}), Frame::known);
  const std::size_t responses = machine_.model().description().responses.size();
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < machine_.errors(); ++f) varied.emplace_back(f);
  for (const nlohmann::json& one : delta_.at("machines")) {
    const Matrix F = directions_of(one.at("fit")).F;
    const std::size_t count = one.at("errors").size();
    Controllers controllers{Matrix(F.rows(), index(count)), Matrix(0, index(count))};
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> errors(F.rows(), index(count));
    for (std::size_t s = 0; s < count; ++s) {
      controllers.errors.col(index(s)) = F * vector_of(one.at("estimate")[s]);
      errors.col(index(s)) = errors_of(one.at("errors")[s]);
    }
    evaluator.set(controllers);
    const std::vector<double> no_errors(machine_.errors(), 0.0);
    for (std::size_t m = 0; m < poses_.size(); ++m) {
      std::vector<double> rows(responses * count);
      std::vector<SolveStatus> status(count);
      std::vector<std::uint32_t> iterations(count);
      evaluator.evaluate({.pose = poses_[m],
                          .errors = no_errors,
                          .varied = varied,
                          .values = {errors.data(), static_cast<std::size_t>(errors.size())},
                          .count = count},
                         {.responses = rows, .status = status, .iterations = iterations, .details = {}});
      for (std::size_t s = 0; s < count; ++s) {
        EXPECT_TRUE(solved(status[s]));
        for (std::size_t c = 0; c < kComponents.size(); ++c) {
          const auto row =
              std::ranges::find(machine_.model().description().responses, kComponents[c], &Response::name) -
              machine_.model().description().responses.begin();
          // The iteration of the correction stops within 1e-11 (m, rad).
          EXPECT_NEAR(rows[static_cast<std::size_t>(row) * count + s], one.at("remaining")[s][m][c].get<double>(),
                      5e-11)
              << kComponents[c] << " pose " << m << " machine " << s;
        }
      }
    }
  }
}

/// A machine whose fit failed (NaN estimates) has no solution and does not disturb the other machines.
TEST_F(StudiedMachines, HaveNoSolutionWithoutAFit) {
  CorrectedEvaluator evaluator(*model_, {}, coordinates_of_components({3, 4, 5}), Frame::known);
  Controllers controllers{Matrix::Zero(index(machine_.errors()), 2), Matrix(0, 2)};
  controllers.errors.col(0).setConstant(std::numeric_limits<double>::quiet_NaN());
  evaluator.set(controllers);
  const std::vector<double> no_errors(machine_.errors(), 0.0);
  std::vector<double> rows(machine_.model().description().responses.size() * 2);
  std::vector<SolveStatus> status(2);
  std::vector<std::uint32_t> iterations(2);
  evaluator.evaluate({.pose = poses_[1], .errors = no_errors, .varied = {}, .values = {}, .count = 2},
                     {.responses = rows, .status = status, .iterations = iterations, .details = {}});
  EXPECT_EQ(status[0], SolveStatus::non_finite);
  EXPECT_TRUE(std::isnan(rows[0]));
  EXPECT_TRUE(solved(status[1]));
  for (std::size_t r = 0; r < rows.size(); r += 2) EXPECT_NEAR(rows[r + 1], 0.0, 1e-13);
}

}  // namespace
}  // namespace poesy::calibration
