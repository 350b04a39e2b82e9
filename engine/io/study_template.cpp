#include <fmt/format.h>

#include <string>

#include "engine/io/study_file.h"
#include "engine/io/study_text.h"

namespace poesy {
namespace {

/// Text of any number of lines as comment lines.
std::string comment(std::string_view text) {
  std::string out = "# ";
  for (const char character : text) {
    out += character;
    if (character == '\n') out += "# ";
  }
  return out + "\n";
}

std::string head(const ModelDescription& model) {
  return comment(model.name + ": " + model.title) +
         "# Run this study with: poesy run STUDY.toml\n"
         "# Quantities are texts with a unit: m, mm, um, rad, mrad, deg, arcsec.\n"
         "# A key behind a '#' shows a default or an alternative.\n" +
         fmt::format("format = \"poesy-study\"\nversion = 1\ntitle = {}  # optional, free text\n",
                     quoted("Sensitivity of " + model.name));
}

std::string mechanism_section(const ModelDescription& model) {
  std::string text = fmt::format("\n[mechanism]\nmodel = {}  # 'poesy models' lists the models\n", quoted(model.name));
  if (model.geometry.empty()) return text;
  text += "\n# Optional: what is left out keeps the published value, which is shown here.\n# [mechanism.geometry]\n";
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

std::string joint_list(const ModelDescription& model) {
  std::string text = " ";
  for (const JointDisplacement& joint : model.joints) {
    text += fmt::format(" {} ({})", joint.name, name(joint.dimension));
  }
  return text;
}

std::string poses_section(const ModelDescription& model) {
  std::vector<Range> workspace;
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    workspace.push_back({model.pose_lower[c], model.pose_upper[c]});
  }
  std::string text = "\n[poses]\n";
  text += "# interior: that many points of a Sobol' sequence in the workspace; more poses begin with the same ones\n";
  text += "# boundary: that many points on the boundary of the feasible part of the workspace, uniform by area\n";
  text += "# grid: that many points of a regular grid, or all of one with " + grid_example(model) + "\n";
  text += "# file: poses from CSV, first line the names of all pose coordinates, SI units\n";
  text += "select = \"interior\"  # the default\n";
  text += "count = 158  # required for all but file, at least 1\n";
  text += "# A range [lower, upper] for every pose coordinate. Default: the model's own workspace, shown here.\n";
  for (const PoseCoordinate& coordinate : model.pose_coordinates) {
    text += comment(coordinate.name + ": " + coordinate.description);
  }
  if (!model.workspace_note.empty()) text += comment(model.workspace_note);
  text += "workspace = " + workspace_text(workspace, model, readable_value) + "\n";
  if (!model.joints.empty()) {
    const JointDisplacement& joint = model.joints.front();
    text += "# Optional: ranges of joint displacements from home, [lower, upper]; other poses are rejected. Joints:\n";
    text += comment(joint_list(model));
    text += fmt::format("# limits = {{ {} = {} }}\n", joint.name,
                        joint.dimension == Dimension::length ? "[\"-50 mm\", \"50 mm\"]" : "[\"-30 deg\", \"30 deg\"]");
  }
  text += "# max_condition = 1e8  # poses whose condition number is above it are rejected as singular; the default\n";
  return text +
         "# file = \"poses.csv\"  # instead of count, workspace, limits and max_condition, with select = \"file\"; "
         "beside this study\n";
}

std::string override_example(const ModelDescription& model) {
  for (const Factor& factor : model.factors) {
    return fmt::format("# override = {{ {} = {{ distribution = \"uniform\", half_width = {} }} }}\n", factor.name,
                       factor.dimension == Dimension::length ? "\"0.5 mm\"" : "\"0.5 deg\"");
  }
  return {};
}

std::string errors_section(const ModelDescription& model) {
  return "\n# How errors scatter about zero, by their dimension; the values shown are the defaults. Distributions:\n"
         "#   { distribution = \"normal\", sigma = \"1 mm\" }\n"
         "#   { distribution = \"truncated-normal\", sigma = \"1 mm\", half_width = \"2 mm\" }  cut off at "
         "+-half_width\n"
         "#   { distribution = \"uniform\", half_width = \"1 mm\" }\n"
         "#   { distribution = \"triangular\", half_width = \"1 mm\" }\n"
         "[errors]\n"
         "linear = { distribution = \"normal\", sigma = \"1 mm\" }\n"
         "angular = { distribution = \"normal\", sigma = \"1 deg\" }\n"
         "# Optional: single errors with a distribution of their own.\n" +
         override_example(model);
}

std::string sets_comment(const ModelDescription& model) {
  std::string text;
  for (const FactorSet& set : model.factor_sets) {
    text += comment(fmt::format("  \"{}\" ({}): {}", set.name, set.factors.size(), set.description));
  }
  if (model.find_set("all") == nullptr) text += comment(fmt::format("  \"all\" ({})", model.factors.size()));
  return text;
}

std::string analysis_section(const ModelDescription& model) {
  const bool has_benign = model.find_set("benign") != nullptr;
  const std::string_view held = has_benign ? "benign" : "all";
  std::string text = "\n[analysis]\nkind = \"sensitivity\"  # the default\n";
  text += "# The errors that vary, one at a time: a factor set, or a list of names such as [";
  text += model.factors.empty() ? "]" : quoted(model.factors.front().name) + "]";
  text += ". Factor sets:\n" + sets_comment(model);
  text +=
      fmt::format("factors = \"{}\"  # the default\n", model.find_set("deforming") != nullptr ? "deforming" : "all");
  text += "samples = 1000  # for each varied error at each pose, at least 2; the default\n";
  text += "conf_level = 0.95  # of the intervals, between 0 and 1; the default\n";
  text += "# Optional: errors held constant while the others vary one at a time. Default: none.\n";
  text += fmt::format("{}background = {{ factors = \"{}\", linear = \"1 mm\", angular = \"1 deg\" }}\n",
                      has_benign ? "" : "# ", held);
  return text;
}

std::string solver_and_run_sections() {
  return "\n# All values shown are the defaults.\n"
         "[solver]\n"
         "method = \"newton\"  # or \"gauss-newton\", as published: slower, and more samples do not converge\n"
         "tolerance = 1e-15  # converged: the residual's largest change (rad, m) in one iteration is below this\n"
         "max_iterations = 50  # at least 1\n"
         "not_converged = \"exclude\"  # from all statistics; include: keep the last iterate; fail: exclude, exit code "
         "5\n"
         "\n[run]\n"
         "seed = 1  # a whole number from 0; the same seed gives the same bits on any number of threads\n";
}

}  // namespace

std::string template_text(const CatalogEntry& entry) {
  const ModelDescription& model = entry.description;
  return head(model) + mechanism_section(model) + poses_section(model) + errors_section(model) +
         analysis_section(model) + solver_and_run_sections();
}

}  // namespace poesy
