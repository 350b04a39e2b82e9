#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "engine/base/contract.h"
#include "engine/base/text.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

/// The units in which a study of this model may state values. Units of length, angle and time are always listed, units
/// of another dimension only if the model has a response of this dimension.
std::string model_units(const ModelDescription& model) {
  std::string list;
  for (const Dimension dimension : all_dimensions()) {
    const bool always = dimension == Dimension::length || dimension == Dimension::angle || dimension == Dimension::time;
    const bool responds = std::ranges::find(model.responses, dimension, &Response::dimension) != model.responses.end();
    const std::string these = always || responds ? unit_names(dimension) : "";
    list += (list.empty() || these.empty() ? "" : ", ") + these;
  }
  return list;
}

std::string head(const TemplateLines& lines, const Study& shown) {
  const ModelDescription& model = shown.model();
  std::string title = fmt::format("{} of {}", shown.analysis.kind->name, model.name);
  title.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(title.front())));
  return comment(model.name + ": " + model.title) + "# Run this study with: poesy run STUDY.toml\n" +
         comment("Quantities are texts with a unit: " + model_units(model) + ".") +
         "# A key behind a '#' shows a default or an alternative. All keys: poesy template --reference\n" +
         lines.usual("", "format") + lines.usual("", "version") +
         lines.explained("", "title", "title = " + in_quotes(title));
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
  const std::string& file = shown.mechanism.entry->file;
  std::string text = "\n[mechanism]\n" +
                     (file.empty() ? lines.explained("mechanism", "model", "model = " + in_quotes(model.name)) +
                                         lines.explained("mechanism", "file", "# file = \"mechanism.toml\"")
                                   : lines.explained("mechanism", "file", "file = " + in_quotes(file))) +
                     fidelity_keys(lines, shown);
  if (model.geometry.empty()) return text;
  text += "\n" + lines.explained("mechanism", "geometry", "# [mechanism.geometry]");
  for (const GeometryParameter& parameter : model.geometry) {
    text += fmt::format("# {} = {}  # {}\n", parameter.name, readable_value(parameter.published, parameter.dimension),
                        parameter.description);
  }
  return text;
}

/// Comment lines of a template that show how a user defines a response.
std::string response_section(const TemplateLines& lines, const ModelDescription& model) {
  if (model.responses.empty()) return {};
  std::string example;
  for (const Response& response : model.responses) {
    if (!example.empty() || response.components.size() < 2) continue;
    example = fmt::format("# norm = [\"{}\", \"{}\"]\n", model.responses[response.components[0]].name,
                          model.responses[response.components[1]].name);
  }
  if (example.empty()) example = fmt::format("# sum = {{ {} = 1 }}\n", model.responses.front().name);
  return "\n" + lines.explanation_lines("", "response") + lines.keys_lines("response") +
         "# [[response]]\n# name = \"own\"\n" + example;
}

/// Comment lines of a template that list the model's charts (PoseChart): other coordinates in which a file may state
/// poses.
std::string charts_comment(const ModelDescription& model) {
  std::string text;
  for (const PoseChart& chart : model.charts) {
    text += comment(fmt::format("Chart {} in which a file may give poses: {}", chart.name,
                                fmt::join(names(chart.coordinates), ", ")));
  }
  return text;
}

std::string analysis_section(const TemplateLines& lines, const Study& shown) {
  const StudyKind& kind = *shown.analysis.kind;
  const StudyRows rows = analysis_keys(kind);
  std::string text = "\n[analysis]\n" + lines.explained("analysis", "kind", "kind = " + in_quotes(kind.name));
  for (const std::string_view key : kind.keys) text += template_lines(lines, "analysis", row_of(rows, key), shown);
  return text;
}

/// The units of a dimension as Markdown: "`m`, `cm`".
std::string units_of(Dimension dimension) {
  std::vector<std::string_view> list;
  for (const Unit& unit : units()) {
    if (unit.dimension == dimension) list.push_back(unit.name);
  }
  return fmt::format("`{}`", fmt::join(list, "`, `"));
}

std::string introduction() {
  return fmt::format(
      "# Study files\n\n"
      "Every key of a study file, as `poesy template --reference` prints it. Do not edit: it is made of the "
      "descriptions\n"
      "by which the program reads studies (`engine/study`, `engine/kinds`), and a test compares.\n\n"
      "A study is [TOML](https://toml.io). `poesy template MODEL KIND` writes a complete one, `poesy check "
      "STUDY.toml`\n"
      "prints it with every default filled in.\n\n"
      "- A key that is not listed is an error, and so is one that does not hold for the study's kind or choice of\n"
      "  poses, unless it says \"else ignored\".\n"
      "- A length, an angle or a time is a text of a number and a unit: `\"0.1 mm\"`. Lengths: {}. Angles: {}. Times: "
      "{}.\n"
      "  So is a force, a moment or an energy, where a mechanism responds with one. Forces: {}. Moments: {}. Energies: "
      "{}.\n"
      "  `µm`, `°` and `inch` may be written for `um`, `deg` and `in`. A bare number is an error. A *quantity* has the "
      "dimension of what it is a value of.\n"
      "- A number between 0 and 1 may be a text in percent: `\"99.73 %\"`.\n"
      "- Names in capitals stand for names of the mechanism's, which `poesy models MODEL` lists: PARAMETER, "
      "COORDINATE,\n"
      "  JOINT, FACTOR, SET.\n"
      "- A table `[poses]` with a key `workspace` of type table may be written as `workspace = {{ ... }}` there, as\n"
      "  `[poses.workspace]`, or with dots; a list of tables as `[[analysis.cases]]` for each of them.\n"
      "- *Required* means: wherever the key holds.\n",
      units_of(Dimension::length), units_of(Dimension::angle), units_of(Dimension::time), units_of(Dimension::force),
      units_of(Dimension::moment), units_of(Dimension::energy));
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
  const TemplateLines lines(kinds.tables, kind.name);
  Study shown;
  shown.mechanism.entry = entry.description.metric == "published" ? &by_metric(entry, "platform") : &entry;
  for (const GeometryParameter& one : shown.model().geometry) shown.mechanism.geometry.push_back(one.published);
  shown.analysis.kind = &kind;
  shown.analysis.draws = kind.draws;
  POESY_EXPECTS(kind.no_template == nullptr || !kind.no_template(shown.model()));
  return head(lines, shown) + mechanism_section(lines, shown) + response_section(lines, shown.model()) + "\n[poses]\n" +
         charts_comment(shown.model()) + template_lines(lines, poses_keys(), shown) + "\n" +
         comment(lines.meaning("errors")) + lines.keys_lines("errors.linear") + "[errors]\n" +
         template_lines(lines, errors_keys(), shown) + analysis_section(lines, shown) + "\n[solver]\n" +
         template_lines(lines, solver_keys(), shown) + "\n[run]\n" + template_lines(lines, run_keys(), shown);
}

std::string study_reference(const StudyKinds& kinds) { return introduction() + tables_reference(kinds.tables); }

}  // namespace poesy
