#include "engine/report/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "engine/report/coupling_table.h"
#include "engine/report/display.h"
#include "engine/stats/tolerance.h"

namespace poesy {
namespace {

/// The responses worth a column: `first`, and those of the headline that have a dimension.
std::vector<std::size_t> shown_responses(const StoredResult& result, std::size_t first) {
  std::vector<std::size_t> shown{first};
  for (const std::size_t r : result.headline) {
    if (r != first && dimension_of(result.responses[r].unit) != Dimension::number) shown.push_back(r);
  }
  return shown;
}

std::string number(double value, double scale) {
  if (std::abs(value) < kIndexRounding) return fmt::format("{:>8}", "0");
  return fmt::format("{:>8.4g}", value * scale);
}

std::string index_cell(const SensitivityResult& s, std::size_t row, double scale) {
  if (std::isnan(s.global[row])) return fmt::format("{:>8} {:<21}", "-", "");
  const std::string interval =
      fmt::format("[{},{}]", number(s.global_ci_low[row], scale), number(s.global_ci_high[row], scale));
  return fmt::format("{} {:<21}", number(s.global[row], scale), interval);
}

double share_not_converged(const SensitivityResult& s, std::size_t factor) {
  SolveCounts solves;
  for (std::size_t m = 0; m < s.poses; ++m) solves.merge(s.solves[factor * s.poses + m]);
  return solves.total() == 0 ? 0.0 : static_cast<double>(solves.not_converged()) / static_cast<double>(solves.total());
}

std::string chart_text(const PoseChart& chart) {
  std::string text = fmt::format("\nposes may be given by {}\n", chart.name);
  for (const PoseCoordinate& coordinate : chart.coordinates) {
    text += fmt::format("  {:<16} {:>8} {}\n", coordinate.name, si_unit(coordinate.dimension), coordinate.description);
  }
  return text;
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

SolveCounts all_solves(const StoredResult& result) {
  if (result.kind == "sensitivity") return result.sensitivity.total();
  if (result.kind == "identification") return result.identification.solves;
  if (result.kind == "monte-carlo") return result.monte_carlo.total();
  if (result.kind == "coupling") return result.coupling.found.total();
  return result.evaluation.total();
}

}  // namespace

std::size_t response_named(const StoredResult& result, std::string_view name) {
  const auto found = std::find_if(result.responses.begin(), result.responses.end(),
                                  [&](const NamedUnit& response) { return response.name == name; });
  return static_cast<std::size_t>(found - result.responses.begin());
}

std::vector<std::size_t> ranking(const StoredResult& result, std::size_t response) {
  const SensitivityResult& s = result.sensitivity;
  std::vector<std::size_t> order(s.factors);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t p) {
    const double spread = s.global[response * s.factors + p] * result.factor_sigma[p];
    return std::isnan(spread) ? -1.0 : spread;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) > key(b); });
  return order;
}

std::string count_text(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, " ");
  return digits;
}

std::string summary_text(const StoredResult& result) {
  const SolveCounts solves = all_solves(result);
  const double share = solves.total() == 0
                           ? 0.0
                           : 100.0 * static_cast<double>(solves.not_converged()) / static_cast<double>(solves.total());
  std::string text;
  if (!result.title.empty()) text += result.title + "\n";
  text += fmt::format("{} of {}: {} poses, poesy {}\n", result.kind, result.model, result.poses.size(),
                      result.poesy_version);
  text += fmt::format("{} solves in {:.2f} s on {} threads: {} solves/s\n", count_text(result.facts.solves),
                      result.facts.wall_seconds, result.facts.threads,
                      count_text(static_cast<std::uint64_t>(
                          std::llround(static_cast<double>(result.facts.solves) /
                                       std::max(result.facts.wall_seconds, std::numeric_limits<double>::min())))));
  text += fmt::format("{} solves ({:.3g} %) did not converge\n", count_text(solves.not_converged()), share);
  return text;
}

std::string default_ranking(const StoredResult& result) {
  for (const std::size_t r : result.headline) {
    if (dimension_of(result.responses[r].unit) == Dimension::length) return result.responses[r].name;
  }
  return result.headline.empty() ? std::string() : result.responses[result.headline.front()].name;
}

std::string ranked_table(const StoredResult& result, std::string_view ranked_by) {
  const SensitivityResult& s = result.sensitivity;
  const std::vector<std::size_t> shown = shown_responses(result, response_named(result, ranked_by));
  std::string text = fmt::format(
      "Global sensitivity indices with {1:.3g} % intervals, ranked by the spread of {0} that each error causes\n",
      ranked_by, 100.0 * s.conf_level);
  text += fmt::format("{:>4}  {:<16}", "rank", "error");
  for (const std::size_t r : shown) {
    text +=
        fmt::format("  {:<38}", fmt::format("{} [{}/..]", result.responses[r].name, display(result.responses[r]).name));
  }
  text += "  not converged\n";
  std::size_t rank = 0;
  for (const std::size_t p : ranking(result, shown.front())) {
    const Unit& factor_unit = display(result.factors[p]);
    text += fmt::format("{:>4}  {:<16}", ++rank, result.factors[p].name);
    for (const std::size_t r : shown) {
      const Unit& unit = display(result.responses[r]);
      text += fmt::format("  {} {:<7}", index_cell(s, r * s.factors + p, factor_unit.si / unit.si),
                          fmt::format("{}/{}", unit.name, factor_unit.name));
    }
    text += fmt::format("  {:>10.3g} %\n", 100.0 * share_not_converged(s, p));
  }
  return text;
}

std::string evaluation_table(const StoredResult& result) {
  const EvaluationResult& e = result.evaluation;
  std::string text =
      fmt::format("{:<22} {:>6} {:>13} {:>13} {:>13}\n", "response", "unit", "mean", "smallest", "largest");
  const std::size_t all = e.poses * e.samples;
  for (const std::size_t r : result.headline) {
    double sum = 0.0;
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    std::size_t count = 0;
    for (std::size_t n = 0; n < all; ++n) {
      if (!solved(e.status[n])) continue;
      const double value = e.response[r * all + n];
      sum += value;
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
      ++count;
    }
    const Unit& unit = display(result.responses[r]);
    text += fmt::format("{:<22} {:>6}", result.responses[r].name, unit.name);
    if (count == 0) {
      text += fmt::format(" {:>13}\n", "none solved");
      continue;
    }
    text += fmt::format(" {:>13.6g} {:>13.6g} {:>13.6g}\n", sum / static_cast<double>(count) / unit.si,
                        lowest / unit.si, highest / unit.si);
  }
  return text;
}

std::string result_tables(const StoredResult& result, std::string_view ranked_by) {
  if (result.kind == "sensitivity") {
    return ranked_table(result, ranked_by) + separation_table(result, ranked_by) + fidelity_table(result, ranked_by) +
           convergence_table(result);
  }
  if (result.kind == "identification") return identification_table(result);
  if (result.kind == "monte-carlo") return monte_carlo_table(result) + convergence_table(result);
  if (result.kind == "coupling") return coupling_table(result);
  return result.cases.empty() ? evaluation_table(result) : cases_table(result);
}

std::string models_text(const Catalog& catalog) {
  std::string text;
  for (const CatalogEntry& entry : catalog) {
    text += fmt::format("{:<12} {}\n", entry.description.name, entry.description.title);
  }
  return text;
}

std::string model_text(const ModelDescription& model) {
  std::string text = fmt::format("{}: {}\n\ngeometry (change it in [mechanism] geometry)\n", model.name, model.title);
  for (const GeometryParameter& parameter : model.geometry) {
    const Unit& unit = display_unit(parameter.dimension);
    text += fmt::format("  {:<16} {:>8.6g} {:<4} {}\n", parameter.name, parameter.published / unit.si, unit.name,
                        parameter.description);
  }
  if (!model.fidelities.empty()) {
    text += "\nfidelity (choose it in [mechanism]; the first is the default)\n";
    for (const std::string& fidelity : model.fidelities) text += "  " + fidelity + "\n";
  }
  text += "\npose coordinates and default workspace\n";
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    const Unit& unit = coordinate.dimension == Dimension::angle ? units()[3] : display_unit(coordinate.dimension);
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
  for (const CouplingSource& source : model.sources) text += fmt::format("  {:<16} {}\n", source.name, source.set);
  text += "\nerror factors\n";
  for (const Factor& factor : model.factors) {
    text += fmt::format("  {:<16} {:>8} {}\n", factor.name, si_unit(factor.dimension), factor.description);
  }
  text += "\nresponses\n";
  for (const Response& response : model.responses) {
    text += fmt::format("  {:<20} {:>4} {}\n", response.name, si_unit(response.dimension), response.description);
  }
  text += "\ndetails (given by `poesy evaluate`)\n";
  for (const Detail& detail : model.details) {
    text += fmt::format("  {:<20} {:>4} {}\n", detail.name, detail.components.size(), detail.description);
  }
  return text;
}

}  // namespace poesy
