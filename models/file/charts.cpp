#include "models/file/charts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "models/file/structure.h"

namespace poesy::file {
namespace {

/// Displacements count as equal if they differ by less than this (rad, or shares of the reach). Tracking is accurate to
/// a millionth of this.
constexpr double kSame = 1e-6;
/// The tolerance that replaces kSame for a mechanism with rounded numbers, as a multiple of Precision::closed. It must
/// be larger: the limbs of such a mechanism do not quite fit, and how the mismatch is divided among their joints
/// depends on whether the pose or the displacements of the drives are given.
constexpr double kSameOfRounded = 100.0;

/// The mechanism with another frame of its platform.
Mechanism with_platform_at(Mechanism mechanism, const Transform& platform_T_new) {
  mechanism.platform = mechanism.platform * platform_T_new;
  mechanism.bodies[kPlatform].home = mechanism.platform;
  for (Limb& limb : mechanism.limbs) {
    if (limb.to == kPlatform) limb.home.back() = limb.home.back() * platform_T_new;
    if (limb.from == kPlatform) limb.home.front() = platform_T_new.inverse() * limb.home.front();
  }
  for (Vector3& point : mechanism.points) point = platform_T_new.R.transpose() * (point - platform_T_new.p);
  return mechanism;
}

Chart tip_chart(const Mechanism& mechanism) {
  const Transform platform_T_tool{lie::Matrix3<double>::Identity(), *mechanism.tool};
  const Mechanism tracked = with_platform_at(mechanism, platform_T_tool);
  PoseChart description{"tip", {}, "take a pose nearer to home, which is at"};
  for (const Coordinate& coordinate : mechanism.coordinates) {
    PoseCoordinate made{coordinate.name, coordinate.dimension(), coordinate_text(coordinate)};
    if (made.dimension == Dimension::length) {
      const std::string axis(1, "xyz"[coordinate.component]);
      made.name = "tip_" + axis;
      made.description = axis + " of the tool's point in the base frame";
    }
    description.advice += (description.coordinates.empty() ? " " : ", ") + made.name + " = " +
                          readable_text({home_pose(tracked)[coordinate.component], made.dimension});
    description.coordinates.push_back(std::move(made));
  }
  return {std::move(description), mechanism, tracked, Given::coordinates, platform_T_tool.inverse()};
}

Chart actuators_chart(const Mechanism& mechanism) {
  PoseChart description{"actuators", {}, "take displacements nearer to home, where all are 0"};
  const std::vector<JointDisplacement> displacements = displacement_names(mechanism);
  for (const Drive& drive : drives_of(mechanism)) {
    description.coordinates.push_back({drive.name, displacements[drive.joints.front()].dimension,
                                       "displacement of " + joints_text(mechanism, drive) + " from home"});
  }
  return {std::move(description), mechanism, mechanism, Given::drives, Transform()};
}

/// Returns true unless one of the chart's names belongs to another coordinate of the mechanism.
bool names_are_new(const Chart& chart, const Mechanism& mechanism) {
  return std::ranges::none_of(chart.description().coordinates, [&](const PoseCoordinate& own) {
    const auto other = std::ranges::find(mechanism.coordinates, own.name, &Coordinate::name);
    return other != mechanism.coordinates.end() && coordinate_text(*other) != own.description;
  });
}

}  // namespace

Chart::Chart(PoseChart description, const Mechanism& mechanism, const Mechanism& tracked, Given given,
             const Transform& tracked_T_platform)
    : description_(std::move(description)),
      mechanism_(mechanism),
      own_(mechanism),
      tracker_(tracked, given),
      tracked_T_platform_(tracked_T_platform) {}

bool Chart::same_displacements(std::span<const double> a, std::span<const double> b) const {
  const std::vector<const Joint*> joints = moving_joints(mechanism_);
  const Precision& precision = mechanism_.precision;
  const double same = precision.rounded() ? kSameOfRounded * precision.closed : kSame;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    double difference = a[k] - b[k];
    if (joints[k]->motion == Motion::revolute) difference = std::remainder(difference, 2.0 * std::numbers::pi);
    if (joints[k]->motion == Motion::prismatic) difference /= mechanism_.reach;
    if (!(std::abs(difference) <= same)) return false;
  }
  return true;
}

Tracked Chart::track(std::span<const double> coordinates) const {
  Tracked found = tracker_.track(coordinates);
  found.platform = found.platform * tracked_T_platform_;
  for (std::size_t k = 0; k < 3; ++k) found.pose[k] = found.platform.p[static_cast<Eigen::Index>(k)];
  if (!found.unreachable.empty()) return found;
  const Tracked own = own_.track(coordinates_of(mechanism_, found.pose));
  if (own.unreachable.empty() && !same_displacements(own.displacements, found.displacements)) {
    found.unreachable =
        "the way there ends in another working mode than the one straight from home to the same pose, by which poses "
        "are solved";
  }
  return found;
}

std::vector<double> coordinates_of(const Mechanism& mechanism, const PlatformPose& pose) {
  std::vector<double> list;
  for (const Coordinate& coordinate : mechanism.coordinates) list.push_back(pose[coordinate.component]);
  return list;
}

std::vector<Chart> charts_of(const Mechanism& mechanism) {
  std::vector<Chart> charts;
  const auto is_length = [](const Coordinate& coordinate) { return coordinate.dimension() == Dimension::length; };
  if (mechanism.tool && std::ranges::any_of(mechanism.coordinates, is_length)) charts.push_back(tip_chart(mechanism));
  if (drives_of(mechanism).size() == mechanism.coordinates.size()) charts.push_back(actuators_chart(mechanism));
  std::erase_if(charts, [&](const Chart& chart) { return !names_are_new(chart, mechanism); });
  return charts;
}

}  // namespace poesy::file
