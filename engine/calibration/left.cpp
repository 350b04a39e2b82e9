#include "engine/calibration/left.h"

#include <array>
#include <cmath>
#include <utility>

#include "models/lie/so3.h"

namespace poesy::calibration {
namespace {

// m, rad or a slope: step of each number of phi (see Derivatives) for finite differences
constexpr double kStepOfPlace = 1e-5;
// Step of central differences of second order, as a share of FittedDirections::step. With this step the differences are
// exact to 1e-10.
constexpr double kShareOfStep = 0.02;

/// [9 x (numbers + places)] The derivatives of the remaining displacement with respect to theta, the fitted numbers of
/// the errors, and to phi, the numbers of the device's frame and of the target. at: errors at which the derivatives are
/// taken.
Matrix left_derivatives(ExactMachine& machine, std::span<const double> pose, std::span<const double> drive_at,
                        const Vector& at, const Corrected& corrected, const Knowledge& known) {
  const Eigen::Index k = known.theta.size();
  const Eigen::Index places = known.phi.size();
  const Vector steps = kShareOfStep * known.directions.step;
  Matrix errors = at.replicate(1, 2 * (k + places));
  Matrix phi = known.phi.replicate(1, 2 * (k + places));
  for (Eigen::Index j = 0; j < k; ++j) {
    errors.col(2 * j) += steps(j) * known.directions.F.col(j);
    errors.col(2 * j + 1) -= steps(j) * known.directions.F.col(j);
  }
  for (Eigen::Index j = 0; j < places; ++j) {
    phi(j, 2 * (k + j)) += kStepOfPlace;
    phi(j, 2 * (k + j) + 1) -= kStepOfPlace;
  }
  const Matrix left = left_of_machines(machine, pose, drive_at, errors, phi, corrected);
  Matrix G(left.rows(), k + places);
  for (Eigen::Index j = 0; j < k + places; ++j) {
    const double step = j < k ? steps(j) : kStepOfPlace;
    G.col(j) = (left.col(2 * j) - left.col(2 * j + 1)) / (2.0 * step);
  }
  return G;
}

}  // namespace

Displacement seen_by_device(const Displacement& displacement, const Placement& nominal, const Vector& actual,
                            const Vector& believed, Frame frame) {
  if (frame == Frame::rigid) {
    const Matrix3 back = lie::exp(Vector3(believed.segment<3>(3))).transpose();
    const Matrix3 turn = back * lie::exp(Vector3(actual.segment<3>(3)));
    const Vector3 moved = (turn - Matrix3::Identity()) * nominal.origin + turn * displacement.moved +
                          back * (actual.head<3>() - believed.head<3>());
    return {turn * displacement.turn, moved};
  }
  Displacement seen = displacement;
  const Vector3 place = nominal.origin + displacement.moved;
  if (frame == Frame::height) seen.moved.z() += believed(0) - actual(0);
  if (frame == Frame::plane) {
    const Vector3 slopes = believed.head<3>() - actual.head<3>();
    seen.moved.z() += slopes.x() + slopes.y() * place.x() + slopes.z() * place.y();
  }
  return seen;
}

Knowledge knowledge(const FitResult& fit, const FittedDirections& directions, const Vector& sd, const Prior& prior,
                    double sd_factor) {
  const Eigen::Index k = directions.F.cols();
  const Eigen::Index places = fit.phi.size();
  const Matrix weighted = sd.cwiseInverse().asDiagonal() * fit.derivatives.places;
  Vector scale(k + places);
  scale << directions.scale, weighted.colwise().norm().cwiseMax(1e-300).cwiseInverse().transpose();
  Matrix all = Matrix::Zero(sd.size() + prior.root.rows(), k + places);
  all.topLeftCorner(sd.size(), k) = fit.scaled.A;
  all.topRightCorner(sd.size(), places) = weighted * scale.tail(places).asDiagonal();
  if (prior.root.rows() > 0) all.bottomLeftCorner(prior.root.rows(), k) = prior.root * directions.scale.asDiagonal();
  const auto svd = linalg::right_singular_vectors(all);
  Vector inverse = Vector::Zero(k + places);
  for (Eigen::Index j = 0; j < svd.values.size(); ++j) {
    if (svd.values(j) > kUnseen * svd.values(0)) inverse(j) = 1.0 / svd.values(j);
  }
  const Matrix root = sd_factor * (scale.asDiagonal() * svd.V * inverse.asDiagonal());
  return {directions, fit.theta, fit.phi, root * root.transpose()};
}

Matrix left_of_machines(ExactMachine& machine, std::span<const double> pose, std::span<const double> drive_at,
                        const Matrix& errors, const Matrix& phi, const Corrected& corrected) {
  const Placement nominal = machine.nominal(pose);
  const Placement drives = machine.nominal(drive_at);
  const auto found = machine.displaced(drive_at, errors);
  Matrix left = Matrix::Constant(9, errors.cols(), kNaN);
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!found[b]) continue;
    const auto column = static_cast<Eigen::Index>(b);
    const Displacement seen =
        seen_by_device(seen_from(*found[b], drives, nominal), nominal, phi.col(column), corrected.phi, corrected.frame);
    left.col(column) = components(seen, nominal);
  }
  return left;
}

std::optional<LeftAtPose> left_at(ExactMachine& machine, const DriveCorrection& correction,
                                  std::span<const double> pose, const Corrected& corrected, const Knowledge& known) {
  auto drive_at = correction.drive_at(pose, corrected.errors);
  if (!drive_at) return std::nullopt;
  const Vector errors = known.errors();
  const Matrix mean = left_of_machines(machine, pose, *drive_at, errors, known.phi, corrected);
  const bool is_nominal = corrected.frame == Frame::known;
  const Matrix G = left_derivatives(machine, pose, is_nominal ? pose : std::span<const double>(*drive_at),
                                    is_nominal ? Vector(Vector::Zero(errors.size())) : errors, corrected, known);
  if (!mean.allFinite() || !G.allFinite()) return std::nullopt;
  const Vector squares = (G * known.covariance).cwiseProduct(G).rowwise().sum();
  return LeftAtPose{*std::move(drive_at), mean, squares.cwiseMax(0.0).cwiseSqrt()};
}

}  // namespace poesy::calibration
