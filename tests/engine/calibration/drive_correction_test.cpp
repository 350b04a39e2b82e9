#include "engine/calibration/drive_correction.h"

#include <gtest/gtest.h>

#include "engine/calibration/next_poses.h"
#include "tests/engine/calibration/read_mechanism.h"

namespace poesy::calibration {
namespace {

/// A controller that knows all errors brings a platform with six freedoms back to its pose.
TEST(DriveCorrection, LeavesNothingOfSixFreedoms) {
  const auto model = model_of(mechanism_text("hexapod.toml"));
  ExactMachine machine(*model, {});
  const DriveCorrection correction(machine, coordinates_of_components({3, 4, 5, 0, 1, 2}));
  Vector errors(static_cast<Eigen::Index>(machine.errors()));
  for (Eigen::Index f = 0; f < errors.size(); ++f) errors(f) = 1e-3 * std::sin(static_cast<double>(5 * f + 1));
  const std::vector<double> pose{0.02, -0.03, 0.82, 0.05, -0.04, 0.06};
  const auto drive_at = correction.drive_at(pose, errors);
  ASSERT_TRUE(drive_at.has_value());
  const auto found = machine.displaced(*drive_at, errors);
  ASSERT_TRUE(found.has_value());
  const Placement nominal = machine.nominal(pose);
  const Displacement left = seen_from(*found, machine.nominal(*drive_at), nominal);
  EXPECT_LT(components(left, nominal).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(components(*found, nominal).cwiseAbs().maxCoeff(), 1e-5);
}

/// Without errors the corrected drive pose is the commanded pose.
TEST(DriveCorrection, OfNoErrorsIsThePoseItself) {
  const auto model = model_of(mechanism_text("delta-puu.toml"));
  ExactMachine machine(*model, {});
  const DriveCorrection correction(machine, coordinates_of_components({3, 4, 5}));
  const std::vector<double> pose{0.02, -0.03, 0.01};
  const auto drive_at = correction.drive_at(pose, Vector::Zero(static_cast<Eigen::Index>(machine.errors())));
  ASSERT_TRUE(drive_at.has_value());
  for (std::size_t c = 0; c < pose.size(); ++c) EXPECT_NEAR((*drive_at)[c], pose[c], 1e-13);
}

/// One fitted number with information q, and one measured value y = a x with the noise sigma 1: the gain is log2(1 +
/// a^2 / q) / 2 bits.
TEST(NextPoses, HaveTheGainOfOneNumber) {
  const Matrix information = Matrix::Constant(1, 1, 4.0);
  const auto chosen = next_poses(information, {Matrix::Constant(1, 1, 1.0), Matrix::Constant(1, 1, 3.0)}, 1, 2);
  ASSERT_EQ(chosen.size(), 2U);
  EXPECT_EQ(chosen[0].candidate, 1U);
  EXPECT_NEAR(chosen[0].gain, 0.5 * std::log2(1.0 + 9.0 / 4.0), 1e-14);
  EXPECT_EQ(chosen[1].candidate, 1U);
  EXPECT_NEAR(chosen[1].gain, 0.5 * std::log2(1.0 + 9.0 / 13.0), 1e-14);
}

/// The first column is an error, the second an unknown of the measuring frame. The gain counts only the information on
/// the error that remains after the frame is eliminated (Schur complement).
TEST(NextPoses, CountWhatTheFrameLeaves) {
  const Matrix information = Matrix::Identity(2, 2);
  const Matrix row{{2.0, 1.0}};
  const auto chosen = next_poses(information, {row}, 1, 1);
  // Q + a^T a = [[5, 2], [2, 2]], whose Schur complement is 5 - 4 / 2 = 3.
  EXPECT_NEAR(chosen.front().gain, 0.5 * std::log2(3.0), 1e-14);
}

}  // namespace
}  // namespace poesy::calibration
