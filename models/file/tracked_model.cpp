#include "models/file/tracked_model.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>
#include <utility>

#include "models/chain/metric.h"
#include "models/file/drawing_gaps.h"
#include "models/file/structure.h"

namespace poesy::file {
namespace {

/// The shortest distance between joints that counts as a link, as a share of the reach. Joints that are closer belong
/// to one part, whose errors may be as large as the distance of the joints.
constexpr double kShortestLink = 0.02;

/// The indices of the responses with these names. Names that no response has are ignored.
std::vector<std::size_t> positions(const std::vector<Response>& responses, std::span<const std::string_view> names) {
  std::vector<std::size_t> list;
  for (const std::string_view name : names) {
    const auto found = std::ranges::find(responses, name, &Response::name);
    if (found != responses.end()) list.push_back(static_cast<std::size_t>(found - responses.begin()));
  }
  return list;
}

ModelDescription describe(const MechanismFile& file, const Mechanism& mechanism, std::span<const Chart> charts) {
  ModelDescription description;
  description.name = file.name;
  description.title = file.title;
  description.geometry = file.geometry;
  for (const Coordinate& coordinate : mechanism.coordinates) {
    description.pose_coordinates.push_back({coordinate.name, coordinate.dimension(), coordinate_text(coordinate)});
    description.pose_lower.push_back(coordinate.lower);
    description.pose_upper.push_back(coordinate.upper);
  }
  description.structure = structure_text(mechanism);
  description.workspace_note = "This workspace is the mechanism file's.";
  description.factors = mechanism.factors;
  description.factor_sets = mechanism.sets;
  description.features = mechanism.features;
  description.joints = displacement_names(mechanism);
  for (const Chart& chart : charts) description.charts.push_back(chart.description());
  description.fidelities = {"exact", "first-order"};
  description.tolerance = chain::kToleranceByMetric;
  return description;
}

}  // namespace

TrackedModel::TrackedModel(const MechanismFile& file, Checked found)
    : mechanism_(std::move(found.mechanism)),
      mismatch_(found.mismatch),
      tracker_(std::make_shared<const PoseTracker>(mechanism_)),
      charts_(charts_of(mechanism_)),
      description_(describe(file, mechanism_, charts_)) {}

void TrackedModel::set_responses(std::vector<Response> responses, bool deforms) {
  constexpr std::array<std::string_view, 6> kHeadline{"gap",      "deformation_max", "position",
                                                      "rotation", "tip_position",    "strain_energy"};
  constexpr std::array<std::string_view, 6> kSigned{"x", "y", "z", "theta_x", "theta_y", "theta_z"};
  description_.headline = positions(responses, std::span(kHeadline).subspan(deforms ? 0 : 1));
  description_.signed_headline = positions(responses, kSigned);
  description_.responses = std::move(responses);
}

std::optional<std::string> TrackedModel::unreachable(std::span<const double> pose) const {
  std::string why = tracker_->track(pose).unreachable;
  return why.empty() ? std::nullopt : std::optional(std::move(why));
}

std::vector<double> TrackedModel::joint_displacements(std::span<const double> pose) const {
  return tracker_->track(pose).displacements;
}

std::optional<std::vector<double>> TrackedModel::pose_from_chart(std::size_t chart,
                                                                 std::span<const double> coordinates) const {
  const Tracked found = charts_.at(chart).track(coordinates);
  return found.unreachable.empty() ? std::optional(coordinates_of(mechanism_, found.pose)) : std::nullopt;
}

std::string TrackedModel::no_pose_because(std::size_t chart, std::span<const double> coordinates) const {
  return charts_.at(chart).track(coordinates).unreachable;
}

std::vector<std::string> TrackedModel::mobility() const {
  return mobility_lines(mechanism_, home_mobility(mechanism_), workspace_mobility(mechanism_));
}

std::vector<std::string> TrackedModel::remarks() const { return rounding_remarks(mechanism_, mismatch_); }

std::vector<std::string> TrackedModel::unusual_geometry() const {
  std::vector<std::string> list = home_outside(mechanism_);
  std::ranges::move(axes_along_legs(mechanism_), std::back_inserter(list));
  std::ranges::move(loads_without_effect(mechanism_), std::back_inserter(list));
  std::ranges::move(odd_tool(mechanism_), std::back_inserter(list));
  std::ranges::move(wide_turns(mechanism_), std::back_inserter(list));
  return list;
}

std::vector<std::string> TrackedModel::unusual_errors() const {
  std::vector<std::string> list;
  for (const auto& find : {unlike_limbs, doubtful_zones, doubtful_clearances, uncovered_directions,
                           errors_without_effect, oblique_displacements}) {
    for (std::string& found : find(mechanism_)) list.push_back(std::move(found));
  }
  return list;
}

ErrorBound TrackedModel::error_bound(FactorIndex factor) const {
  const Factor& error = description_.factors[factor.value];
  if (error.dimension == Dimension::angle) return {std::numbers::pi, "half a turn"};
  if (error.dimension == Dimension::number) return {1.0, "all of what it is a share of"};
  const Limb& limb = mechanism_.limbs[error.limb - 1];
  ErrorBound bound{mechanism_.reach, "the mechanism's reach"};
  for (std::size_t j = 1; j < limb.home.size(); ++j) {
    const double length = limb.home[j].p.norm();
    if (length < kShortestLink * mechanism_.reach || length >= bound.size) continue;
    const std::string to = j < limb.joints.size() ? limb.joints[j].name
                           : limb.to == kPlatform ? "the platform's origin"
                                                  : "the origin of " + mechanism_.bodies[limb.to].name;
    bound = {length, "the distance from " + limb.joints[j - 1].name + " to " + to};
  }
  return bound;
}

chain::Limb chain_limb(const Limb& limb, bool errors_at_joints, std::span<const std::size_t>& drives) {
  chain::Limb of_chain;
  for (const Joint& joint : limb.joints) {
    of_chain.joints.push_back(joint.of_chain());
    if (!joint.moves()) continue;
    of_chain.joints.back().drive = drives.front();
    drives = drives.subspan(1);
  }
  of_chain.home = limb.home;
  of_chain.errors_at_joints = errors_at_joints;
  return of_chain;
}

std::vector<std::size_t> shared_drives(const Mechanism& mechanism) {
  std::vector<std::size_t> numbers(mechanism.moving(), 0);
  std::size_t number = 0;
  for (const Drive& drive : drives_of(mechanism)) {
    ++number;
    if (!drive.is_shared()) continue;
    for (const std::size_t joint : drive.joints) numbers[joint] = number;
  }
  return numbers;
}

std::vector<double> with_fixed(const Mechanism& mechanism, std::span<const double> moving) {
  std::vector<double> all;
  for (const Limb& limb : mechanism.limbs) {
    for (const Joint& joint : limb.joints) {
      all.push_back(joint.moves() ? moving.front() : 0.0);
      if (joint.moves()) moving = moving.subspan(1);
    }
  }
  return all;
}

}  // namespace poesy::file
