#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "engine/base/text.h"
#include "engine/study/keys.h"
#include "engine/study/study_text.h"
#include "engine/study/table_file.h"

namespace poesy {
namespace {

using Select = PoseSelection::Select;

constexpr std::size_t kCurvePoints = 201;

Range read_range(const StudyValue& value, Dimension dimension) {
  const std::vector<StudyValue> ends = value.list();
  if (ends.size() != 2) {
    value.fail("has " + std::to_string(ends.size()) + " values", "write the two ends of the range");
  }
  const Range range{ends[0].quantity(dimension), ends[1].quantity(dimension)};
  if (!(range.lower < range.upper)) {
    value.fail("runs from " + to_text({range.lower, dimension}) + " to " + to_text({range.upper, dimension}),
               "write the lower end first, and two different ends");
  }
  return range;
}

void read_workspace(const StudyValue& value, Study& study, const Reading&) {
  const std::vector<PoseCoordinate>& coordinates = study.model().pose_coordinates;
  const StudySection section = value.section();
  section.allow(names(coordinates), "pose coordinate");
  for (const PoseCoordinate& coordinate : coordinates) {
    study.poses.workspace.push_back(read_range(section.require(coordinate.name), coordinate.dimension));
  }
  study.poses.place = value.place();
}

void read_limits(const StudyValue& value, Study& study, const Reading&) {
  const std::vector<JointDisplacement>& joints = study.model().joints;
  const StudySection section = value.section();
  section.allow(names(joints), "joint");
  for (std::size_t joint = 0; joint < joints.size(); ++joint) {
    const auto own = section.find(joints[joint].name);
    if (own) study.poses.limits.push_back({joint, read_range(*own, joints[joint].dimension), own->place()});
  }
}

/// A whole number, or for a grid a table with a number for every pose coordinate.
void read_count(const StudyValue& value, Study& study, const Reading&) {
  PoseSelection& selection = study.poses;
  selection.count_place = value.place();
  if (selection.select != Select::grid || !value.is_section()) {
    selection.count = static_cast<std::size_t>(value.whole_number(1, kMostPoses));
    return;
  }
  const StudySection section = value.section();
  section.allow(names(study.model().pose_coordinates), "pose coordinate");
  std::int64_t product = 1;
  for (const PoseCoordinate& coordinate : study.model().pose_coordinates) {
    const std::int64_t number = section.require(coordinate.name).whole_number(1, kMostPoses);
    selection.grid_counts.push_back(static_cast<std::size_t>(number));
    product *= number;
    if (product > kMostPoses) {
      value.fail("makes a grid of more than " + std::to_string(kMostPoses) + " poses", "write smaller numbers");
    }
  }
  selection.count = static_cast<std::size_t>(product);
}

/// For StudyUse::evaluate the file is not opened.
void read_pose_file(const StudyValue& value, Study& study, const Reading& reading) {
  study.poses.file = value.text();
  if (reading.use == StudyUse::evaluate) return;
  const std::string path = beside_study(reading.root, study.poses.file);
  study.poses.from_file = read_poses(path, study.model());
  study.poses.place = {path, 2, 1};
}

std::string seconds(double time) { return readable_text({time, Dimension::time}); }

void read_time(const StudyValue& value, Trajectory& trajectory) {
  const std::vector<StudyValue> ends = value.list();
  if (ends.size() != 2) {
    value.fail("has " + std::to_string(ends.size()) + " values", "write when it starts and when it ends");
  }
  const TimeRange time{ends[0].quantity(Dimension::time), ends[1].quantity(Dimension::time)};
  if (!(time.start < time.end)) {
    value.fail("runs from " + seconds(time.start) + " to " + seconds(time.end),
               "write the start first, and an end after it");
  }
  trajectory.time = time;
}

const InnerRows<Trajectory>& trajectory_keys() {
  static const InnerRows<Trajectory> keys{
      .paths = {"poses.trajectory"},
      .meaning = "Exactly one of curve and file.",
      .rows = {
          InnerRow<Trajectory>{
              .name = "curve", .value = {.type = "text"}, .meaning = "Name of one of the model's curves."},
          InnerRow<Trajectory>{
              .name = "file",
              .value = text_at(&Trajectory::file),
              .usual = "",
              .meaning = "CSV file with a column t (s) and pose coordinates, SI units, relative to the study's "
                         "folder; between its points it is read by modified Akima splines, or by straight lines "
                         "where it has two or three."},
          InnerRow<Trajectory>{
              .name = "origin",
              .value = {.type = "list of quantities"},
              .usual = "the curve's own",
              .meaning = "Where a curve lies: a value for each coordinate in which it is given. A file has none."},
          InnerRow<Trajectory>{
              .name = "points",
              .value = whole_at(2, kMostPoses, &Trajectory::points),
              .usual = std::to_string(kCurvePoints) + "; the file's own points where neither points nor time is given",
              .meaning = "Number of poses, evenly spaced in time."},
          InnerRow<Trajectory>{.name = "time",
                               .value = {.type = "list of two times", .read = read_time},
                               .usual = "the whole curve",
                               .meaning = "Start and end of the part that is taken."},
      }};
  return keys;
}

/// The part of `what` that the study asks for; the whole where it names none.
TimeRange part_of(const StudySection& section, const Trajectory& trajectory, const TimeRange& whole,
                  const std::string& what) {
  const TimeRange time = trajectory.time.value_or(whole);
  if (time.start < whole.start || time.end > whole.end) {
    section.require("time").fail("runs from " + seconds(time.start) + " to " + seconds(time.end) + ", but " + what +
                                     " has " + seconds(whole.start) + " to " + seconds(whole.end),
                                 "write times inside that range");
  }
  return time;
}

std::vector<double> read_origin(const StudyValue& value, const std::vector<PoseCoordinate>& coordinates) {
  const std::vector<StudyValue> list = value.list();
  if (list.size() != coordinates.size()) {
    value.fail("has " + std::to_string(list.size()) + " values",
               fmt::format("write one for each of {}", fmt::join(names(coordinates), ", ")));
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
  if (trajectory.points == 0) trajectory.points = kCurvePoints;
  trajectory.time = part_of(section, trajectory, {curve.start, curve.end}, "curve '" + curve.name + "'");
}

/// For StudyUse::evaluate the file is not opened.
void read_curve_file(const StudySection& section, const ModelDescription& model, const Reading& reading,
                     Trajectory& trajectory) {
  section.refuse("origin", "a trajectory from a file, whose points are as they are");
  if (trajectory.time && trajectory.points == 0) trajectory.points = kCurvePoints;
  if (reading.use == StudyUse::evaluate) return;
  const std::string path = beside_study(section, trajectory.file);
  trajectory.from_file = read_trajectory(path, model);
  trajectory.first_row = {path, 2, 1};
  if (trajectory.points == 0) return;
  trajectory.time = part_of(section, trajectory, {trajectory.from_file.time.front(), trajectory.from_file.time.back()},
                            "the file " + printable(trajectory.file));
}

void read_trajectory_key(const StudyValue& value, Study& study, const Reading& reading) {
  const StudySection section = value.section();
  Trajectory trajectory;
  section.allow();
  const auto curve = section.find("curve");
  if (curve.has_value() == section.find("file").has_value()) {
    value.fail(curve ? "has both curve and file" : "has neither curve nor file",
               "write one of them: { curve = \"NAME\" } or { file = \"curve.csv\" }");
  }
  read_keys(trajectory_keys(), section, trajectory, Nothing());
  if (curve) {
    read_curve(section, *curve, study.model(), trajectory);
  } else {
    read_curve_file(section, study.model(), reading, trajectory);
  }
  study.poses.place = value.place();
  study.poses.count = trajectory.points > 0 ? trajectory.points : trajectory.from_file.time.size();
  study.poses.trajectory = std::move(trajectory);
}

std::string count_line(const Study& study) {
  const PoseSelection& poses = study.poses;
  if (poses.grid_counts.empty()) return poses.count > 0 ? fmt::format("count = {}\n", poses.count) : "";
  std::string text;
  for (std::size_t c = 0; c < poses.grid_counts.size(); ++c) {
    text += fmt::format("{}{} = {}", c == 0 ? "" : ", ", study.model().pose_coordinates[c].name, poses.grid_counts[c]);
  }
  return "count = { " + text + " }\n";
}

std::string limits_line(const Study& study) {
  std::string text;
  for (const JointLimit& limit : study.poses.limits) {
    const JointDisplacement& joint = study.model().joints[limit.joint];
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", joint.name,
                        range_text(limit.range, joint.dimension, exact_value));
  }
  return text.empty() ? "" : "limits = { " + text + " }\n";
}

std::string trajectory_line(const Study& study) {
  if (!study.poses.trajectory) return {};
  const Trajectory& trajectory = *study.poses.trajectory;
  std::string text = "file = " + in_quotes(trajectory.file);
  if (trajectory.curve) {
    const NamedCurve& curve = study.model().curves[*trajectory.curve];
    const std::vector<PoseCoordinate>& coordinates = study.model().charts[curve.chart].coordinates;
    std::vector<std::string> origin;
    for (std::size_t c = 0; c < trajectory.origin.size(); ++c) {
      origin.push_back(exact_value(trajectory.origin[c], coordinates[c].dimension));
    }
    text = fmt::format("curve = {}, origin = {}", in_quotes(curve.name), list_text(origin));
  }
  if (trajectory.points > 0) text += fmt::format(", points = {}", trajectory.points);
  if (trajectory.time) {
    text += ", time = " + range_text({trajectory.time->start, trajectory.time->end}, Dimension::time, exact_value);
  }
  return "trajectory = { " + text + " }\n";
}

/// With "# count = { z = 5, beta = 5 }".
std::string shown_count(const TemplateLines& lines, const Study& study) {
  std::string grid;
  for (const PoseCoordinate& coordinate : study.model().pose_coordinates) {
    grid += fmt::format("{}{} = 5", grid.empty() ? "" : ", ", coordinate.name);
  }
  return lines.usual("poses", "count") + "# count = { " + grid + " }\n";
}

/// The model's own.
std::vector<Range> usual_workspace(const ModelDescription& model) {
  std::vector<Range> workspace;
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    workspace.push_back({model.pose_lower[c], model.pose_upper[c]});
  }
  return workspace;
}

std::string shown_workspace(const TemplateLines& lines, const Study& study) {
  const ModelDescription& model = study.model();
  std::string text = lines.explanation_lines("poses", "workspace");
  for (const PoseCoordinate& coordinate : model.pose_coordinates) {
    text += comment("  " + coordinate.name + ": " + coordinate.description);
  }
  if (!model.workspace_note.empty()) text += comment(model.workspace_note);
  return text + "workspace = " + workspace_text(usual_workspace(model), model, readable_value) + "\n";
}

/// The joints, and the range of one.
std::string shown_limits(const TemplateLines& lines, const Study& study) {
  const std::vector<JointDisplacement>& joints = study.model().joints;
  if (joints.empty()) return {};
  std::string list = "Joints:";
  for (const JointDisplacement& joint : joints) {
    list += fmt::format(" {} ({})", joint.name, name(joint.dimension));
  }
  const JointDisplacement& joint = joints.front();
  const std::string_view range =
      joint.dimension == Dimension::length ? "[\"-50 mm\", \"50 mm\"]" : "[\"-30 deg\", \"30 deg\"]";
  return comment(list) + lines.explained("poses", "limits", fmt::format("# limits = {{ {} = {} }}", joint.name, range));
}

std::string curve_example(const NamedCurve& curve, const ModelDescription& model) {
  std::string origin;
  for (std::size_t c = 0; c < curve.origin.size(); ++c) {
    const Dimension dimension = model.charts[curve.chart].coordinates[c].dimension;
    origin += (c > 0 ? ", " : "") + readable_value(curve.origin[c], dimension);
  }
  return fmt::format("# trajectory = {{ curve = {}, origin = [{}], points = {}, time = [{}, {}] }}  # {}\n",
                     in_quotes(curve.name), origin, kCurvePoints, readable_value(curve.start, Dimension::time),
                     readable_value(curve.end, Dimension::time), curve.description);
}

std::string shown_trajectory(const TemplateLines& lines, const Study& study) {
  std::string text = lines.explanation_lines("poses", "trajectory") + lines.keys_lines("poses.trajectory");
  for (const NamedCurve& curve : study.model().curves) text += curve_example(curve, study.model());
  return text + fmt::format("# trajectory = {{ file = \"curve.csv\", points = {}, time = [\"0 s\", \"2 s\"] }}\n",
                            kCurvePoints);
}

StudyRow select_row() {
  return {.name = "select",
          .value = word_at<Select>(
              {{Select::interior, "points of a Sobol' sequence in the workspace; more poses begin with the same ones"},
               {Select::file,
                "the poses of a CSV file: a line of names, all pose coordinates or those of a chart, then a line of "
                "numbers in SI units for each pose"},
               {Select::boundary, "points on the boundary of the feasible part of the workspace, uniform by area"},
               {Select::grid, "the feasible points of a regular grid"},
               {Select::trajectory, "poses along a curve, in the order of time"}},
              &Study::poses, &PoseSelection::select),
          .meaning = "How poses are chosen."};
}

/// The keys of a search in the workspace.
std::vector<StudyRow> box_rows() {
  const std::vector<std::string_view> of_box{name(Select::interior), name(Select::boundary), name(Select::grid)};
  std::vector<std::string_view> of_model = of_box;
  of_model.push_back(name(Select::trajectory));
  return {
      StudyRow{.name = "count",
               .value = {.type = "integer, for a grid also a table", .bounds = "at least 1"},
               .missing = "write how many poses, e.g. {}",
               .example = "158",
               .only_for = of_box,
               .meaning = "How many poses; of a grid so many of its points, or all points with a number for every pose "
                          "coordinate.",
               .reader = read_count,
               .lines = count_line,
               .shown = shown_count},
      StudyRow{.name = "workspace",
               .value = {.type = "table"},
               .usual = "the model's own workspace",
               .only_for = of_box,
               .meaning = "A range for every pose coordinate.",
               .reader = read_workspace,
               .lines =
                   [](const Study& study) {
                     return "workspace = " + workspace_text(study.poses.workspace, study.model(), exact_value) + "\n";
                   },
               .shown = shown_workspace},
      StudyRow{.name = "limits",
               .value = {.type = "table"},
               .usual = "none",
               .only_for = of_box,
               .meaning = "Ranges of joint displacements from home; poses that leave them are rejected.",
               .reader = read_limits,
               .lines = limits_line,
               .shown = shown_limits},
      StudyRow{.name = "max_condition",
               .value = number_at(above_one("1e6"), &Study::poses, &PoseSelection::max_condition),
               .only_for = of_model,
               .meaning = "A pose whose condition number is above it counts as singular: it is rejected, or on a "
                          "trajectory an error.",
               .late = 1,
               .commented = true}};
}

StudyRow file_row() {
  return {.name = "file",
          .value = text_at(&Study::poses, &PoseSelection::file),
          .missing = "write {}",
          .example = "\"poses.csv\"",
          .only_for = {name(Select::file)},
          .meaning = "CSV file of poses, relative to the study's folder.",
          .reader = read_pose_file,
          .commented = true};
}

StudyRow trajectory_row() {
  return {.name = "trajectory",
          .value = {.type = "table"},
          .missing = "write trajectory = { curve = \"NAME\" } or { file = \"curve.csv\" }",
          .only_for = {name(Select::trajectory)},
          .meaning = "The curve: one of the model's, or a file.",
          .reader = read_trajectory_key,
          .lines = trajectory_line,
          .shown = shown_trajectory};
}

StudyTable grid_table() {
  return {.paths = {"poses.count"},
          .meaning = "For select = \"grid\": a regular grid, of which all feasible points are poses.",
          .keys = {{.name = "COORDINATE",
                    .type = "integer",
                    .bounds = "at least 1",
                    .required = true,
                    .missing = "give a number for every pose coordinate of the model",
                    .meaning = "Points along this pose coordinate, evenly spaced, both ends included; 1 is the "
                               "middle."}}};
}

StudyTable workspace_table() {
  return {.paths = {"poses.workspace"},
          .meaning = "The box in which poses are sought.",
          .keys = {{.name = "COORDINATE",
                    .type = "list of two quantities",
                    .required = true,
                    .missing = "give a range for every pose coordinate of the model",
                    .meaning = "Lower and upper end of the range of this pose coordinate."}}};
}

StudyTable limits_table() {
  return {.paths = {"poses.limits"},
          .meaning = "Limits of joints.",
          .keys = {{.name = "JOINT",
                    .type = "list of two quantities",
                    .usual = "none",
                    .meaning = "Lower and upper end of the range of this joint's displacement."}}};
}

}  // namespace

std::string beside_study(const StudySection& section, const std::string& file) {
  return (std::filesystem::path(section.place().file).parent_path() / file).string();
}

const StudyRows& poses_keys() {
  static const StudyRows keys = [] {
    StudyRows table{
        .paths = {"poses"}, .meaning = "The poses of the platform.", .chooser = "select", .rows = {select_row()}};
    for (StudyRow& row : box_rows()) table.rows.push_back(std::move(row));
    table.rows.push_back(file_row());
    table.rows.push_back(trajectory_row());
    return table;
  }();
  return keys;
}

StudyTables poses_tables() {
  return {described(poses_keys()), grid_table(), workspace_table(), limits_table(), described(trajectory_keys())};
}

void read_poses_section(Study& study, const Reading& reading) {
  const bool complete = reading.use == StudyUse::run;
  if (complete) static_cast<void>(reading.root.require("poses"));
  const StudySection section = reading.root.section("poses");
  study.poses.place = section.place();
  read_keys(poses_keys(), section, study, reading, complete ? Extent::complete : Extent::partial);
  if (study.poses.select == PoseSelection::Select::file) static_cast<void>(section.require("file"));
  if (section.find("workspace") || !holds_for(row_of(poses_keys(), "workspace").only_for, name(study.poses.select))) {
    return;
  }
  study.poses.workspace = usual_workspace(study.model());
}

}  // namespace poesy
