#include "engine/calibration/drive_correction.h"

#include <cmath>
#include <utility>

namespace poesy::calibration {
namespace {

constexpr int kMostSteps = 30;
constexpr double kExact = 1e-15;      // m or rad: a smaller error of a coordinate is rounding
constexpr double kAsExact = 1e-12;    // m or rad: what may remain where steps no longer help
constexpr double kStepOfPose = 1e-5;  // m or rad, of differences

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

Vector DriveCorrection::error_at(const Placement& nominal, std::span<const double> other,
                                 const Displacement& displacement) const {
  return commanded_(nominal, seen_from(displacement, machine_->nominal(other), nominal));
}

Matrix DriveCorrection::by_pose(std::span<const double> pose) const {
  const Placement nominal = machine_->nominal(pose);
  const auto n = static_cast<Eigen::Index>(pose.size());
  Matrix found(n, n);
  for (Eigen::Index c = 0; c < n; ++c) {
    Vector by = Vector::Zero(n);
    by(c) = kStepOfPose;
    const Displacement up = seen_from(kNone, machine_->nominal(moved(pose, by)), nominal);
    const Displacement down = seen_from(kNone, machine_->nominal(moved(pose, -by)), nominal);
    found.col(c) = (commanded_(nominal, up) - commanded_(nominal, down)) / (2.0 * kStepOfPose);
  }
  return found;
}

std::optional<std::vector<double>> DriveCorrection::drive_at(std::span<const double> pose, const Vector& errors) const {
  const Placement nominal = machine_->nominal(pose);
  const Matrix per_error = linalg::inverse(by_pose(pose));
  std::vector<double> other(pose.begin(), pose.end());
  double before = HUGE_VAL;
  for (int n = 0; n < kMostSteps; ++n) {
    if (machine_->model().unreachable(other)) return std::nullopt;
    const auto displacement = machine_->displaced(other, errors);
    if (!displacement) return std::nullopt;
    const Vector error = error_at(nominal, other, *displacement);
    const double size = error.cwiseAbs().maxCoeff();
    if (size < kExact || (size < kAsExact && size > 0.5 * before)) return other;
    before = size;
    other = moved(other, -per_error * error);
  }
  return std::nullopt;
}

}  // namespace poesy::calibration
