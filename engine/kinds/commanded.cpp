#include "engine/kinds/commanded.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/nan.h"
#include "engine/study/calibration.h"
#include "models/lie/so3.h"

namespace poesy {
namespace {

using calibration::Displacement;
using calibration::Matrix3;
using calibration::Placement;
using calibration::Vector;
using calibration::Vector3;

/// Two values of a coordinate count as equal if they differ by less than this: rad for an angle, a share of the
/// mechanism's reach for a length.
constexpr double kSameCoordinate = 1e-9;
constexpr const char* kDrives = "actuators";

/// A coordinate of the platform as a function of the platform's placement (position and rotation).
using PlaceCoordinate = std::function<double(const Placement&)>;

/// The angles (rad) of three rotations about the axes i, j and k (`order`) whose product R_i R_j R_k is the rotation
/// matrix R.
Vector3 angles_in_order(const Matrix3& R, const std::array<Eigen::Index, 3>& order) {
  const auto [i, j, k] = order;
  const bool is_even = (j - i + 3) % 3 == 1;
  const double sign = is_even ? 1.0 : -1.0;
  Vector3 angles;
  angles(i) = std::atan2(-sign * R(j, k), R(k, k));
  angles(j) = std::asin(std::clamp(sign * R(i, k), -1.0, 1.0));
  angles(k) = std::atan2(-sign * R(i, j), R(i, i));
  return angles;
}

/// All functions of the placement that are tried for a coordinate of this dimension. For lengths: the components of the
/// position of the platform's origin. Otherwise: the components of the rotation vector, and the angles of rotations
/// about the three axes in any order.
std::vector<PlaceCoordinate> possible_coordinates(Dimension dimension) {
  std::vector<PlaceCoordinate> list;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (dimension == Dimension::length) {
      list.emplace_back([axis](const Placement& place) { return place.origin(axis); });
      continue;
    }
    list.emplace_back([axis](const Placement& place) { return lie::log(place.turn)(axis); });
    std::array<Eigen::Index, 3> order{0, 1, 2};
    do {
      list.emplace_back([axis, order](const Placement& place) { return angles_in_order(place.turn, order)(axis); });
    } while (std::ranges::next_permutation(order).found);
  }
  return list;
}

/// Poses at which the values of coordinates are compared: up to four reachable poses spread over the workspace, and up
/// to four poses of the list `poses`.
std::vector<std::vector<double>> test_poses(const Model& model, const PoseSet& poses) {
  constexpr std::array<double, 4> kShares{0.37, 0.61, 0.44, 0.72};
  const ModelDescription& description = model.description();
  std::vector<std::vector<double>> list;
  for (std::size_t n = 0; n < kShares.size(); ++n) {
    std::vector<double> pose;
    for (std::size_t c = 0; c < description.pose_coordinates.size(); ++c) {
      const double share = kShares[(n + c) % kShares.size()] + 0.03 * static_cast<double>(c);
      pose.push_back(std::lerp(description.pose_lower[c], description.pose_upper[c], share));
    }
    if (!model.unreachable(pose)) list.push_back(std::move(pose));
  }
  for (std::size_t m = 0; m < std::min<std::size_t>(poses.size(), 4); ++m) {
    list.emplace_back(poses[PoseIndex(m)].begin(), poses[PoseIndex(m)].end());
  }
  return list;
}

/// Finds the function of the platform's placement that has the same values as a coordinate of the mechanism at all test
/// poses.
class Recognition {
 public:
  Recognition(const Model& model, const calibration::ExactMachine& machine, const PoseSet& poses)
      : description_(&model.description()), poses_(test_poses(model, poses)), reach_(machine.reach()) {
    for (const std::vector<double>& pose : poses_) places_.push_back(machine.nominal(pose));
  }

  /// The function for the coordinate of this name; none if it is not recognised.
  std::optional<PlaceCoordinate> operator()(const std::string& name) const {
    constexpr std::array<std::string_view, 3> kTip{"tip_x", "tip_y", "tip_z"};
    const auto own = std::ranges::find(description_->pose_coordinates, name, &PoseCoordinate::name);
    if (own == description_->pose_coordinates.end()) {
      const auto tip = std::ranges::find(kTip, name);
      if (tip == kTip.end()) return std::nullopt;
      return [axis = tip - kTip.begin()](const Placement& place) { return place.tip(axis); };
    }
    const auto c = static_cast<std::size_t>(own - description_->pose_coordinates.begin());
    for (PlaceCoordinate& possible : possible_coordinates(own->dimension)) {
      if (gives(possible, c, own->dimension)) return std::move(possible);
    }
    return std::nullopt;
  }

 private:
  bool gives(const PlaceCoordinate& possible, std::size_t c, Dimension dimension) const {
    const double same = kSameCoordinate * (dimension == Dimension::length ? reach_ : 1.0);
    for (std::size_t n = 0; n < poses_.size(); ++n) {
      if (!(std::abs(possible(places_[n]) - poses_[n][c]) < same)) return false;
    }
    return !poses_.empty();
  }

  const ModelDescription* description_;
  std::vector<std::vector<double>> poses_;
  std::vector<Placement> places_;
  double reach_;
};

Placement moved(const Placement& nominal, const Displacement& by) {
  return {by.turn * nominal.turn, nominal.origin + by.moved,
          nominal.tip + by.moved + (by.turn - Matrix3::Identity()) * (nominal.tip - nominal.origin)};
}

/// The number of drives of a mechanism. Actuated joints that name the same drive count as one drive. 0 if the model has
/// no sketch.
std::size_t count_drives(const Model& model) {
  std::set<std::string> named;
  std::size_t alone = 0;
  const auto sketch = model.sketch({});
  if (!sketch) return 0;
  for (const auto& limb : sketch->limbs) {
    for (const SketchedJoint& joint : limb) {
      if (!joint.actuated) continue;
      if (joint.drive.empty()) ++alone;
      if (!joint.drive.empty()) named.insert(joint.drive);
    }
  }
  return alone + named.size();
}

/// Throws InputError unless the drives of each motor move together at all test poses of the nominal mechanism.
void check_motors(const CalibrationTable& table, const Model& model, const PoseSet& poses) {
  constexpr double kMovedTogether = 1e-9;  // m or rad
  const std::vector<std::vector<double>> tests = test_poses(model, poses);
  const std::vector<double> first = model.joint_displacements(tests.front());
  for (const std::vector<double>& pose : tests) {
    const std::vector<double> now = model.joint_displacements(pose);
    const auto moved_by = [&](const std::string& drive) {
      const auto joint = std::ranges::find(model.description().joints, drive, &JointDisplacement::name);
      const auto at = static_cast<std::size_t>(joint - model.description().joints.begin());
      return now[at] - first[at];
    };
    for (const std::vector<std::string>& motor : table.motors) {
      for (const std::string& drive : motor) {
        if (std::abs(moved_by(drive) - moved_by(motor.front())) < kMovedTogether) continue;
        throw InputError(
            table.coordinates_place,
            fmt::format("motor {} and {}: the perfect mechanism does not move them together", motor.front(), drive),
            "say which drives move together (motors)");
      }
    }
  }
}

void check_drives(const Study& study, const Model& model, const PoseSet& poses) {
  const CalibrationTable& table = *study.analysis.calibration;
  if (!table.motors.empty()) return check_motors(table, model, poses);
  const std::size_t coordinates = model.description().pose_coordinates.size();
  const std::size_t drives = count_drives(model);
  if (drives == coordinates) return;
  throw InputError(table.place, fmt::format("{} motors and {} commanded coordinates", drives, coordinates),
                   "say which drives move together (motors), or what else is commanded (coordinates)");
}

}  // namespace

calibration::CoordinateError commanded_coordinates(const Study& study, const Model& model,
                                                   const calibration::ExactMachine& machine, const PoseSet& poses) {
  check_drives(study, model, poses);
  const CalibrationTable& table = *study.analysis.calibration;
  std::vector<std::string> commanded = table.coordinates;
  if (commanded.empty()) {
    for (const PoseCoordinate& own : model.description().pose_coordinates) commanded.push_back(own.name);
  }
  const Recognition recognise(model, machine, poses);
  std::vector<PlaceCoordinate> coordinates;
  for (const std::string& name : commanded) {
    auto found = recognise(name);
    if (!found) {
      throw InputError(table.place,
                       fmt::format("the coordinate '{}' cannot be commanded, because it is not a coordinate of P or of "
                                   "the tool's point, nor an angle that is known",
                                   name),
                       "name other coordinates (coordinates)");
    }
    coordinates.push_back(*std::move(found));
  }
  return [coordinates = std::move(coordinates)](const Placement& nominal, const Displacement& by) {
    const Placement actual = moved(nominal, by);
    Vector error(static_cast<Eigen::Index>(coordinates.size()));
    for (std::size_t c = 0; c < coordinates.size(); ++c) {
      error(static_cast<Eigen::Index>(c)) = coordinates[c](actual) - coordinates[c](nominal);
    }
    return error;
  };
}

std::vector<NamedUnit> drives_of(const Study& study) {
  const ModelDescription& model = study.model();
  std::vector<NamedUnit> list;
  const auto add = [&](const std::string& name, Dimension dimension) {
    list.push_back({name, std::string(si_unit(dimension))});
  };
  for (const std::vector<std::string>& motor : study.analysis.calibration->motors) {
    const auto joint = std::ranges::find(model.joints, motor.front(), &JointDisplacement::name);
    add(joint->name, joint->dimension);
  }
  const auto chart = std::ranges::find(model.charts, kDrives, &PoseChart::name);
  if (!list.empty() || chart == model.charts.end()) return list;
  for (const PoseCoordinate& drive : chart->coordinates) add(drive.name, drive.dimension);
  return list;
}

std::vector<double> drive_shift(const Model& model, const std::vector<NamedUnit>& drives, std::span<const double> pose,
                                std::span<const double> drive_at) {
  const std::vector<double> at = model.joint_displacements(pose);
  const std::vector<double> corrected = model.joint_displacements(drive_at);
  std::vector<double> list;
  for (const NamedUnit& drive : drives) {
    const auto joint = std::ranges::find(model.description().joints, drive.name, &JointDisplacement::name);
    const auto n = static_cast<std::size_t>(joint - model.description().joints.begin());
    list.push_back(joint == model.description().joints.end() ? kNaN : corrected[n] - at[n]);
  }
  return list;
}

}  // namespace poesy
