#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "engine/study/study_kind.h"
#include "engine/study/table_file.h"

namespace poesy {
namespace {

using Select = PoseSelection::Select;

constexpr std::size_t kCurvePoints = 201;

/// Reads the two ends of a range, the lower end first: the range of a coordinate or joint, or the time of a trajectory.
Range read_range(const StudyValue& value, Dimension dimension) {
  const bool is_time = dimension == Dimension::time;
  const auto ends =
      value.list(2, is_time ? "write when it starts and when it ends" : "write the two ends of the range");
  const Range range{ends[0].quantity(dimension), ends[1].quantity(dimension)};
  if (is_time && std::max(std::abs(range.lower), std::abs(range.upper)) > kLatestTime) {
    value.fail("is more than 1e9 s from 0", "count the time from the start of the motion");
  }
  if (range.lower < range.upper) return range;
  const auto as_written = [](const StudyValue& end) {
    return end.is_text() ? printable(end.text()) : shortest(end.number());
  };
  value.fail("runs from " + as_written(ends[0]) + " to " + as_written(ends[1]),
             is_time ? "write the start first, and an end after it"
             : range.lower == range.upper
                 ? "write two different ends; a narrow range, or a grid with one point, keeps it constant"
                 : "write the lower end first, and two different ends");
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
  read_named(value.section(), joints, "joint", [&](std::size_t joint, const StudyValue& own) {
    study.poses.limits.push_back({joint, read_range(own, joints[joint].dimension), own.place()});
  });
}

/// Reads the key `count`: a whole number or, for a grid, a table with a whole number for each pose coordinate.
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

/// Reads the key `file` with the name of a pose file, and the file itself unless the study is read for
/// StudyUse::evaluate.
void read_pose_file(const StudyValue& value, Study& study, const Reading& reading) {
  study.poses.file = value.text();
  if (reading.use == StudyUse::evaluate) return;
  const std::string path = named_file(value);
  study.poses.from_file = read_poses(path, study.model());
  study.poses.place = {path, 2, 1};
}

std::string seconds(double time) { return readable_text({time, Dimension::time}); }

void read_time(const StudyValue& value, Trajectory& trajectory) {
  trajectory.time = read_range(value, Dimension::time);
}

const InnerRows<Trajectory>& trajectory_keys() {
  static const InnerRows<Trajectory> keys{
      .paths = {"poses.trajectory", "analysis.calibration.poses.trajectory",
                "analysis.calibration.candidates.trajectory"},
      .meaning = "A trajectory is a curve or a file.",
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

/// The part of a trajectory that the study takes, as a range of times (s): the key `time`, or `whole` if the key is
/// missing. whole: the range of the whole trajectory. Throws InputError if the key's range goes beyond `whole`. what:
/// noun phrase for the whole trajectory in messages.
Range part_of(const StudySection& section, const Trajectory& trajectory, const Range& whole, const std::string& what) {
  const Range time = trajectory.time.value_or(whole);
  if (time.lower < whole.lower || time.upper > whole.upper) {
    section.require("time").fail("runs from " + seconds(time.lower) + " to " + seconds(time.upper) + ", but " + what +
                                     " has " + seconds(whole.lower) + " to " + seconds(whole.upper),
                                 "write times inside that range");
  }
  return time;
}

std::vector<double> read_origin(const StudyValue& value, const std::vector<PoseCoordinate>& coordinates) {
  const std::vector<StudyValue> list =
      value.list(coordinates.size(), fmt::format("write one for each of {}", fmt::join(names(coordinates), ", ")));
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

/// Reads the file of a trajectory, unless the study is read for StudyUse::evaluate. If the study states only one of the
/// keys `points` and `time`, sets the other one to its default.
void read_curve_file(const StudySection& section, const ModelDescription& model, const Reading& reading,
                     Trajectory& trajectory) {
  section.refuse("origin", "a trajectory from a file, whose points are as they are");
  if (trajectory.time && trajectory.points == 0) trajectory.points = kCurvePoints;
  if (reading.use == StudyUse::evaluate) return;
  const std::string path = named_file(section.require("file"));
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

/// A range as a TOML list. value: function that writes the ends, such as exact_value().
std::string range_text(const Range& range, Dimension dimension, ValueText value) {
  return fmt::format("[{}, {}]", value(range.lower, dimension), value(range.upper, dimension));
}

std::string workspace_text(const std::vector<Range>& workspace, const ModelDescription& model, ValueText value) {
  return "workspace = " +
         inline_table(
             model.pose_coordinates,
             [&](std::size_t c) { return range_text(workspace[c], model.pose_coordinates[c].dimension, value); }) +
         "\n";
}

/// A trajectory as a TOML table: the curve and its origin, or the file with the points, then the number of poses and
/// the range of time if the trajectory has them. value: function that writes quantities, such as exact_value().
std::string trajectory_text(const Trajectory& trajectory, const ModelDescription& model, ValueText value) {
  std::string text = "file = " + in_quotes(trajectory.file);
  if (trajectory.curve) {
    const NamedCurve& curve = model.curves[*trajectory.curve];
    std::vector<std::string> origin;
    for (std::size_t c = 0; c < trajectory.origin.size(); ++c) {
      origin.push_back(value(trajectory.origin[c], model.charts[curve.chart].coordinates[c].dimension));
    }
    text = fmt::format("curve = {}, origin = {}", in_quotes(curve.name), list_text(origin));
  }
  if (trajectory.points > 0) text += fmt::format(", points = {}", trajectory.points);
  if (trajectory.time) text += ", time = " + range_text(*trajectory.time, Dimension::time, value);
  return "trajectory = { " + text + " }";
}

std::string count_line(const Study& study) {
  const PoseSelection& poses = study.poses;
  if (poses.grid_counts.empty()) return poses.count > 0 ? fmt::format("count = {}\n", poses.count) : "";
  const auto number = [&](std::size_t c) { return std::to_string(poses.grid_counts[c]); };
  return "count = " + inline_table(study.model().pose_coordinates, number) + "\n";
}

std::string workspace_line(const Study& study) {
  return workspace_text(study.poses.workspace, study.model(), exact_value);
}

std::string limits_line(const Study& study) {
  std::vector<std::string> ranges;
  for (const JointLimit& limit : study.poses.limits) {
    const JointDisplacement& joint = study.model().joints[limit.joint];
    ranges.push_back(joint.name + " = " + range_text(limit.range, joint.dimension, exact_value));
  }
  return ranges.empty() ? "" : fmt::format("limits = {{ {} }}\n", fmt::join(ranges, ", "));
}

std::string trajectory_line(const Study& study) {
  const auto& trajectory = study.poses.trajectory;
  return trajectory ? trajectory_text(*trajectory, study.model(), exact_value) + "\n" : "";
}

std::string shown_count(const TemplateLines& lines, const Study& study) {
  const std::string grid = inline_table(study.model().pose_coordinates, [](std::size_t) { return "5"; });
  return lines.usual("poses", "count") + "# count = " + grid + "\n";
}

/// The workspace that the model states, as a range for each pose coordinate, SI.
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
  return text + workspace_text(usual_workspace(model), model, readable_value);
}

/// The template's lines of the key `limits`: the names of the joints in a comment, and an example of a range.
std::string shown_limits(const TemplateLines& lines, const Study& study) {
  const std::vector<JointDisplacement>& joints = study.model().joints;
  if (joints.empty()) return {};
  std::string list = "Joints:";
  for (const JointDisplacement& joint : joints) list += fmt::format(" {} ({})", joint.name, name(joint.dimension));
  const JointDisplacement& joint = joints.front();
  const std::string_view range =
      joint.dimension == Dimension::length ? "[\"-50 mm\", \"50 mm\"]" : "[\"-30 deg\", \"30 deg\"]";
  return comment(list) + lines.explained("poses", "limits", fmt::format("# limits = {{ {} = {} }}", joint.name, range));
}

std::string shown_trajectory(const TemplateLines& lines, const Study& study) {
  const ModelDescription& model = study.model();
  std::string text = lines.explanation_lines("poses", "trajectory") + lines.keys_lines("poses.trajectory");
  for (std::size_t k = 0; k < model.curves.size(); ++k) {
    const NamedCurve& curve = model.curves[k];
    const Trajectory whole{
        .curve = k, .origin = curve.origin, .points = kCurvePoints, .time = Range{curve.start, curve.end}};
    text += fmt::format("# {}  # {}\n", trajectory_text(whole, model, readable_value), curve.description);
  }
  const Trajectory file{.file = "curve.csv", .points = kCurvePoints, .time = Range{0.0, 2.0}};
  return text + "# " + trajectory_text(file, model, readable_value) + "\n";
}

std::vector<StudyRow> poses_rows() {
  const std::vector<std::string_view> of_box{name(Select::interior), name(Select::boundary), name(Select::grid)};
  std::vector<std::string_view> of_model = of_box;
  of_model.push_back(name(Select::trajectory));
  return {
      StudyRow{
          .name = "select",
          .value = word_at<Select>(
              {{Select::interior, "points of a Sobol' sequence in the workspace; more poses begin with the same ones"},
               {Select::file,
                "the poses of a CSV file: a line of names, all pose coordinates or those of a chart, then a line of "
                "numbers in SI units for each pose"},
               {Select::boundary, "points on the boundary of the feasible part of the workspace, uniform by area"},
               {Select::grid, "the feasible points of a regular grid"},
               {Select::trajectory, "poses along a curve, in the order of time"}},
              &Study::poses, &PoseSelection::select),
          .meaning = "How poses are chosen."},
      StudyRow{.name = "count",
               .value = {.type = "integer, for a grid also a table", .bounds = "at least 1"},
               .missing = "write how many poses, e.g. {}",
               .example = "158",
               .only_for = of_box,
               .meaning = "Number of poses. Of a grid: a number takes that many of its points, a table with a number "
                          "for each pose coordinate takes all points.",
               .reader = read_count,
               .lines = count_line,
               .shown = shown_count},
      StudyRow{.name = "workspace",
               .value = {.type = "table"},
               .usual = "the model's own workspace",
               .only_for = of_box,
               .meaning = "A range for every pose coordinate.",
               .reader = read_workspace,
               .lines = workspace_line,
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
               .commented = true},
      StudyRow{.name = "file",
               .value = text_at(&Study::poses, &PoseSelection::file),
               .missing = "write {}",
               .example = "\"poses.csv\"",
               .only_for = {name(Select::file)},
               .meaning = "CSV file of poses, relative to the study's folder.",
               .reader = read_pose_file,
               .commented = true},
      StudyRow{.name = "trajectory",
               .value = {.type = "table"},
               .missing = "write trajectory = { curve = \"NAME\" } or { file = \"curve.csv\" }",
               .only_for = {name(Select::trajectory)},
               .meaning = "The curve: one of the model's, or a file.",
               .reader = read_trajectory_key,
               .lines = trajectory_line,
               .shown = shown_trajectory}};
}

}  // namespace

const StudyRows& poses_keys() {
  static const StudyRows keys{.paths = {"poses", "analysis.calibration.poses", "analysis.calibration.candidates"},
                              .meaning = "The poses of the platform.",
                              .chooser = "select",
                              .rows = poses_rows()};
  return keys;
}

StudyTables poses_tables() {
  return {described(poses_keys()),
          {.paths = {"poses.count", "analysis.calibration.poses.count", "analysis.calibration.candidates.count"},
           .meaning = "For select = \"grid\": a regular grid, of which all feasible points are poses.",
           .keys = {{.name = "COORDINATE",
                     .type = "integer",
                     .bounds = "at least 1",
                     .required = true,
                     .missing = "give a number for every pose coordinate of the model",
                     .meaning = "Points along this pose coordinate, evenly spaced, both ends included; 1 is the "
                                "middle."}}},
          {.paths = {"poses.workspace", "analysis.calibration.poses.workspace",
                     "analysis.calibration.candidates.workspace"},
           .meaning = "The box in which poses are sought.",
           .keys = {{.name = "COORDINATE",
                     .type = "list of two quantities",
                     .required = true,
                     .missing = "give a range for every pose coordinate of the model",
                     .meaning = "Lower and upper end of the range of this pose coordinate."}}},
          {.paths = {"poses.limits", "analysis.calibration.poses.limits", "analysis.calibration.candidates.limits"},
           .meaning = "Limits of joints.",
           .keys = {{.name = "JOINT",
                     .type = "list of two quantities",
                     .usual = "none",
                     .meaning = "Lower and upper end of the range of this joint's displacement."}}},
          described(trajectory_keys())};
}

void read_poses_section(Study& study, const Reading& reading) {
  if (reading.use == StudyUse::run) static_cast<void>(reading.root.require("poses"));
  if (reading.use == StudyUse::evaluate_at_poses) {
    static_cast<void>(reading.root.require("poses", "write it, or give a table of poses: --poses P.csv"));
  }
  read_pose_selection(reading.root.section("poses"), study, reading);
}

void read_pose_selection(const StudySection& section, Study& study, const Reading& reading) {
  const bool complete = reading.use != StudyUse::evaluate;
  study.poses.place = section.place();
  read_keys(poses_keys(), section, study, reading, complete ? Extent::complete : Extent::partial);
  if (study.poses.select == PoseSelection::Select::file) static_cast<void>(section.require("file"));
  if (section.find("workspace") || !holds_for(row_of(poses_keys(), "workspace").only_for, name(study.poses.select))) {
    return;
  }
  study.poses.workspace = usual_workspace(study.model());
}

}  // namespace poesy
