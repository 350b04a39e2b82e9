#include "engine/io/result_parts.h"

namespace poesy {
namespace {

void add_rejected_poses(ResultBuilder& result, const std::vector<RejectedPoses>& rejected) {
  if (rejected.empty()) return;
  const auto reasons = texts(rejected, &RejectedPoses::reason);
  std::vector<std::uint64_t> counts;
  for (const RejectedPoses& each : rejected) counts.push_back(each.count);
  result.add_axis("rejection", reasons, {"1", "Why poses were rejected"});
  result.file().make_group("/poses/rejected");
  result.show_axes("/poses/rejected", {"rejection"});
  result.add("/poses/rejected/reason", {"rejection"}, reasons, {"1", "Why poses were rejected"});
  result.add("/poses/rejected/count", {"rejection"}, counts, {"1", "Candidate poses rejected for this reason"});
}

}  // namespace

void add_poses(ResultBuilder& result, const ModelDescription& model, const SelectedPoses& selected) {
  const PoseSet& poses = selected.poses;
  result.add_axis("pose", positions(poses.size()), {"1", "Number of the pose, from 0"});
  result.file().make_group("/poses");
  const auto names = texts(model.pose_coordinates, &PoseCoordinate::name);
  result.file().set_attribute("/poses", "coordinates", std::span(names));
  for (std::size_t c = 0; c < names.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    result.add("/poses/" + names[c], {"pose"}, poses.column(c), {unit_of(coordinate), coordinate.description});
  }
  if (!selected.time.empty()) {
    result.add("/poses/time", {"pose"}, selected.time, {"s", "When the trajectory reaches the pose"});
  }
  result.add("/poses/condition", {"pose"}, selected.condition,
             {"1", "Condition number of the passive joints' Jacobian; infinity at a singular pose"});
  add_rejected_poses(result, selected.rejected);
}

std::vector<NamedUnit> read_pose_coordinates(const h5::File& file) {
  std::vector<NamedUnit> coordinates;
  for (const std::string& name : file.attribute<std::string>("/poses", "coordinates")) {
    coordinates.push_back({name, file.attribute<std::string>("/poses/" + name, "unit").at(0),
                           file.attribute<std::string>("/poses/" + name, "description").at(0)});
  }
  if (coordinates.empty()) throw h5::Error("/poses has no coordinates");
  return coordinates;
}

SelectedPoses read_poses(const h5::File& file) {
  const std::size_t count = axis_length(file, "pose");
  const std::vector<NamedUnit> coordinates = read_pose_coordinates(file);
  std::vector<double> values(count * coordinates.size());
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const auto column = read_exactly<double>(file, "/poses/" + coordinates[c].name, count);
    for (std::size_t m = 0; m < count; ++m) values[m * coordinates.size() + c] = column[m];
  }
  SelectedPoses selected;
  selected.poses = PoseSet(coordinates.size(), std::move(values));
  if (file.exists("/poses/time")) selected.time = read_exactly<double>(file, "/poses/time", count);
  if (file.exists("/poses/condition")) selected.condition = read_exactly<double>(file, "/poses/condition", count);
  if (!file.exists("/poses/rejected")) return selected;
  const std::size_t reasons = axis_length(file, "rejection");
  const auto names = read_exactly<std::string>(file, "/poses/rejected/reason", reasons);
  const auto counts = read_exactly<std::uint64_t>(file, "/poses/rejected/count", reasons);
  for (std::size_t k = 0; k < reasons; ++k) {
    selected.rejected.push_back({names[k], static_cast<std::size_t>(counts[k])});
  }
  return selected;
}

}  // namespace poesy
