#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "engine/base/contract.h"
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

std::string title(Analysis::Kind kind) {
  std::string text(name(kind));
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string head(const ModelDescription& model, Analysis::Kind kind) {
  return comment(model.name + ": " + model.title) +
         "# Run this study with: poesy run STUDY.toml\n"
         "# Quantities are texts with a unit: m, mm, um, rad, mrad, deg, arcsec, s, ms, min, h.\n"
         "# A key behind a '#' shows a default or an alternative.\n" +
         fmt::format("format = \"poesy-study\"\nversion = 1\ntitle = {}  # optional, free text\n",
                     quoted(title(kind) + " of " + model.name));
}

std::string mechanism_section(const ModelDescription& model, Analysis::Kind kind) {
  std::string text = fmt::format("\n[mechanism]\nmodel = {}  # 'poesy models' lists the models\n", quoted(model.name));
  if (!model.fidelities.empty()) {
    text += fmt::format("fidelity = {}  # of {}; the first is the default\n", quoted(model.fidelities.front()),
                        fmt::join(model.fidelities, ", "));
    if (model.fidelities.size() == 2 && kind == Analysis::Kind::sensitivity) {
      text +=
          fmt::format("# fidelity = {}  # both on the same draws: how much they differ, and which errors are linear\n",
                      quoted(kBothFidelities));
    }
  }
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

std::string name_list(const std::vector<PoseCoordinate>& coordinates) {
  std::string text;
  for (const PoseCoordinate& coordinate : coordinates) text += (text.empty() ? "" : ", ") + coordinate.name;
  return text;
}

/// Other coordinates in which a file may give poses.
std::string charts_comment(const ModelDescription& model) {
  std::string text;
  for (const PoseChart& chart : model.charts) {
    text += comment(fmt::format("  or those of {}: {}", chart.name, name_list(chart.coordinates)));
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
                     quoted(curve.name), origin, readable_value(curve.start, Dimension::time),
                     readable_value(curve.end, Dimension::time), curve.description);
}

std::string trajectory_comment(const ModelDescription& model) {
  std::string text = "# trajectory: instead of count, workspace and limits, with select = \"trajectory\"\n";
  if (!model.curves.empty())
    text += "# a curve at times evenly spaced; all but its name may be left out, then as shown:\n";
  for (const NamedCurve& curve : model.curves) text += curve_example(curve, model);
  return text +
         "# a file beside this study: CSV with a column t (s) and pose coordinates, SI. Between its points it is read "
         "by\n"
         "# modified Akima splines (straight lines where it has two or three). Without points and time its own points "
         "are\n"
         "# the poses. What is left out of these two: 201 points, all of the file's time.\n"
         "# trajectory = { file = \"curve.csv\", points = 201, time = [\"0 s\", \"2 s\"] }\n";
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
  text += charts_comment(model);
  text += "# trajectory: poses along a curve, in the order of time\n";
  text += "select = \"interior\"  # the default\n";
  text += "count = 158  # required for all but file and trajectory, at least 1\n";
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
         "beside this study\n" +
         trajectory_comment(model);
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

std::string factors_text(const ModelDescription& model, std::string_view what, std::string_view usual) {
  std::string text = fmt::format("# {}: a factor set, or a list of names such as [", what);
  text += model.factors.empty() ? "]" : quoted(model.factors.front().name) + "]";
  return text + ". Factor sets:\n" + sets_comment(model) + fmt::format("factors = \"{}\"  # the default\n", usual);
}

/// quantity: what is sampled until its interval is narrow.
std::string samples_text(std::string_view of_what, std::string_view quantity) {
  return fmt::format(
      "samples = 1000  # {}, at least 2; the default\n"
      "# or as many as it takes: until half the width of every {}'s interval is at most relative_error of its value\n"
      "# samples = {{ min = 1000, max = 1000000, relative_error = 0.01 }}  # min: the default; the other two are "
      "required\n"
      "conf_level = 0.95  # of the intervals, between 0 and 1; the default\n",
      of_what, quantity);
}

std::string background_text(const ModelDescription& model) {
  const bool has_benign = model.find_set("benign") != nullptr;
  return fmt::format("{}background = {{ factors = \"{}\", linear = \"1 mm\", angular = \"1 deg\" }}\n",
                     has_benign ? "" : "# ", has_benign ? "benign" : "all");
}

std::string sensitivity_keys(const ModelDescription& model) {
  const std::string_view usual = model.find_set("deforming") != nullptr ? "deforming" : "all";
  std::string text = factors_text(model, "The errors that vary, one at a time", usual);
  text += samples_text("for each varied error at each pose", "global index");
  text += "# Optional: errors held constant while others vary; what varies is not held. Default: none.\n";
  text += background_text(model);
  if (model.fidelities.size() == 2) {
    text += "# linearity = 0.01  # with fidelity = \"both\": an error that differs by no more is linear; the default\n";
  }
  text += "# Optional: the error from which tolerances of equal effect are counted, and its own tolerance.\n";
  text += "# Default: the error of smallest effect, at 1 mm or 1 deg.\n";
  if (model.factors.empty()) return text;
  const Factor& factor = model.factors.front();
  return text + fmt::format("# reference = {{ factor = {}, tolerance = {} }}\n", quoted(factor.name),
                            factor.dimension == Dimension::length ? "\"1 mm\"" : "\"1 deg\"");
}

std::string monte_carlo_keys(const ModelDescription& model) {
  return factors_text(model, "The errors that vary, all together", "all") +
         samples_text("at each pose", "overall mean") +
         "quantiles = [0.05, 0.5, 0.95]  # shares of the samples that lie below; the default\n"
         "# Optional: errors held constant while the others vary. Default: none.\n"
         "# background = { factors = \"all\", linear = \"1 mm\", angular = \"1 deg\" }\n";
}

std::string identification_keys(const ModelDescription& model) {
  return factors_text(model, "The errors that are tried, each alone and with those of its frame", "all") +
         "# A verdict asks for this share of the poses; the default.\n"
         "pose_share = 0.95\n"
         "# The sizes at which errors are set; each group gives verdicts of its own. Default: one group, 1 mm, 1 deg.\n"
         "groups = [\n"
         "  { name = \"group 1\", linear = \"5 mm\", angular = \"0.005 rad\" },\n"
         "  { name = \"group 2\", linear = \"1 mm\", angular = \"1 deg\" },\n"
         "]\n";
}

std::string evaluate_keys(const ModelDescription& model) {
  std::string text =
      "# Optional: errors that every case has, unless it sets them. Default: none.\n"
      "# background = { factors = \"all\", linear = \"0.1 mm\", angular = \"0.1 deg\" }\n"
      "\n# Fixed errors, each case with a name. What is not set is zero. `linear` and `angular` set all lengths and "
      "all\n"
      "# angles; a factor set does so for its own, a factor for itself: the narrower wins.\n"
      "[[analysis.cases]]\nname = \"group 1\"\nerrors = { linear = \"0.1 mm\", angular = \"0.1 deg\" }\n";
  if (model.factors.empty()) return text;
  const Factor& factor = model.factors.front();
  return text + fmt::format(
                    "\n[[analysis.cases]]\nname = \"one error\"\nerrors = {{ {} = {} }}\n"
                    "# errors = {{ {} = {{ linear = \"0.1 mm\", angular = \"0.1 deg\" }} }}\n",
                    factor.name, factor.dimension == Dimension::length ? "\"0.1 mm\"" : "\"0.1 deg\"",
                    quoted(model.factor_sets.empty() ? factor.name : model.factor_sets.back().name));
}

/// Whether an error of this dimension is among the literature's sources.
bool has_source_of(const ModelDescription& model, Dimension dimension) {
  return std::ranges::any_of(model.sources, [&](const CouplingSource& source) {
    return std::ranges::any_of(model.find_set(source.set)->factors,
                               [&](FactorIndex factor) { return model.factors[factor.value].dimension == dimension; });
  });
}

std::string coupling_keys(const ModelDescription& model) {
  const auto sizes = [&](Dimension dimension, const char* line) {
    return fmt::format("{}{}\n", has_source_of(model, dimension) ? "" : "# ", line);
  };
  std::string text =
      "# Sizes of the errors: each is a run of its own, in which every error is at once as large as that. linear for\n"
      "# lengths, angular for angles: as many of both, or that alone which the sources have.\n";
  text += sizes(Dimension::length, "linear = [\"0.1 mm\", \"0.3 mm\", \"0.5 mm\"]") +
          sizes(Dimension::angle, "angular = [\"0.1 deg\", \"0.3 deg\", \"0.5 deg\"]");
  text +=
      "# all: the errors of every limb; a number: of that limb alone; independent: each limb on its own in the worst "
      "case\n"
      "# and the root sum square\n"
      "limbs = \"all\"  # the default\n"
      "# all: every component of an error; a list such as [\"x\", \"z\"]: those and scalars; independent: each "
      "component of\n"
      "# each error on its own, as for limbs\n"
      "components = \"all\"  # the default\n"
      "\n# 2 to 8 sources of errors: each alone, and every combination of them at once. A factor belongs to one "
      "source.\n"
      "# factors: a factor set, or a list of names. Default: the sources shown. Factor sets:\n" +
      sets_comment(model);
  for (const CouplingSource& source : model.sources) {
    text += fmt::format("[[analysis.sources]]\nname = {}\nfactors = {}\n\n", quoted(source.name), quoted(source.set));
  }
  text.pop_back();
  return text;
}

std::string analysis_section(const ModelDescription& model, Analysis::Kind kind) {
  std::string text = fmt::format("\n[analysis]\nkind = {}{}\n", quoted(name(kind)),
                                 kind == Analysis::Kind::sensitivity ? "  # the default" : "");
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

std::string solver_and_run_sections() {
  return "\n# All values shown are the defaults.\n"
         "[solver]\n"
         "method = \"newton\"  # or \"gauss-newton\", as published: slower, and more samples do not converge\n"
         "tolerance = 1e-15  # converged: the residual's largest change (rad, m) in one iteration is below this\n"
         "max_iterations = 50  # at least 1\n"
         "not_converged = \"exclude\"  # from all statistics; include: keep the last iterate\n"
         "max_not_converged = 1  # share of all samples; if more fail, exit code 5, the result kept\n"
         "\n[run]\n"
         "seed = 1  # a whole number from 0; the same seed gives the same bits on any number of threads\n";
}

}  // namespace

std::string template_text(const CatalogEntry& entry, Analysis::Kind kind) {
  const ModelDescription& model = entry.description;
  POESY_EXPECTS(kind != Analysis::Kind::coupling || !model.sources.empty());
  return head(model, kind) + mechanism_section(model, kind) + poses_section(model) + errors_section(model) +
         analysis_section(model, kind) + solver_and_run_sections();
}

}  // namespace poesy
