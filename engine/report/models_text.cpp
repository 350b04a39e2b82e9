#include <fmt/format.h>

#include "engine/report/tables.h"
#include "engine/study/mechanism_doubts.h"

namespace poesy {
namespace {

std::string chart_text(const PoseChart& chart) {
  std::string text = fmt::format("\nposes may be given by {}\n", chart.name);
  for (const PoseCoordinate& coordinate : chart.coordinates) {
    text += fmt::format("  {:<16} {:>8} {}\n", coordinate.name, si_unit(coordinate.dimension), coordinate.description);
  }
  return text;
}

/// A section on the places of those errors that the mechanism's file describes in its own words; empty if there are
/// none.
std::string places_text(const ModelDescription& model) {
  std::string text;
  for (const Factor& factor : model.factors) {
    if (!factor.place.empty()) text += fmt::format("  {:<16} {}\n", factor.name, factor.place);
  }
  return text.empty() ? text : "\nwhere these errors are, and their directions\n" + text;
}

std::string curve_text(const NamedCurve& curve, const ModelDescription& model) {
  const PoseChart& chart = model.charts[curve.chart];
  std::string origin;
  for (std::size_t c = 0; c < curve.origin.size(); ++c) {
    origin += (c > 0 ? ", " : "") + readable_text({curve.origin[c], chart.coordinates[c].dimension});
  }
  return fmt::format("  {:<16} {}; t from {} to {} s, by {}, from the origin ({}) unless the study sets it\n",
                     curve.name, curve.description, curve.start, curve.end, chart.name, origin);
}

/// The list of a model's responses, with the model's metric if it has one. usual: true if a study that states no metric
/// has this one.
std::string responses_text(const ModelDescription& model, bool usual) {
  std::string text = "\nresponses";
  if (!model.metric.empty()) text += fmt::format(" by [solver] metric = \"{}\"", model.metric);
  text += usual ? ", which a study without the key has\n" : "\n";
  for (const Response& response : model.responses) {
    text += fmt::format("  {:<20} {:>4} {}\n", response.name, si_unit(response.dimension), response.description);
  }
  return text;
}

/// The joints and the mobility of a mechanism from a file; empty for other mechanisms.
std::string mechanism_text(const CatalogEntry& entry) {
  const ModelDescription& model = entry.description;
  if (model.structure.empty()) return {};
  std::string text = "\njoints and frames at home, in the base frame\n" + model.structure + "\nmobility\n";
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : model.geometry) geometry.push_back(parameter.published);
  const std::unique_ptr<Model> model_of_defaults = entry.build(geometry, 0);
  for (const std::string& line : model_of_defaults->mobility()) text += "  " + line + "\n";
  for (const std::string& remark : model_of_defaults->remarks()) text += "  " + remark + "\n";
  for (const auto& list : {model_of_defaults->unusual_geometry(), model_of_defaults->unusual_errors()}) {
    for (const std::string& unusual : list) text += "  hint: " + asked_back(unusual) + "\n";
  }
  return text;
}

}  // namespace

std::string models_text(const Catalog& catalog) {
  std::string text;
  for (const CatalogEntry& entry : catalog) {
    text += fmt::format("{:<12} {}\n", entry.description.name, entry.description.title);
  }
  return text;
}

std::string model_text(const CatalogEntry& entry) {
  const ModelDescription& model = entry.description;
  std::string text = fmt::format("{}: {}\n\ngeometry (change it in [mechanism] geometry)\n", model.name, model.title);
  for (const GeometryParameter& parameter : model.geometry) {
    const Unit& unit = display_unit(parameter.dimension);
    text += fmt::format("  {:<16} {:>8.6g} {:<4} {}\n", parameter.name, parameter.published / unit.si, unit.name,
                        parameter.description);
  }
  text += mechanism_text(entry);
  if (!model.fidelities.empty()) {
    text += "\nfidelity (choose it in [mechanism]; the first is the default)\n";
    for (const std::string& fidelity : model.fidelities) text += "  " + fidelity + "\n";
  }
  text += "\npose coordinates and default workspace\n";
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    const Unit& unit = display_unit(coordinate.dimension);
    text += fmt::format("  {:<16} {:>8.6g} to {:<8.6g} {:<4} {}\n", coordinate.name, model.pose_lower[c] / unit.si,
                        model.pose_upper[c] / unit.si, unit.name, coordinate.description);
  }
  text += fmt::format("  {}\n", model.workspace_note);
  for (const PoseChart& chart : model.charts) text += chart_text(chart);
  if (!model.curves.empty()) text += "\ncurves (select = \"trajectory\")\n";
  for (const NamedCurve& curve : model.curves) text += curve_text(curve, model);
  text += "\nfactor sets\n";
  for (const FactorSet& set : model.factor_sets) {
    text += fmt::format("  {:<16} {:>8} {}\n", set.name, set.factors.size(), set.description);
  }
  if (!model.sources.empty()) text += "\nsources of errors (of a coupling study that names none)\n";
  for (const SourceSet& source : model.sources) text += fmt::format("  {:<16} {}\n", source.name, source.set);
  text += "\nerror factors\n";
  for (const Factor& factor : model.factors) {
    text += fmt::format("  {:<16} {:>8} {}\n", factor.name, si_unit(factor.dimension), factor.description);
  }
  text += places_text(model);
  text += responses_text(model, entry.other_metric != nullptr);
  for (const CatalogEntry* by = entry.other_metric.get(); by != nullptr; by = by->other_metric.get()) {
    text += responses_text(by->description, false);
  }
  if (!model.details.empty()) text += "\ndetails (given by `poesy evaluate`)\n";
  for (const Detail& detail : model.details) {
    text += fmt::format("  {:<20} {:>4} {}\n", detail.name, detail.components.size(), detail.description);
  }
  return text;
}

}  // namespace poesy
