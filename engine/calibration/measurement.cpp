#include "engine/calibration/measurement.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/base/contract.h"
#include "models/lie/so3.h"

namespace poesy::calibration {
namespace {

constexpr std::size_t kFirstLength = 3;  ///< index in kComponents of the first length
constexpr std::size_t kFirstOfTip = 6;   ///< index in kComponents of the first coordinate of the tool point
constexpr Eigen::Index kZ = 2;

/// The axis of a component: 0, 1 or 2.
Eigen::Index axis_of(std::size_t component) { return static_cast<Eigen::Index>(component % 3); }

Vector3 three(const Vector& numbers, std::size_t first) { return numbers.segment<3>(static_cast<Eigen::Index>(first)); }

/// The numbers phi of the measuring device and of the target, as vectors and matrices; see Measurement for the symbols.
struct Places {
  Vector3 moved = Vector3::Zero();            ///< translation tau, m
  Matrix3 turn = Matrix3::Identity();         ///< rotation matrix E(rho)
  Vector3 plane = Vector3::Zero();            ///< offset c (m) and slopes a and b
  Vector3 offset = Vector3::Zero();           ///< offset of the target in the platform's axes, m
  Matrix3 target_turn = Matrix3::Identity();  ///< rotation matrix of the target's axes
};

Places places_of(const Vector& phi, Frame frame, Target target) {
  Places places;
  if (frame == Frame::height) places.plane.x() = phi(0);
  if (frame == Frame::plane) places.plane = three(phi, 0);
  if (frame == Frame::rigid) {
    places.moved = three(phi, 0);
    places.turn = lie::exp(three(phi, 3));
  }
  const std::size_t first = numbers_of(frame);
  if (target != Target::known) places.offset = three(phi, first);
  if (target == Target::rigid) places.target_turn = lie::exp(three(phi, first + 3));
  return places;
}

/// The translation tau (m) and the rotation vector rho (rad) of the rigid motion that maps the points `from` to `to`
/// with the least sum of squares.
Vector rigid_motion(const std::vector<Vector3>& from, const std::vector<Vector3>& to) {
  Vector3 middle_from = Vector3::Zero();
  Vector3 middle_to = Vector3::Zero();
  for (std::size_t k = 0; k < from.size(); ++k) {
    middle_from += from[k] / static_cast<double>(from.size());
    middle_to += to[k] / static_cast<double>(to.size());
  }
  Matrix3 product = Matrix3::Zero();
  for (std::size_t k = 0; k < from.size(); ++k) product += (to[k] - middle_to) * (from[k] - middle_from).transpose();
  const auto svd = linalg::singular_value_decomposition(product);
  Matrix3 signs = Matrix3::Identity();
  if ((svd.U * svd.V.transpose()).determinant() < 0.0) signs(2, 2) = -1.0;
  const Matrix3 turn = svd.U * signs * svd.V.transpose();
  Vector motion(6);
  motion << middle_to - turn * middle_from, lie::log(turn);
  return motion;
}

/// The value that is measured at these displacements, SI.
double value_of(const MeasuredValue& value, const std::vector<Placement>& nominals,
                const std::vector<Displacement>& displacements, const Places& places) {
  const Placement& nominal = nominals[value.row];
  const Displacement& displacement = displacements[value.row];
  // The displacement of the measured point (the target at P or at the tool point) at a pose, in the base frame.
  const auto moved = [&](std::size_t row, bool is_tip) -> Vector3 {
    const Displacement& by = displacements[row];
    const Vector3 arm = is_tip ? Vector3(nominals[row].tip - nominals[row].origin) : Vector3(Vector3::Zero());
    return by.moved + (by.turn - Matrix3::Identity()) * arm + by.turn * nominals[row].turn * places.offset;
  };
  if (value.what == Measured::distance) {
    const Vector3 apart = nominals[value.row].tip - nominals[value.other].tip;
    return (apart + moved(value.row, true) - moved(value.other, true)).norm();
  }
  if (value.component < kFirstLength) {
    const Matrix3 target = nominal.turn * places.target_turn * nominal.turn.transpose();
    return lie::log(Matrix3(places.turn * displacement.turn * target))(axis_of(value.component));
  }
  const bool is_tip = value.component >= kFirstOfTip;
  const Vector3 point = is_tip ? nominal.tip : nominal.origin;
  const Vector3 by = moved(value.row, is_tip);
  const Vector3 seen = (places.turn - Matrix3::Identity()) * point + places.turn * by + places.moved;
  const Eigen::Index axis = axis_of(value.component);
  double found = seen(axis);
  if (axis == kZ) {
    const Vector3 actual = point + by;
    found -= places.plane.x() + places.plane.y() * actual.x() + places.plane.z() * actual.y();
  }
  return value.what == Measured::actual ? point(axis) + found : found;
}

}  // namespace

std::size_t numbers_of(Frame frame) {
  constexpr std::array<std::size_t, 4> kNumbers{0, 1, 3, 6};
  return kNumbers[static_cast<std::size_t>(frame)];
}

std::size_t numbers_of(Target target) { return 3 * static_cast<std::size_t>(target); }

Measurement::Measurement(ExactMachine& machine, std::vector<MeasuredPose> poses, std::vector<MeasuredValue> values,
                         Frame frame, Target target)
    : machine_(&machine), poses_(std::move(poses)), values_(std::move(values)), frame_(frame), target_(target) {
  for (const MeasuredPose& pose : poses_) {
    nominal_.push_back(machine.nominal(pose.pose));
    drive_at_.push_back(machine.nominal(pose.drive_at));
  }
}

Vector Measurement::measured() const {
  Vector list(static_cast<Eigen::Index>(values_.size()));
  for (std::size_t i = 0; i < values_.size(); ++i) list(static_cast<Eigen::Index>(i)) = values_[i].value;
  return list;
}

void Measurement::set_measured(const Vector& values) {
  POESY_EXPECTS(static_cast<std::size_t>(values.size()) == values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i].value = values(static_cast<Eigen::Index>(i));
}

std::vector<std::vector<Displacement>> Measurement::displacements_of_solved(const Matrix& errors) const {
  std::vector<std::vector<Displacement>> list(static_cast<std::size_t>(errors.cols()));
  for (std::size_t row = 0; row < poses_.size(); ++row) {
    const auto found = machine_->displaced(poses_[row].drive_at, errors);
    for (std::size_t b = 0; b < found.size(); ++b) {
      if (found[b] && list[b].size() == row) list[b].push_back(seen_from(*found[b], drive_at_[row], nominal_[row]));
    }
  }
  for (auto& machine : list) {
    if (machine.size() < poses_.size()) machine.clear();
  }
  return list;
}

std::optional<std::vector<std::vector<Displacement>>> Measurement::displacements(const Matrix& errors) const {
  auto list = displacements_of_solved(errors);
  const bool is_solved = std::ranges::none_of(list, [](const auto& machine) { return machine.empty(); });
  return is_solved ? std::optional(std::move(list)) : std::nullopt;
}

std::optional<std::vector<Displacement>> Measurement::displacements(const Vector& errors) const {
  auto list = displacements(Matrix(errors));
  if (!list) return std::nullopt;
  return std::move(list->front());
}

Vector Measurement::values_of(const std::vector<Displacement>& displacements, const Vector& phi) const {
  POESY_EXPECTS(displacements.size() == poses_.size());
  const Places places = places_of(phi, frame_, target_);
  Vector list(static_cast<Eigen::Index>(values_.size()));
  for (std::size_t i = 0; i < values_.size(); ++i) {
    list(static_cast<Eigen::Index>(i)) = value_of(values_[i], nominal_, displacements, places);
  }
  return list;
}

Vector Measurement::start() const {
  Vector phi = Vector::Zero(static_cast<Eigen::Index>(places()));
  if (frame_ != Frame::rigid) return phi;
  std::vector<Vector3> from;
  std::vector<Vector3> to;
  for (std::size_t row = 0; row < poses_.size(); ++row) {
    for (const std::size_t first : {kFirstLength, kFirstOfTip}) {
      const Vector3 point = first == kFirstOfTip ? nominal_[row].tip : nominal_[row].origin;
      Vector3 seen = point;
      std::size_t coordinates = 0;
      for (const MeasuredValue& value : values_) {
        const bool is_here = value.what != Measured::distance && value.row == row && value.component >= first &&
                             value.component < first + 3;
        if (!is_here) continue;
        const Eigen::Index axis = axis_of(value.component);
        seen(axis) = value.value + (value.what == Measured::deviation ? point(axis) : 0.0);
        ++coordinates;
      }
      if (coordinates != 3) continue;
      from.push_back(point);
      to.push_back(seen);
    }
  }
  constexpr std::size_t kLeastPoints = 3;
  if (from.size() >= kLeastPoints) phi.head<6>() = rigid_motion(from, to);
  return phi;
}

}  // namespace poesy::calibration
