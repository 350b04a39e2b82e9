#include "engine/calibration/drive_correction.h"

#include <cmath>
#include <utility>

namespace poesy::calibration {
namespace {

constexpr int kMostSteps = 30;
constexpr double kExact = 1e-15;  // m or rad: a smaller coordinate error is only rounding
// m or rad: a smaller coordinate error is accepted if a step no longer halves it.
constexpr double kAsExact = 1e-12;
constexpr double kStepOfPose = 1e-5;  // m or rad: step of the coordinates for finite differences

const Displacement kNone{Matrix3::Identity(), Vector3::Zero()};

std::vector<double> moved(std::span<const double> pose, const Vector& by) {
  std::vector<double> other(pose.begin(), pose.end());
  for (std::size_t c = 0; c < other.size(); ++c) other[c] += by(static_cast<Eigen::Index>(c));
  return other;
}

}  // namespace

CoordinateError coordinates_of_components(std::vector<std::size_t> positions) {
  return [positions = std::move(positions)](const Placement& nominal, const Displacement& displacement) {
    const Components all = components(displacement, nominal);
    Vector list(static_cast<Eigen::Index>(positions.size()));
    for (std::size_t n = 0; n < positions.size(); ++n) {
      list(static_cast<Eigen::Index>(n)) = all(static_cast<Eigen::Index>(positions[n]));
    }
    return list;
  };
}

CommandedPose DriveCorrection::at(std::span<const double> pose) const {
  const Placement nominal = machine_->nominal(pose);
  const auto n = static_cast<Eigen::Index>(pose.size());
  Matrix by_pose(n, n);
  Matrix motion(6, n);
  for (Eigen::Index c = 0; c < n; ++c) {
    Vector by = Vector::Zero(n);
    by(c) = kStepOfPose;
    const Displacement up = seen_from(kNone, machine_->nominal(moved(pose, by)), nominal);
    const Displacement down = seen_from(kNone, machine_->nominal(moved(pose, -by)), nominal);
    by_pose.col(c) = (commanded_(nominal, up) - commanded_(nominal, down)) / (2.0 * kStepOfPose);
    motion.col(c) = (components(up, nominal) - components(down, nominal)).head<6>() / (2.0 * kStepOfPose);
  }
  return {{pose.begin(), pose.end()}, nominal, motion, linalg::inverse(by_pose)};
}

std::vector<double> DriveCorrection::without(std::span<const double> pose, const CommandedPose& commanded,
                                             const Vector& error) {
  return moved(pose, -commanded.per_error * error);
}

std::optional<std::vector<double>> DriveCorrection::drive_at(std::span<const double> pose, const Vector& errors) const {
  const CommandedPose commanded = at(pose);
  std::vector<double> other = commanded.pose;
  double before = HUGE_VAL;
  for (int n = 0; n < kMostSteps; ++n) {
    if (machine_->model().unreachable(other)) return std::nullopt;
    const auto displacement = machine_->displaced(other, errors);
    if (!displacement) return std::nullopt;
    const Vector error = error_of(commanded, machine_->nominal(other), *displacement);
    const double size = error.cwiseAbs().maxCoeff();
    if (size < kExact || (size < kAsExact && size > 0.5 * before)) return other;
    before = size;
    other = without(other, commanded, error);
  }
  return std::nullopt;
}

}  // namespace poesy::calibration
