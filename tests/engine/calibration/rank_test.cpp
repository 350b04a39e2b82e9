#include <gtest/gtest.h>

#include <cmath>

#include "engine/calibration/fit.h"
#include "tests/engine/calibration/read_mechanism.h"

namespace poesy::calibration {
namespace {

/// Irregular poses within the workspace of the hexapod.
std::vector<MeasuredPose> generic_poses(std::size_t count) {
  std::vector<MeasuredPose> poses;
  const auto irregular = [](std::size_t n, std::size_t c) {
    return std::sin(static_cast<double>(3 * n * n + 7 * c + 5 * n * c + 1));
  };
  for (std::size_t n = 0; n < count; ++n) {
    std::vector<double> pose;
    for (std::size_t c = 0; c < 6; ++c) pose.push_back((c < 3 ? 0.05 : 0.12) * irregular(n, c));
    pose[2] += 0.81;
    poses.push_back({pose, pose});
  }
  return poses;
}

/// The hexapod of Nategh and Agheli with its 42 errors. The tool point is not at the origin of the platform.
class Rank : public testing::Test {
 protected:
  Rank() : model_(model_of(with_tool())), machine_(*model_, {}) {
    const Eigen::Index errors = static_cast<Eigen::Index>(machine_.errors());
    directions_ = directions_for(machine_, Matrix::Identity(errors, errors), 1e-4);
  }

  static std::string with_tool() {
    std::string text = mechanism_text("hexapod.toml");
    return text.replace(text.find("rotation "), 0, "tool = [\"30 mm\", \"-20 mm\", \"70 mm\"]\n");
  }

  /// The rank of the identification problem if these components are measured at 60 poses.
  std::size_t rank(const std::vector<std::size_t>& components, Frame frame, Target target) {
    const std::vector<MeasuredPose> poses = generic_poses(60);
    std::vector<MeasuredValue> values;
    for (std::size_t row = 0; row < poses.size(); ++row) {
      for (const std::size_t c : components) {
        values.push_back({.what = Measured::deviation, .row = row, .component = c, .sd = c < 3 ? 5e-5 : 1e-5});
      }
    }
    return rank_of(poses, values, frame, target);
  }

  std::size_t rank_of_distances(Target target) {
    const std::vector<MeasuredPose> poses = generic_poses(30);
    std::vector<MeasuredValue> values;
    for (std::size_t row = 0; row + 3 < poses.size(); ++row) {
      for (const std::size_t step : {1, 2, 3}) {
        values.push_back({.what = Measured::distance, .row = row, .other = row + step, .sd = 1e-5});
      }
    }
    return rank_of(poses, values, Frame::known, target);
  }

 private:
  std::size_t rank_of(const std::vector<MeasuredPose>& poses, const std::vector<MeasuredValue>& values, Frame frame,
                      Target target) {
    const Measurement measurement(machine_, poses, values, frame, target);
    const auto k = static_cast<Eigen::Index>(machine_.errors());
    const Vector phi = Vector::Zero(static_cast<Eigen::Index>(measurement.places()));
    const auto derivatives = FittedMeasurement(measurement, directions_).derivatives(Vector::Zero(k), phi);
    if (!derivatives) return 0;
    Vector sd(static_cast<Eigen::Index>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) sd(static_cast<Eigen::Index>(i)) = values[i].sd;
    return scaled_fit(*derivatives, sd, directions_.scale).rank;
  }

  std::unique_ptr<Model> model_;
  ExactMachine machine_;
  FittedDirections directions_;
};

const std::vector<std::size_t> kFullPose{0, 1, 2, 3, 4, 5};
const std::vector<std::size_t> kTip{6, 7, 8};
const std::vector<std::size_t> kTipHeight{8};

TEST_F(Rank, OfFullPoses) {
  EXPECT_EQ(rank(kFullPose, Frame::known, Target::known), 42U);
  EXPECT_EQ(rank(kFullPose, Frame::rigid, Target::known), 36U);
  EXPECT_EQ(rank(kFullPose, Frame::rigid, Target::rigid), 30U);
}

TEST_F(Rank, OfPositionsOfAPointOffTheOrigin) {
  EXPECT_EQ(rank(kTip, Frame::known, Target::known), 39U);
  EXPECT_EQ(rank(kTip, Frame::rigid, Target::known), 33U);
  EXPECT_EQ(rank(kTip, Frame::rigid, Target::point), 30U);
}

TEST_F(Rank, OfDistances) {
  EXPECT_EQ(rank_of_distances(Target::known), 33U);
  EXPECT_EQ(rank_of_distances(Target::point), 30U);
}

TEST_F(Rank, OfHeights) {
  EXPECT_EQ(rank(kTipHeight, Frame::known, Target::known), 36U);
  EXPECT_EQ(rank(kTipHeight, Frame::height, Target::known), 35U);
  EXPECT_EQ(rank(kTipHeight, Frame::plane, Target::known), 33U);
}

}  // namespace
}  // namespace poesy::calibration
