#include "engine/result/described.h"

#include <numeric>

#include "engine/result/result_parts.h"
#include "engine/study/study_kind.h"

namespace poesy {

std::vector<NamedUnit> named_responses(const ModelDescription& model) {
  std::vector<NamedUnit> list;
  for (const Response& response : model.responses) {
    list.push_back({response.name, unit_of(response), response.description});
  }
  return list;
}

std::vector<NamedUnit> named_coordinates(const ModelDescription& model) {
  std::vector<NamedUnit> list;
  for (const PoseCoordinate& coordinate : model.pose_coordinates) {
    list.push_back({coordinate.name, unit_of(coordinate), coordinate.description});
  }
  return list;
}

std::vector<std::size_t> chosen_or_all(std::vector<std::size_t> chosen, std::size_t count) {
  if (!chosen.empty()) return chosen;
  chosen.resize(count);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  return chosen;
}

StoredResult described(const Study& study, const Model& model, const SelectedPoses& poses) {
  const ModelDescription& description = study.model();
  StoredResult result;
  result.kind = study.analysis.kind == nullptr ? "" : study.analysis.kind->name;
  result.title = study.title;
  result.model = description.name;
  result.metric = description.metric;
  if (!result.metric.empty()) result.metric_points = model.metric_points();
  result.pose_coordinates = named_coordinates(description);
  result.poses = poses.poses;
  result.condition = poses.condition;
  result.time = poses.time;
  result.rejected = poses.rejected;
  result.candidates = poses.candidates;
  result.responses = named_responses(description);
  result.headline = chosen_or_all(description.headline, result.responses.size());
  result.signed_headline =
      description.signed_headline.empty() ? result.headline : std::vector(description.signed_headline);
  result.measured = measured_errors(study);
  return result;
}

}  // namespace poesy
