#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "engine/base/contract.h"
#include "engine/io/study_file.h"
#include "engine/io/study_template_comment.h"
#include "engine/io/study_text.h"

namespace poesy {
namespace {

std::string title(Analysis::Kind kind) {
  std::string text(name(kind));
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string head(const ModelDescription& model, Analysis::Kind kind) {
  return comment(model.name + ": " + model.title) + "# Run this study with: poesy run STUDY.toml\n" +
         comment("Quantities are texts with a unit: " + unit_names() + ".") +
         "# A key behind a '#' shows a default or an alternative. All keys: poesy template --reference\n" +
         explained("", "format", "format = \"poesy-study\"") + explained("", "version", "version = 1") +
         explained("", "title", "title = " + in_quotes(title(kind) + " of " + model.name));
}

std::string fidelity_keys(const ModelDescription& model, Analysis::Kind kind) {
  if (model.fidelities.empty()) return {};
  std::string text = comment(fmt::format("fidelity: {}", fmt::join(model.fidelities, ", "))) +
                     explained("mechanism", "fidelity", "fidelity = " + in_quotes(model.fidelities.front()));
  if (model.fidelities.size() == 2 && kind == Analysis::Kind::sensitivity) {
    text += fmt::format("# fidelity = {}\n", in_quotes(kBothFidelities));
  }
  return text;
}

std::string mechanism_section(const ModelDescription& model, Analysis::Kind kind) {
  std::string text = "\n[mechanism]\n" + explained("mechanism", "model", "model = " + in_quotes(model.name)) +
                     fidelity_keys(model, kind);
  if (model.geometry.empty()) return text;
  text += "\n" + explained("mechanism", "geometry", "# [mechanism.geometry]");
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
  return comment(list) + explained("poses", "limits", fmt::format("# limits = {{ {} = {} }}", joint.name, range));
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
  std::string text = explanation_lines("poses", "trajectory") + keys_lines("poses.trajectory");
  for (const NamedCurve& curve : model.curves) text += curve_example(curve, model);
  return text + "# trajectory = { file = \"curve.csv\", points = 201, time = [\"0 s\", \"2 s\"] }\n";
}

std::string workspace_key(const ModelDescription& model) {
  std::vector<Range> workspace;
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    workspace.push_back({model.pose_lower[c], model.pose_upper[c]});
  }
  std::string text = explanation_lines("poses", "workspace");
  for (const PoseCoordinate& coordinate : model.pose_coordinates) {
    text += comment("  " + coordinate.name + ": " + coordinate.description);
  }
  if (!model.workspace_note.empty()) text += comment(model.workspace_note);
  return text + "workspace = " + workspace_text(workspace, model, readable_value) + "\n";
}

std::string poses_section(const ModelDescription& model) {
  return "\n[poses]\n" + charts_comment(model) + explained("poses", "select", "select = \"interior\"") +
         explained("poses", "count", "count = 158") + "# " + grid_example(model) + "\n" + workspace_key(model) +
         limits_key(model) + explained("poses", "max_condition", "# max_condition = 1e8") +
         explained("poses", "file", "# file = \"poses.csv\"") + trajectory_key(model);
}

std::string override_key(const ModelDescription& model) {
  if (model.factors.empty()) return {};
  const Factor& factor = model.factors.front();
  return explained("errors", "override",
                   fmt::format("# override = {{ {} = {{ distribution = \"uniform\", half_width = {} }} }}", factor.name,
                               factor.dimension == Dimension::length ? "\"0.5 mm\"" : "\"0.5 deg\""));
}

std::string errors_section(const ModelDescription& model) {
  return "\n" + comment(table_meaning("errors")) + keys_lines("errors.linear") + "[errors]\n" +
         explained("errors", "linear", "linear = { distribution = \"normal\", sigma = \"1 mm\" }") +
         explained("errors", "angular", "angular = { distribution = \"normal\", sigma = \"1 deg\" }") +
         override_key(model);
}

std::string sets_comment(const ModelDescription& model) {
  std::string text;
  for (const FactorSet& set : model.factor_sets) {
    text += comment(fmt::format("  \"{}\" ({}): {}", set.name, set.factors.size(), set.description));
  }
  if (model.find_set("all") == nullptr) text += comment(fmt::format("  \"all\" ({})", model.factors.size()));
  return text;
}

std::string factors_key(const ModelDescription& model, std::string_view usual) {
  return "# Factor sets:\n" + sets_comment(model) +
         explained("analysis", "factors", fmt::format("factors = \"{}\"", usual));
}

std::string samples_keys() {
  return explained("analysis", "samples", "samples = 1000") + keys_lines("analysis.samples") +
         "# samples = { min = 1000, max = 1000000, relative_error = 0.01 }\n" +
         explained("analysis", "conf_level", "conf_level = 0.95");
}

std::string background_key(std::string_view line) {
  return explanation_lines("analysis", "background") + keys_lines("analysis.background") + std::string(line) + "\n";
}

std::string reference_key(const ModelDescription& model) {
  if (model.factors.empty()) return {};
  const Factor& factor = model.factors.front();
  return explanation_lines("analysis", "reference") + keys_lines("analysis.reference") +
         fmt::format("# reference = {{ factor = {}, tolerance = {} }}\n", in_quotes(factor.name),
                     factor.dimension == Dimension::length ? "\"1 mm\"" : "\"1 deg\"");
}

std::string sensitivity_keys(const ModelDescription& model) {
  const bool has_benign = model.find_set("benign") != nullptr;
  std::string text = factors_key(model, model.find_set("deforming") != nullptr ? "deforming" : "all") + samples_keys();
  text += background_key(has_benign ? "background = { factors = \"benign\" }" : "# background = { factors = \"all\" }");
  if (model.fidelities.size() == 2) text += explained("analysis", "linearity", "# linearity = 0.01");
  return text + reference_key(model);
}

/// The responses, and a limit of the first one that is a length, or of the first.
std::string response_limits_key(const ModelDescription& model) {
  if (model.responses.empty()) return {};
  std::string list = "Responses:";
  for (const Response& response : model.responses) list += " " + response.name;
  const auto length = std::ranges::find(model.responses, Dimension::length, &Response::dimension);
  const Response& response = length == model.responses.end() ? model.responses.front() : *length;
  const double limit = display_unit(response.dimension).si / 20.0;
  return comment(list) +
         explained("analysis", "limits",
                   fmt::format("# limits = {{ {} = {} }}", response.name, readable_value(limit, response.dimension)));
}

std::string monte_carlo_keys(const ModelDescription& model) {
  return factors_key(model, "all") + samples_keys() +
         explained("analysis", "quantiles", "quantiles = [0.05, 0.5, 0.95]") + response_limits_key(model) +
         explained("analysis", "judge", "# judge = \"rms\"") + explained("analysis", "share", "# share = 0.9973") +
         background_key("# background = { factors = \"all\" }");
}

std::string identification_keys(const ModelDescription& model) {
  return factors_key(model, "all") + explained("analysis", "pose_share", "pose_share = 0.95") +
         explanation_lines("analysis", "groups") + keys_lines("analysis.groups") +
         "groups = [\n"
         "  { name = \"group 1\", linear = \"5 mm\", angular = \"0.005 rad\" },\n"
         "  { name = \"group 2\", linear = \"1 mm\", angular = \"1 deg\" },\n"
         "]\n";
}

std::string evaluate_keys(const ModelDescription& model) {
  std::string text =
      background_key("# background = { factors = \"all\" }") + response_limits_key(model) + "\n" +
      explanation_lines("analysis", "cases") + keys_lines("analysis.cases") + keys_lines("analysis.cases.errors", 2) +
      comment("    " + std::string(table_meaning("analysis.cases.errors"))) +
      keys_lines("analysis.cases.errors.SET", 3) +
      "[[analysis.cases]]\nname = \"group 1\"\nerrors = { linear = \"0.1 mm\", angular = \"0.1 deg\" }\n";
  if (model.factors.empty()) return text;
  const Factor& factor = model.factors.front();
  return text + fmt::format(
                    "\n[[analysis.cases]]\nname = \"one error\"\nerrors = {{ {} = {} }}\n"
                    "# errors = {{ {} = {{ linear = \"0.1 mm\", angular = \"0.1 deg\" }} }}\n",
                    factor.name, factor.dimension == Dimension::length ? "\"0.1 mm\"" : "\"0.1 deg\"",
                    in_quotes(model.factor_sets.empty() ? factor.name : model.factor_sets.back().name));
}

/// Whether an error of this dimension is among the literature's sources.
bool has_source_of(const ModelDescription& model, Dimension dimension) {
  return std::ranges::any_of(model.sources, [&](const CouplingSource& source) {
    return std::ranges::any_of(model.find_set(source.set)->factors,
                               [&](FactorIndex factor) { return model.factors[factor.value].dimension == dimension; });
  });
}

std::string coupling_keys(const ModelDescription& model) {
  const auto sizes = [&](Dimension dimension, std::string_view key, std::string_view line) {
    return explained("analysis", key, fmt::format("{}{}", has_source_of(model, dimension) ? "" : "# ", line));
  };
  std::string text = sizes(Dimension::length, "linear", "linear = [\"0.1 mm\", \"0.3 mm\", \"0.5 mm\"]") +
                     sizes(Dimension::angle, "angular", "angular = [\"0.1 deg\", \"0.3 deg\", \"0.5 deg\"]") +
                     explained("analysis", "limbs", "limbs = \"all\"") +
                     explained("analysis", "components", "components = \"all\"") + "\n" +
                     explanation_lines("analysis", "sources") + keys_lines("analysis.sources") + "# Factor sets:\n" +
                     sets_comment(model);
  for (const CouplingSource& source : model.sources) {
    text +=
        fmt::format("[[analysis.sources]]\nname = {}\nfactors = {}\n\n", in_quotes(source.name), in_quotes(source.set));
  }
  text.pop_back();
  return text;
}

std::string analysis_section(const ModelDescription& model, Analysis::Kind kind) {
  const std::string text = "\n[analysis]\n" + explained("analysis", "kind", "kind = " + in_quotes(name(kind)));
  switch (kind) {
    case Analysis::Kind::sensitivity:
      return text + sensitivity_keys(model);
    case Analysis::Kind::monte_carlo:
      return text + monte_carlo_keys(model);
    case Analysis::Kind::identification:
      return text + identification_keys(model);
    case Analysis::Kind::evaluate:
      return text + evaluate_keys(model);
    case Analysis::Kind::coupling:
      break;
  }
  return text + coupling_keys(model);
}

std::string metric_keys(const CatalogEntry& entry) {
  const ModelDescription& model = entry.description;
  if (model.metric.empty()) return {};
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : model.geometry) geometry.push_back(parameter.published);
  return explained("solver", "metric", "metric = " + in_quotes(model.metric)) +
         explained("solver", "points",
                   "# points = " + points_text(entry.build(geometry, 0)->metric_points(), readable_value));
}

std::string solver_and_run_sections(const CatalogEntry& entry) {
  const ModelDescription& model = entry.description;
  return "\n[solver]\n" + metric_keys(entry) + explained("solver", "method", "method = \"newton\"") +
         explained("solver", "tolerance", "tolerance = " + shortest(model.tolerance)) +
         explained("solver", "max_iterations", "max_iterations = 50") +
         explained("solver", "not_converged", "not_converged = \"exclude\"") +
         explained("solver", "max_not_converged", "max_not_converged = 1") + "\n[run]\n" +
         explained("run", "seed", "seed = 1");
}

}  // namespace

std::string template_text(const CatalogEntry& entry, Analysis::Kind kind) {
  const CatalogEntry& chosen = entry.by_platform ? *entry.by_platform : entry;
  const ModelDescription& model = chosen.description;
  POESY_EXPECTS(kind != Analysis::Kind::coupling || !model.sources.empty());
  return head(model, kind) + mechanism_section(model, kind) + poses_section(model) + errors_section(model) +
         analysis_section(model, kind) + solver_and_run_sections(chosen);
}

}  // namespace poesy
