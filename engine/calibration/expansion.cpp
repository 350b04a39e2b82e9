#include "engine/calibration/expansion.h"

#include <stdexcept>

#include "engine/calibration/fit.h"
#include "models/lie/so3.h"

namespace poesy::calibration {
namespace {

using Eigen::Index;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Steps for finite differences. The step of a fitted number is chosen so that no displacement of the platform changes
// by more than kStepOfValue (m, rad).
constexpr double kStepOfValue = 1e-5;
// The step of each number that describes the place of the measuring device or of the target (m, rad or a slope).
constexpr double kStepOfPlace = 1e-5;

Vector6 numbers_of(const Displacement& displacement) {
  Vector6 numbers;
  numbers << lie::log(displacement.turn), displacement.moved;
  return numbers;
}

Displacement displaced_by(const Vector6& numbers) { return {lie::exp(Vector3(numbers.head<3>())), numbers.tail<3>()}; }

/// The errors [all errors x machines] of the machines from which an expansion about zero errors is computed. The first
/// machine has no errors. Then come two machines for each fitted number, one step forward and one step back, and two
/// for each pair of numbers, both forward and both back.
Matrix machines_around(const FittedDirections& directions) {
  const Matrix steps = directions.F * directions.step.asDiagonal();
  const Index k = steps.cols();
  Matrix errors = Matrix::Zero(steps.rows(), 1 + 2 * k + k * (k - 1));
  for (Index j = 0, next = 1 + 2 * k; j < k; ++j) {
    errors.col(1 + 2 * j) = steps.col(j);
    errors.col(2 + 2 * j) = -steps.col(j);
    for (Index i = 0; i < j; ++i, next += 2) {
      errors.col(next) = steps.col(i) + steps.col(j);
      errors.col(next + 1) = -errors.col(next);
    }
  }
  return errors;
}

}  // namespace

Expansion::Expansion(const Measurement& measurement, const FittedDirections& directions) {
  const auto found = measurement.displacements(machines_around(directions));
  if (!found) throw std::invalid_argument("is not solved with errors of a thousandth of its size at a measured pose");
  without_errors_ = found->front();
  const Vector& h = directions.step;
  const Index k = h.size();
  for (std::size_t row = 0; row < measurement.poses().size(); ++row) {
    const auto at = [&](Index n) { return numbers_of((*found)[static_cast<std::size_t>(n)][row]); };
    const Vector6 none = at(0);
    AtPose pose{Matrix(6, k), {}};
    for (Matrix& curvature : pose.curvature) curvature = Matrix(k, k);
    for (Index j = 0, next = 1 + 2 * k; j < k; ++j) {
      const Vector6 up = at(1 + 2 * j);
      const Vector6 down = at(2 + 2 * j);
      pose.slope.col(j) = (up - down) / (2.0 * h(j));
      for (Index c = 0; c < 6; ++c) {
        pose.curvature[static_cast<std::size_t>(c)](j, j) = (up(c) - 2.0 * none(c) + down(c)) / (h(j) * h(j));
      }
      for (Index i = 0; i < j; ++i, next += 2) {
        const Vector6 mixed =
            (at(next) + at(next + 1) - at(1 + 2 * i) - at(2 + 2 * i) - up - down + 2.0 * none) / (2.0 * h(i) * h(j));
        for (Index c = 0; c < 6; ++c) {
          Matrix& curvature = pose.curvature[static_cast<std::size_t>(c)];
          curvature(i, j) = curvature(j, i) = mixed(c);
        }
      }
    }
    poses_.push_back(std::move(pose));
  }
}

Derivatives Expansion::derivatives(const Measurement& measurement, const Vector& theta,
                                   const std::vector<Displacement>& displacements, const Vector& phi) const {
  const Index k = theta.size();
  const auto m = static_cast<Index>(measurement.size());
  std::vector<Matrix> slopes;
  std::vector<Vector6> here;
  for (std::size_t row = 0; row < poses_.size(); ++row) {
    Matrix slope = poses_[row].slope;
    for (Index c = 0; c < 6; ++c)
      slope.row(c) += (poses_[row].curvature[static_cast<std::size_t>(c)] * theta).transpose();
    slopes.push_back(std::move(slope));
    here.push_back(numbers_of(displacements[row]));
  }
  Derivatives found{Matrix(m, k), Matrix(m, phi.size())};
  std::vector<Displacement> moved(poses_.size());
  for (Index j = 0; j < k; ++j) {
    double largest = 0.0;
    for (const Matrix& slope : slopes) largest = std::max(largest, slope.col(j).cwiseAbs().maxCoeff());
    const double step = kStepOfValue / std::max(largest, 1e-300);
    const auto values = [&](double by) {
      for (std::size_t row = 0; row < moved.size(); ++row)
        moved[row] = displaced_by(here[row] + by * slopes[row].col(j));
      return measurement.values_of(moved, phi);
    };
    found.errors.col(j) =
        largest == 0.0 ? Vector(Vector::Zero(m)) : Vector((values(step) - values(-step)) / (2.0 * step));
  }
  for (Index j = 0; j < phi.size(); ++j) {
    const auto values = [&](double by) {
      Vector place = phi;
      place(j) += by;
      return measurement.values_of(displacements, place);
    };
    found.places.col(j) = (values(kStepOfPlace) - values(-kStepOfPlace)) / (2.0 * kStepOfPlace);
  }
  return found;
}

}  // namespace poesy::calibration
