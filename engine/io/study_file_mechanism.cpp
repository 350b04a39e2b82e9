#include <array>
#include <filesystem>

#include "engine/base/text.h"
#include "engine/io/study_file_parts.h"
#include "engine/io/study_text.h"
#include "engine/io/table_file.h"

namespace poesy {
namespace {

const CatalogEntry& read_model(const StudyValue& value, const Catalog& catalog) {
  const std::string written = value.text();
  if (const CatalogEntry* entry = find(catalog, written)) return *entry;
  std::vector<std::string_view> known;
  for (const CatalogEntry& entry : catalog) known.push_back(entry.description.name);
  value.fail("is '" + printable(written) + "', which is unknown", suggestion(lower_case(written), known));
}

std::vector<double> read_geometry(const StudySection& section, const ModelDescription& model) {
  section.allow(names(model.geometry), "parameter");
  std::vector<double> values;
  for (const GeometryParameter& parameter : model.geometry) {
    const auto value = section.find(parameter.name);
    values.push_back(value ? value->quantity(parameter.dimension) : parameter.published);
  }
  return values;
}

/// Sets `fidelity`, and `compared` for "both", which a model with two fidelities offers.
void read_fidelity(const StudySection& section, const ModelDescription& model, MechanismChoice& choice) {
  if (model.fidelities.empty()) {
    section.refuse("fidelity", "model \"" + model.name + "\", which offers no choice of it");
    return;
  }
  const auto value = section.find("fidelity");
  if (!value) return;
  std::vector<std::string_view> words(model.fidelities.begin(), model.fidelities.end());
  if (words.size() == 2) words.push_back(kBothFidelities);
  const std::size_t word = value->word(words);
  if (word < model.fidelities.size()) {
    choice.fidelity = word;
  } else {
    choice.compared = 1;
  }
}

/// A point of the platform: three lengths.
PlatformPoint read_point(const StudyValue& value) {
  const std::vector<StudyValue> coordinates = value.list();
  if (coordinates.size() != 3) {
    value.fail("has " + std::to_string(coordinates.size()) + " values", "a point has three, [\"60 mm\", 0, 0]");
  }
  PlatformPoint point{};
  for (std::size_t c = 0; c < point.size(); ++c) {
    point[c] = coordinates[c].is_zero() ? 0.0 : coordinates[c].quantity(Dimension::length);
  }
  return point;
}

/// Takes the entry of the mechanism by its platform's metric where the study asks for it, and its points.
void read_metric(const StudySection& solver, MechanismChoice& choice) {
  const ModelDescription& model = choice.entry->description;
  if (model.metric.empty()) {
    const std::string why = "model \"" + model.name + "\", whose responses weigh no angles against lengths";
    solver.refuse("metric", why);
    solver.refuse("points", why);
    return;
  }
  const auto value = solver.find("metric");
  const bool by_platform = value && value->word(std::array<std::string_view, 2>{"platform", "published"}) == 0;
  const auto points = solver.find("points");
  if (!by_platform) {
    if (points) points->fail("is for metric = \"platform\"", "write metric = \"platform\" too, or remove it");
    return;
  }
  choice.entry = choice.entry->by_platform.get();
  if (!points) return;
  choice.points_place = points->place();
  for (const StudyValue& point : points->list()) choice.points.push_back(read_point(point));
  if (choice.points.size() < 3) {
    points->fail("has " + std::to_string(choice.points.size()) + " points",
                 "name three or more that are not on a line");
  }
}

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

std::vector<Range> read_workspace(const StudySection& section, const ModelDescription& model) {
  section.allow(names(model.pose_coordinates), "pose coordinate");
  std::vector<Range> ranges;
  for (const PoseCoordinate& coordinate : model.pose_coordinates) {
    const StudyValue value = section.require(coordinate.name, "give a range for every pose coordinate of the model");
    ranges.push_back(read_range(value, coordinate.dimension));
  }
  return ranges;
}

std::vector<Range> default_workspace(const ModelDescription& model) {
  std::vector<Range> ranges;
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    ranges.push_back({model.pose_lower[c], model.pose_upper[c]});
  }
  return ranges;
}

void read_pose_file(const StudySection& section, const ModelDescription& model, StudyUse use,
                    PoseSelection& selection) {
  selection.file = section.require("file", "write file = \"poses.csv\"").text();
  if (use == StudyUse::evaluate) return;
  const std::string path = beside_study(section, selection.file);
  selection.from_file = read_poses(path, model);
  selection.place = {path, 2, 1};
}

std::vector<JointLimit> read_limits(const StudySection& section, const ModelDescription& model) {
  section.allow(names(model.joints), "joint");
  std::vector<JointLimit> limits;
  for (std::size_t joint = 0; joint < model.joints.size(); ++joint) {
    const auto value = section.find(model.joints[joint].name);
    if (value) limits.push_back({joint, read_range(*value, model.joints[joint].dimension), value->place()});
  }
  return limits;
}

/// A whole number, or for a grid a table with a number for every pose coordinate.
void read_count(const StudyValue& value, const ModelDescription& model, PoseSelection& selection) {
  selection.count_place = value.place();
  if (selection.select != PoseSelection::Select::grid || !value.is_section()) {
    selection.count = static_cast<std::size_t>(value.whole_number(1, kMostPoses));
    return;
  }
  const StudySection section = value.section();
  section.allow(names(model.pose_coordinates), "pose coordinate");
  std::int64_t product = 1;
  for (const PoseCoordinate& coordinate : model.pose_coordinates) {
    const StudyValue own = section.require(coordinate.name, "give a number for every pose coordinate of the model");
    const std::int64_t number = own.whole_number(1, kMostPoses);
    selection.grid_counts.push_back(static_cast<std::size_t>(number));
    product *= number;
    if (product > kMostPoses) {
      value.fail("makes a grid of more than " + std::to_string(kMostPoses) + " poses", "write smaller numbers");
    }
  }
  selection.count = static_cast<std::size_t>(product);
}

void read_box(const StudySection& section, const ModelDescription& model, StudyUse use, PoseSelection& selection) {
  const auto workspace = section.find("workspace");
  selection.workspace = workspace ? read_workspace(workspace->section(), model) : default_workspace(model);
  if (workspace) selection.place = workspace->place();
  selection.limits = read_limits(section.section("limits"), model);
  if (const auto value = section.find("max_condition")) selection.max_condition = read_max_condition(*value);
  if (use == StudyUse::evaluate && !section.find("count")) return;
  read_count(section.require("count", "write how many poses, e.g. count = 158"), model, selection);
}

PoseSelection::Select read_select(const StudySection& section) {
  using Select = PoseSelection::Select;
  constexpr std::array kSelects{Select::interior, Select::file, Select::boundary, Select::grid, Select::trajectory};
  const auto value = section.find("select");
  if (!value) return Select::interior;
  std::vector<std::string_view> words;
  for (const Select select : kSelects) words.push_back(name(select));
  return kSelects[value->word(words)];
}

}  // namespace

std::string beside_study(const StudySection& section, const std::string& file) {
  return (std::filesystem::path(section.place().file).parent_path() / file).string();
}

double read_max_condition(const StudyValue& value) {
  const double number = value.number();
  if (!(number > 1.0)) value.fail("is " + shortest(number), "it must be greater than 1, e.g. 1e6");
  return number;
}

MechanismChoice read_mechanism(const StudySection& root, const Catalog& catalog) {
  const StudySection section = root.require("mechanism", "add the section [mechanism] with the key model").section();
  section.allow();
  MechanismChoice choice;
  choice.entry =
      &read_model(section.require("model", "write model = \"NAME\"; 'poesy models' lists the names"), catalog);
  const auto geometry = section.find("geometry");
  choice.place = geometry ? geometry->place() : section.place();
  choice.geometry = read_geometry(section.section("geometry"), choice.entry->description);
  read_metric(root.section("solver"), choice);
  read_fidelity(section, choice.entry->description, choice);
  return choice;
}

PoseSelection read_pose_selection(const StudySection& root, const ModelDescription& model, StudyUse use) {
  if (use == StudyUse::run) static_cast<void>(root.require("poses", "add the section [poses] with the key count"));
  const StudySection section = root.section("poses");
  section.allow();
  PoseSelection selection;
  selection.place = section.place();
  selection.select = read_select(section);
  section.refuse_all_but_those_for(name(selection.select));
  if (selection.select == PoseSelection::Select::file) {
    read_pose_file(section, model, use, selection);
  } else if (selection.select == PoseSelection::Select::trajectory) {
    read_trajectory_section(section, model, use, selection);
  } else {
    read_box(section, model, use, selection);
  }
  return selection;
}

}  // namespace poesy
