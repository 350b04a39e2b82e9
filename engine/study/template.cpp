#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "engine/base/contract.h"
#include "engine/study/study_kind.h"
#include "engine/study/study_text.h"

namespace poesy {
namespace {

std::string title(const StudyKind& kind) {
  std::string text(kind.name);
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string head(const TemplateLines& lines, const Study& shown) {
  const ModelDescription& model = shown.model();
  return comment(model.name + ": " + model.title) + "# Run this study with: poesy run STUDY.toml\n" +
         comment("Quantities are texts with a unit: " + unit_names() + ".") +
         "# A key behind a '#' shows a default or an alternative. All keys: poesy template --reference\n" +
         lines.usual("", "format") + lines.usual("", "version") +
         lines.explained("", "title", "title = " + in_quotes(title(*shown.analysis.kind) + " of " + model.name));
}

std::string fidelity_keys(const TemplateLines& lines, const Study& shown) {
  const ModelDescription& model = shown.model();
  if (model.fidelities.empty()) return {};
  std::string text = comment(fmt::format("fidelity: {}", fmt::join(model.fidelities, ", "))) +
                     lines.explained("mechanism", "fidelity", "fidelity = " + in_quotes(model.fidelities.front()));
  if (model.fidelities.size() == 2 && shown.analysis.kind->compares_fidelities) {
    text += fmt::format("# fidelity = {}\n", in_quotes(kBothFidelities));
  }
  return text;
}

std::string mechanism_section(const TemplateLines& lines, const Study& shown) {
  const ModelDescription& model = shown.model();
  std::string text = "\n[mechanism]\n" + lines.explained("mechanism", "model", "model = " + in_quotes(model.name)) +
                     fidelity_keys(lines, shown);
  if (model.geometry.empty()) return text;
  text += "\n" + lines.explained("mechanism", "geometry", "# [mechanism.geometry]");
  for (const GeometryParameter& parameter : model.geometry) {
    text += fmt::format("# {} = {}  # {}\n", parameter.name, readable_value(parameter.published, parameter.dimension),
                        parameter.description);
  }
  return text;
}

/// "count = { z = 5, beta = 5 }".
std::string grid_example(const ModelDescription& model) {
  std::string text;
  for (const PoseCoordinate& coordinate : model.pose_coordinates) {
    text += fmt::format("{}{} = 5", text.empty() ? "count = { " : ", ", coordinate.name);
  }
  return text + " }";
}

/// Optional ranges of joints, with an example.
std::string limits_key(const TemplateLines& lines, const ModelDescription& model) {
  if (model.joints.empty()) return {};
  std::string list = "Joints:";
  for (const JointDisplacement& joint : model.joints) {
    list += fmt::format(" {} ({})", joint.name, name(joint.dimension));
  }
  const JointDisplacement& joint = model.joints.front();
  const std::string_view range =
      joint.dimension == Dimension::length ? "[\"-50 mm\", \"50 mm\"]" : "[\"-30 deg\", \"30 deg\"]";
  return comment(list) + lines.explained("poses", "limits", fmt::format("# limits = {{ {} = {} }}", joint.name, range));
}

std::string name_list(const std::vector<PoseCoordinate>& coordinates) {
  std::string text;
  for (const PoseCoordinate& coordinate : coordinates) text += (text.empty() ? "" : ", ") + coordinate.name;
  return text;
}

/// Other coordinates in which a file may give poses.
std::string charts_comment(const ModelDescription& model) {
  std::string text;
  for (const PoseChart& chart : model.charts) {
    text +=
        comment(fmt::format("Chart {} in which a file may give poses: {}", chart.name, name_list(chart.coordinates)));
  }
  return text;
}

std::string curve_example(const NamedCurve& curve, const ModelDescription& model) {
  std::string origin;
  for (std::size_t c = 0; c < curve.origin.size(); ++c) {
    const Dimension dimension = model.charts[curve.chart].coordinates[c].dimension;
    origin += (c > 0 ? ", " : "") + readable_value(curve.origin[c], dimension);
  }
  return fmt::format("# trajectory = {{ curve = {}, origin = [{}], points = 201, time = [{}, {}] }}  # {}\n",
                     in_quotes(curve.name), origin, readable_value(curve.start, Dimension::time),
                     readable_value(curve.end, Dimension::time), curve.description);
}

std::string trajectory_key(const TemplateLines& lines, const ModelDescription& model) {
  std::string text = lines.explanation_lines("poses", "trajectory") + lines.keys_lines("poses.trajectory");
  for (const NamedCurve& curve : model.curves) text += curve_example(curve, model);
  return text + "# trajectory = { file = \"curve.csv\", points = 201, time = [\"0 s\", \"2 s\"] }\n";
}

std::string workspace_key(const TemplateLines& lines, const ModelDescription& model) {
  std::vector<Range> workspace;
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    workspace.push_back({model.pose_lower[c], model.pose_upper[c]});
  }
  std::string text = lines.explanation_lines("poses", "workspace");
  for (const PoseCoordinate& coordinate : model.pose_coordinates) {
    text += comment("  " + coordinate.name + ": " + coordinate.description);
  }
  if (!model.workspace_note.empty()) text += comment(model.workspace_note);
  return text + "workspace = " + workspace_text(workspace, model, readable_value) + "\n";
}

std::string poses_section(const TemplateLines& lines, const ModelDescription& model) {
  return "\n[poses]\n" + charts_comment(model) + lines.usual("poses", "select") + lines.usual("poses", "count") + "# " +
         grid_example(model) + "\n" + workspace_key(lines, model) + limits_key(lines, model) +
         lines.usual("poses", "max_condition", "# ") + lines.usual("poses", "file", "# ") +
         trajectory_key(lines, model);
}

std::string errors_section(const TemplateLines& lines, const ModelDescription& model) {
  std::string text = "\n" + comment(lines.meaning("errors")) + lines.keys_lines("errors.linear") + "[errors]\n" +
                     lines.usual("errors", "linear") + lines.usual("errors", "angular");
  if (model.factors.empty()) return text;
  const Factor& factor = model.factors.front();
  return text + lines.explained("errors", "override",
                                fmt::format("# override = {{ {} = {{ distribution = \"uniform\", half_width = {} }} }}",
                                            factor.name, example_size(factor.dimension, 0.5)));
}

std::string analysis_section(const TemplateLines& lines, const Study& shown) {
  const StudyKind& kind = *shown.analysis.kind;
  const StudyRows rows = analysis_keys(kind);
  std::string text = "\n[analysis]\n" + lines.explained("analysis", "kind", "kind = " + in_quotes(kind.name));
  for (const std::string_view key : kind.keys) text += template_lines(lines, "analysis", row_of(rows, key), shown);
  return text;
}

std::string metric_keys(const TemplateLines& lines, const CatalogEntry& entry) {
  const ModelDescription& model = entry.description;
  if (model.metric.empty()) return {};
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : model.geometry) geometry.push_back(parameter.published);
  return lines.explained("solver", "metric", "metric = " + in_quotes(model.metric)) +
         lines.explained("solver", "points",
                         "# points = " + points_text(entry.build(geometry, 0)->metric_points(), readable_value));
}

std::string solver_and_run_sections(const TemplateLines& lines, const CatalogEntry& entry) {
  return "\n[solver]\n" + metric_keys(lines, entry) + lines.usual("solver", "method") +
         lines.explained("solver", "tolerance", "tolerance = " + shortest(entry.description.tolerance)) +
         lines.usual("solver", "max_iterations") + lines.usual("solver", "not_converged") +
         lines.usual("solver", "max_not_converged") + "\n[run]\n" + lines.usual("run", "seed");
}

/// "`m`, `cm`".
std::string units_of(Dimension dimension) {
  std::string text;
  for (const Unit& unit : units()) {
    if (unit.dimension == dimension) text += fmt::format("{}`{}`", text.empty() ? "" : ", ", unit.name);
  }
  return text;
}

std::string introduction() {
  return fmt::format(
      "# Study files\n\n"
      "Every key of a study file, as `poesy template --reference` prints it. Do not edit: it is made of the "
      "descriptions\n"
      "by which the program reads studies (`engine/io/study_*.cpp`), and a test compares.\n\n"
      "A study is [TOML](https://toml.io). `poesy template MODEL KIND` writes a complete one, `poesy check "
      "STUDY.toml`\n"
      "prints it with every default filled in.\n\n"
      "- A key that is not listed is an error, and so is one that does not hold for the study's kind or choice of\n"
      "  poses, unless it says \"else ignored\".\n"
      "- A length, an angle or a time is a text of a number and a unit: `\"0.1 mm\"`. Lengths: {}. Angles: {}. Times: "
      "{}.\n"
      "  `µm` and `°` may be written for `um` and `deg`. A bare number is an error. A *quantity* has the dimension of "
      "what it is a value of.\n"
      "- Names in capitals stand for names of the mechanism's, which `poesy models MODEL` lists: PARAMETER, "
      "COORDINATE,\n"
      "  JOINT, FACTOR, SET.\n"
      "- A table `[poses]` with a key `workspace` of type table may be written as `workspace = {{ ... }}` there, as\n"
      "  `[poses.workspace]`, or with dots; a list of tables as `[[analysis.cases]]` for each of them.\n"
      "- *Required* means: wherever the key holds.\n",
      units_of(Dimension::length), units_of(Dimension::angle), units_of(Dimension::time));
}

}  // namespace

std::string example_size(Dimension dimension, double units) {
  return readable_value(units * display_unit(dimension).si, dimension);
}

std::string sets_comment(const ModelDescription& model) {
  std::string text;
  for (const FactorSet& set : model.factor_sets) {
    text += comment(fmt::format("  \"{}\" ({}): {}", set.name, set.factors.size(), set.description));
  }
  if (model.find_set("all") == nullptr) text += comment(fmt::format("  \"all\" ({})", model.factors.size()));
  return text;
}

std::string template_text(const CatalogEntry& entry, const StudyKind& kind, const StudyKinds& kinds) {
  const TemplateLines lines(kinds.tables);
  Study shown;
  shown.mechanism.entry = entry.by_platform ? entry.by_platform.get() : &entry;
  shown.analysis.kind = &kind;
  const ModelDescription& model = shown.model();
  POESY_EXPECTS(kind.no_template == nullptr || !kind.no_template(model));
  return head(lines, shown) + mechanism_section(lines, shown) + poses_section(lines, model) +
         errors_section(lines, model) + analysis_section(lines, shown) +
         solver_and_run_sections(lines, *shown.mechanism.entry);
}

std::string study_reference(const StudyKinds& kinds) { return introduction() + tables_reference(kinds.tables); }

}  // namespace poesy
