#include <algorithm>
#include <utility>

#include "engine/base/text.h"
#include "engine/io/study_file_parts.h"
#include "engine/io/table_file.h"

namespace poesy {
namespace {

constexpr std::size_t kPoints = 201;

std::string seconds(double time) { return readable_text({time, Dimension::time}); }

/// The time that a study asks for, inside what `what` has.
TimeRange read_time(const StudyValue& value) {
  const std::vector<StudyValue> ends = value.list();
  if (ends.size() != 2) {
    value.fail("has " + std::to_string(ends.size()) + " values", "write when it starts and when it ends");
  }
  const TimeRange time{ends[0].quantity(Dimension::time), ends[1].quantity(Dimension::time)};
  if (!(time.start < time.end)) {
    value.fail("runs from " + seconds(time.start) + " to " + seconds(time.end),
               "write the start first, and an end after it");
  }
  return time;
}

void check_inside(const StudyValue& value, const TimeRange& time, const TimeRange& whole, const std::string& what) {
  if (time.start >= whole.start && time.end <= whole.end) return;
  value.fail("runs from " + seconds(time.start) + " to " + seconds(time.end) + ", but " + what + " has " +
                 seconds(whole.start) + " to " + seconds(whole.end),
             "write times inside that range");
}

std::size_t read_points(const StudySection& section) {
  const auto value = section.find("points");
  return value ? static_cast<std::size_t>(value->whole_number(2, kMostPoses)) : kPoints;
}

std::vector<double> read_origin(const StudyValue& value, const std::vector<PoseCoordinate>& coordinates) {
  const std::vector<StudyValue> list = value.list();
  if (list.size() != coordinates.size()) {
    std::string wanted;
    for (const PoseCoordinate& coordinate : coordinates) wanted += (wanted.empty() ? "" : ", ") + coordinate.name;
    value.fail("has " + std::to_string(list.size()) + " values", "write one for each of " + wanted);
  }
  std::vector<double> origin;
  for (std::size_t c = 0; c < list.size(); ++c) origin.push_back(list[c].quantity(coordinates[c].dimension));
  return origin;
}

void read_curve(const StudySection& section, const StudyValue& value, const ModelDescription& model,
                Trajectory& trajectory) {
  if (model.curves.empty()) {
    value.fail("is '" + printable(value.text()) + "', but model \"" + model.name + "\" has no curves",
               "give the trajectory as a file: { file = \"curve.csv\" }");
  }
  trajectory.curve = value.word(names(model.curves));
  const NamedCurve& curve = model.curves[*trajectory.curve];
  const auto origin = section.find("origin");
  trajectory.origin = origin ? read_origin(*origin, model.charts[curve.chart].coordinates) : curve.origin;
  trajectory.points = read_points(section);
  trajectory.time = TimeRange{curve.start, curve.end};
  if (const auto time = section.find("time")) {
    trajectory.time = read_time(*time);
    check_inside(*time, *trajectory.time, {curve.start, curve.end}, "curve '" + curve.name + "'");
  }
}

void read_file(const StudySection& section, const StudyValue& value, const ModelDescription& model, StudyUse use,
               Trajectory& trajectory) {
  section.refuse("origin", "a trajectory from a file, whose points are as they are");
  trajectory.file = value.text();
  const auto time = section.find("time");
  const bool resampled = time || section.find("points");
  if (resampled) trajectory.points = read_points(section);
  if (time) trajectory.time = read_time(*time);
  if (use == StudyUse::evaluate) return;
  const std::string path = beside_study(section, trajectory.file);
  trajectory.from_file = read_trajectory(path, model);
  trajectory.first_row = {path, 2, 1};
  const TimeRange whole{trajectory.from_file.time.front(), trajectory.from_file.time.back()};
  if (time) check_inside(*time, *trajectory.time, whole, "the file " + printable(trajectory.file));
  if (resampled && !time) trajectory.time = whole;
}

/// Exactly one of curve and file.
Trajectory read_trajectory_of(const StudyValue& value, const ModelDescription& model, StudyUse use) {
  const StudySection section = value.section();
  section.allow();
  const auto curve = section.find("curve");
  const auto file = section.find("file");
  if (curve.has_value() == file.has_value()) {
    value.fail(curve ? "has both curve and file" : "has neither curve nor file",
               "write one of them: { curve = \"NAME\" } or { file = \"curve.csv\" }");
  }
  Trajectory trajectory;
  if (curve) {
    read_curve(section, *curve, model, trajectory);
  } else {
    read_file(section, *file, model, use, trajectory);
  }
  return trajectory;
}

}  // namespace

void read_trajectory_section(const StudySection& poses, const ModelDescription& model, StudyUse use,
                             PoseSelection& selection) {
  if (const auto value = poses.find("max_condition")) selection.max_condition = read_max_condition(*value);
  if (use == StudyUse::evaluate && !poses.find("trajectory")) return;
  const StudyValue value =
      poses.require("trajectory", "write trajectory = { curve = \"NAME\" } or { file = \"curve.csv\" }");
  selection.place = value.place();
  selection.trajectory = read_trajectory_of(value, model, use);
  const std::size_t own = selection.trajectory->from_file.time.size();
  selection.count = selection.trajectory->points > 0 ? selection.trajectory->points : own;
}

}  // namespace poesy
