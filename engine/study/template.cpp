#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "engine/base/contract.h"
#include "engine/study/keys.h"
#include "engine/study/study_text.h"

namespace poesy {
namespace {

const TemplateLines& lines() {
  static const TemplateLines of_studies(study_tables());
  return of_studies;
}

/// "1 mm" or "1 deg" in quotes, times a factor.
std::string example_size(Dimension dimension, double factor) {
  return readable_value(factor * display_unit(dimension).si, dimension);
}

std::string title(Analysis::Kind kind) {
  std::string text(name(kind));
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string head(const ModelDescription& model, Analysis::Kind kind) {
  return comment(model.name + ": " + model.title) + "# Run this study with: poesy run STUDY.toml\n" +
         comment("Quantities are texts with a unit: " + unit_names() + ".") +
         "# A key behind a '#' shows a default or an alternative. All keys: poesy template --reference\n" +
         lines().usual("", "format") + lines().usual("", "version") +
         lines().explained("", "title", "title = " + in_quotes(title(kind) + " of " + model.name));
}

std::string fidelity_keys(const ModelDescription& model, Analysis::Kind kind) {
  if (model.fidelities.empty()) return {};
  std::string text = comment(fmt::format("fidelity: {}", fmt::join(model.fidelities, ", "))) +
                     lines().explained("mechanism", "fidelity", "fidelity = " + in_quotes(model.fidelities.front()));
  if (model.fidelities.size() == 2 && kind == Analysis::Kind::sensitivity) {
    text += fmt::format("# fidelity = {}\n", in_quotes(kBothFidelities));
  }
  return text;
}

std::string mechanism_section(const ModelDescription& model, Analysis::Kind kind) {
  std::string text = "\n[mechanism]\n" + lines().explained("mechanism", "model", "model = " + in_quotes(model.name)) +
                     fidelity_keys(model, kind);
  if (model.geometry.empty()) return text;
  text += "\n" + lines().explained("mechanism", "geometry", "# [mechanism.geometry]");
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
std::string limits_key(const ModelDescription& model) {
  if (model.joints.empty()) return {};
  std::string list = "Joints:";
  for (const JointDisplacement& joint : model.joints) {
    list += fmt::format(" {} ({})", joint.name, name(joint.dimension));
  }
  const JointDisplacement& joint = model.joints.front();
  const std::string_view range =
      joint.dimension == Dimension::length ? "[\"-50 mm\", \"50 mm\"]" : "[\"-30 deg\", \"30 deg\"]";
  return comment(list) +
         lines().explained("poses", "limits", fmt::format("# limits = {{ {} = {} }}", joint.name, range));
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

std::string trajectory_key(const ModelDescription& model) {
  std::string text = lines().explanation_lines("poses", "trajectory") + lines().keys_lines("poses.trajectory");
  for (const NamedCurve& curve : model.curves) text += curve_example(curve, model);
  return text + "# trajectory = { file = \"curve.csv\", points = 201, time = [\"0 s\", \"2 s\"] }\n";
}

std::string workspace_key(const ModelDescription& model) {
  std::vector<Range> workspace;
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    workspace.push_back({model.pose_lower[c], model.pose_upper[c]});
  }
  std::string text = lines().explanation_lines("poses", "workspace");
  for (const PoseCoordinate& coordinate : model.pose_coordinates) {
    text += comment("  " + coordinate.name + ": " + coordinate.description);
  }
  if (!model.workspace_note.empty()) text += comment(model.workspace_note);
  return text + "workspace = " + workspace_text(workspace, model, readable_value) + "\n";
}

std::string poses_section(const ModelDescription& model) {
  return "\n[poses]\n" + charts_comment(model) + lines().usual("poses", "select") + lines().usual("poses", "count") +
         "# " + grid_example(model) + "\n" + workspace_key(model) + limits_key(model) +
         lines().usual("poses", "max_condition", "# ") + lines().usual("poses", "file", "# ") + trajectory_key(model);
}

std::string errors_section(const ModelDescription& model) {
  std::string text = "\n" + comment(lines().meaning("errors")) + lines().keys_lines("errors.linear") + "[errors]\n" +
                     lines().usual("errors", "linear") + lines().usual("errors", "angular");
  if (model.factors.empty()) return text;
  const Factor& factor = model.factors.front();
  return text +
         lines().explained("errors", "override",
                           fmt::format("# override = {{ {} = {{ distribution = \"uniform\", half_width = {} }} }}",
                                       factor.name, example_size(factor.dimension, 0.5)));
}

std::string sets_comment(const ModelDescription& model) {
  std::string text;
  for (const FactorSet& set : model.factor_sets) {
    text += comment(fmt::format("  \"{}\" ({}): {}", set.name, set.factors.size(), set.description));
  }
  if (model.find_set("all") == nullptr) text += comment(fmt::format("  \"all\" ({})", model.factors.size()));
  return text;
}

std::string factors_key(const ModelDescription& model, Analysis::Kind kind) {
  const bool deforming = kind == Analysis::Kind::sensitivity && model.find_set("deforming") != nullptr;
  return "# Factor sets:\n" + sets_comment(model) +
         lines().explained("analysis", "factors", fmt::format("factors = \"{}\"", deforming ? "deforming" : "all"));
}

std::string samples_key() {
  return lines().usual("analysis", "samples") + lines().keys_lines("analysis.samples") +
         "# samples = " + lines().inline_table("analysis.samples") + "\n";
}

/// A sensitivity study holds the errors that deform nothing, where the model has that set.
std::string background_key(const ModelDescription& model, Analysis::Kind kind) {
  const bool benign = kind == Analysis::Kind::sensitivity && model.find_set("benign") != nullptr;
  return lines().explanation_lines("analysis", "background") + lines().keys_lines("analysis.background") +
         (benign ? "background = { factors = \"benign\" }\n" : "# background = { factors = \"all\" }\n");
}

std::string reference_key(const ModelDescription& model) {
  if (model.factors.empty()) return {};
  const Factor& factor = model.factors.front();
  return lines().explanation_lines("analysis", "reference") + lines().keys_lines("analysis.reference") +
         fmt::format("# reference = {{ factor = {}, tolerance = {} }}\n", in_quotes(factor.name),
                     example_size(factor.dimension, 1.0));
}

/// The responses, and a limit of the first one that is a length, or of the first.
std::string response_limits_key(const ModelDescription& model) {
  if (model.responses.empty()) return {};
  std::string list = "Responses:";
  for (const Response& response : model.responses) list += " " + response.name;
  const auto length = std::ranges::find(model.responses, Dimension::length, &Response::dimension);
  const Response& response = length == model.responses.end() ? model.responses.front() : *length;
  const double limit = display_unit(response.dimension).si / 20.0;
  return comment(list) + lines().explained("analysis", "limits",
                                           fmt::format("# limits = {{ {} = {} }}", response.name,
                                                       readable_value(limit, response.dimension)));
}

std::string groups_key() {
  return lines().explanation_lines("analysis", "groups") + lines().keys_lines("analysis.groups") +
         "groups = [\n"
         "  { name = \"group 1\", linear = \"5 mm\", angular = \"0.005 rad\" },\n"
         "  { name = \"group 2\", linear = \"1 mm\", angular = \"1 deg\" },\n"
         "]\n";
}

std::string cases_key(const ModelDescription& model) {
  const std::string_view sizes = lines().example("analysis.cases", "errors");
  const std::string text = "\n" + lines().explanation_lines("analysis", "cases") +
                           lines().keys_lines("analysis.cases") + lines().keys_lines("analysis.cases.errors", 2) +
                           comment("    " + std::string(lines().meaning("analysis.cases.errors"))) +
                           lines().keys_lines("analysis.cases.errors.SET", 3) +
                           fmt::format("[[analysis.cases]]\nname = \"group 1\"\nerrors = {}\n", sizes);
  if (model.factors.empty()) return text;
  const Factor& factor = model.factors.front();
  return text +
         fmt::format("\n[[analysis.cases]]\nname = \"one error\"\nerrors = {{ {} = {} }}\n# errors = {{ {} = {} }}\n",
                     factor.name, example_size(factor.dimension, 0.1),
                     in_quotes(model.factor_sets.empty() ? factor.name : model.factor_sets.back().name), sizes);
}

/// Whether an error of this dimension is among the literature's sources.
bool has_source_of(const ModelDescription& model, Dimension dimension) {
  return std::ranges::any_of(model.sources, [&](const CouplingSource& source) {
    return std::ranges::any_of(model.find_set(source.set)->factors,
                               [&](FactorIndex factor) { return model.factors[factor.value].dimension == dimension; });
  });
}

std::string sizes_key(const ModelDescription& model, Dimension dimension) {
  std::vector<std::string> sizes;
  for (const double factor : {0.1, 0.3, 0.5}) {
    sizes.push_back(fmt::format("\"{} {}\"", factor, display_unit(dimension).name));
  }
  const std::string_view key = error_kind(dimension);
  return lines().explained(
      "analysis", key, fmt::format("{}{} = {}", has_source_of(model, dimension) ? "" : "# ", key, list_text(sizes)));
}

std::string sources_key(const ModelDescription& model) {
  std::string text = "\n" + lines().explanation_lines("analysis", "sources") + lines().keys_lines("analysis.sources") +
                     "# Factor sets:\n" + sets_comment(model);
  for (const CouplingSource& source : model.sources) {
    text +=
        fmt::format("[[analysis.sources]]\nname = {}\nfactors = {}\n\n", in_quotes(source.name), in_quotes(source.set));
  }
  text.pop_back();
  return text;
}

/// A key of [analysis]: what it shows of the model, or its default.
std::string analysis_key(const ModelDescription& model, Analysis::Kind kind, std::string_view key) {
  if (key == "factors") return factors_key(model, kind);
  if (key == "samples") return samples_key();
  if (key == "background") return background_key(model, kind);
  if (key == "reference") return reference_key(model);
  if (key == "limits") return response_limits_key(model);
  if (key == "groups") return groups_key();
  if (key == "cases") return cases_key(model);
  if (key == "linear") return sizes_key(model, Dimension::length);
  if (key == "angular") return sizes_key(model, Dimension::angle);
  if (key == "sources") return sources_key(model);
  if (key == "linearity" && model.fidelities.size() != 2) return {};
  const bool behind_sign = key == "linearity" || key == "judge" || key == "share";
  return lines().usual("analysis", key, behind_sign ? "# " : "");
}

std::string analysis_section(const ModelDescription& model, Analysis::Kind kind) {
  std::string text = "\n[analysis]\n" + lines().explained("analysis", "kind", "kind = " + in_quotes(name(kind)));
  for (const std::string_view key : keys_of(kind)) text += analysis_key(model, kind, key);
  return text;
}

std::string metric_keys(const CatalogEntry& entry) {
  const ModelDescription& model = entry.description;
  if (model.metric.empty()) return {};
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : model.geometry) geometry.push_back(parameter.published);
  return lines().explained("solver", "metric", "metric = " + in_quotes(model.metric)) +
         lines().explained("solver", "points",
                           "# points = " + points_text(entry.build(geometry, 0)->metric_points(), readable_value));
}

std::string solver_and_run_sections(const CatalogEntry& entry) {
  return "\n[solver]\n" + metric_keys(entry) + lines().usual("solver", "method") +
         lines().explained("solver", "tolerance", "tolerance = " + shortest(entry.description.tolerance)) +
         lines().usual("solver", "max_iterations") + lines().usual("solver", "not_converged") +
         lines().usual("solver", "max_not_converged") + "\n[run]\n" + lines().usual("run", "seed");
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

std::string template_text(const CatalogEntry& entry, Analysis::Kind kind) {
  const CatalogEntry& chosen = entry.by_platform ? *entry.by_platform : entry;
  const ModelDescription& model = chosen.description;
  POESY_EXPECTS(kind != Analysis::Kind::coupling || !model.sources.empty());
  return head(model, kind) + mechanism_section(model, kind) + poses_section(model) + errors_section(model) +
         analysis_section(model, kind) + solver_and_run_sections(chosen);
}

std::string study_reference() { return introduction() + tables_reference(study_tables()); }

}  // namespace poesy
