#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <span>

#include "engine/kinds/sensitivity/answer.h"
#include "engine/kinds/sensitivity/fidelity.h"
#include "engine/kinds/sensitivity/figures.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/kind.h"
#include "engine/kinds/sensitivity/linearity.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/sensitivity/separation.h"
#include "engine/kinds/sensitivity/tolerances.h"
#include "engine/report/display.h"
#include "engine/report/sources.h"
#include "engine/stats/indices.h"
#include "engine/stats/tolerance.h"

namespace poesy::sensitivity {
namespace {

/// An interval is called wide if one of its ends is farther from the index than this share of the index.
constexpr double kWideInterval = 0.10;

constexpr std::string_view kCorrected =
    "The published estimator counts the noise of sampling as spread between poses; the value shown is without that "
    "noise, and 'published' in the table is with it.";

BarQuantity bar_quantity(const StoredResult& result, bool as_effect, ArrayPool& pool) {
  const GlobalIndices shown = shown_indices(result);
  const std::string name = as_effect ? "global_effect" : "global_index";
  const auto add = [&](const std::string& suffix, const Result::Indices& indices) {
    return pool.add(name + suffix, in_shown_units(result, indices, as_effect));
  };
  return {as_effect ? "effect at the size the study sets (index x sigma)" : "global index",
          units_of_indices(result, as_effect), add("", shown.value), add("_low", shown.low), add("_high", shown.high)};
}

void add_which_errors_matter(const StoredResult& result, std::span<const Table> tables, Page& page) {
  Section& section = page.add_section("which-errors-matter", "Which errors matter");
  section.paragraph(fmt::format(
      "The global index of an error is the scatter of a response for each unit of scatter of the error, its mean over "
      "the {} plus its spread between them. Times the size that the study gives the error it is the effect, which "
      "compares lengths with angles. Bars end at the value; the thin lines are {:.3g} % intervals. {}",
      counted(result.poses.size(), "pose", "poses"), 100.0 * sensitivity_of(result).conf_level, kCorrected));
  if (const std::string text = few_matter_text(result); !text.empty()) section.paragraph(text);
  Bars bars{{{"response", names_of(result.responses, response_order(result))}},
            {bar_quantity(result, true, page.figures.pool), bar_quantity(result, false, page.figures.pool)},
            names_of(result.factors)};
  add_figure(page, section, "ranking", std::move(bars),
             "The errors " + order_by_effect(mixed_units(result.factors)) + ".");
  section.table(tables, "ranked");
}

/// The numbers at all poses of the errors in `rows`, one error after the other.
std::vector<double> in_order(const ErrorCells& cells, std::span<const std::size_t> rows) {
  std::vector<double> list;
  list.reserve(cells.size());
  for (const std::size_t row : rows) std::ranges::copy(cells.row(row), std::back_inserter(list));
  return list;
}

/// Layers of a heat map: effects, and shares of samples that did not converge. The heat map has a row for each error,
/// in the order of `rows`, and a column for each pose.
std::vector<HeatLayer> layers(const StoredResult& result, std::span<const std::size_t> rows,
                              const PoseFigures& figures) {
  std::vector<HeatLayer> list;
  for (const std::size_t r : figures.responses()) {
    const NamedUnit& response = result.responses[r];
    list.push_back({"effect on " + response.name, unit_text(response),
                    figures.add(fmt::format("effect/{}", r), in_order(local_effects(result, r), rows), response)});
  }
  const ErrorCells failed({result.factors.size(), result.poses.size()}, sensitivity_tally(result).shares());
  list.push_back({"not converged", "%", figures.add("not_converged", in_order(failed, rows), 0.01)});
  return list;
}

/// Curves of the local effects over the time of a trajectory; those of the most important errors come first.
Lines along_trajectory(const StoredResult& result, const PoseFigures& figures) {
  Lines lines{.x = figures.axis(), .panels = {}};
  for (const std::size_t r : figures.responses()) {
    const NamedUnit& response = result.responses[r];
    Panel panel{response.name, unit_text(response), {}};
    const ErrorCells effects = local_effects(result, r);
    for (const std::size_t p : ranked_errors(result, response.name).rows) {
      panel.series.push_back(
          {result.factors[p].name, figures.add(fmt::format("curve/{}/{}", r, p), effects.row(p), response)});
    }
    lines.panels.push_back(std::move(panel));
  }
  return lines;
}

/// A sentence on the pose coordinate with which the combined effect of all errors grows or falls. Empty if no
/// correlation is as large as kClearCorrelation.
std::string trend_text(const StoredResult& result) {
  const std::size_t r = response_named(result, default_ranking(result));
  const auto order = explaining_order(result, root_sum_squares(local_effects(result, r)));
  if (!order || !(std::abs(order->correlation) >= kClearCorrelation)) return {};
  return fmt::format(
      "The effect of all errors on {}, the root sum square of theirs, {} with {}: their rank correlation over the "
      "poses "
      "is {:.2f}.",
      result.responses[r].name, order->correlation > 0.0 ? "grows" : "falls", order->name(result), order->correlation);
}

void add_where(const StoredResult& result, Page& page) {
  const PoseFigures figures(result, sensitivity_cells(result), page);
  const RankedErrors ranked = ranked_errors(result, default_ranking(result));
  const std::vector<std::string> errors = names_of(result.factors, ranked.rows);
  Section& section = page.add_section("where", "Where in the workspace");
  section.paragraph(
      "The effect of each error at each pose: its local index there times the size that the study gives it. The last "
      "layer is the share of samples that did not converge.");
  for (const std::string& text : {trend_text(result), worst_place_text(result)}) {
    if (!text.empty()) section.paragraph(text);
  }
  figures.add_note(section);
  if (!result.time.empty()) {
    add_figure(page, section, "trajectory", along_trajectory(result, figures),
               "The effect of each error along the trajectory.");
  }
  const std::vector<HeatLayer> shown = layers(result, ranked.rows, figures);
  add_figure(
      page, section, "heat",
      figures.heat_map(shown, errors, first_order(result, local_effects(result, ranked.response))),
      "A row for each error, the most important first, a column for each pose. Choose above in which order poses "
      "stand.");
  std::vector<Field> fields;
  for (const HeatLayer& layer : shown) fields.push_back({layer.label, layer.unit, layer.value, errors});
  figures.add_condition(fields);
  figures.add_workspace(section, std::move(fields));
}

/// The estimates of the global indices after increasing numbers of samples.
EstimateCourse course_of(const StoredResult& result) {
  return result.convergence ? with_ends(result.convergence->course) : sensitivity_of(result).history.value();
}

/// Curves of the effect of each error on each response over the number of samples, most important error first.
Lines effects_over_samples(const StoredResult& result, const EstimateCourse& course, ArrayPool& pool) {
  Lines lines = over_samples(course, pool);
  for (const std::size_t r : headline_order(result)) {
    const NamedUnit& response = result.responses[r];
    Panel panel{response.name, unit_text(response), {}};
    for (const std::size_t p : ranked_errors(result, response.name).rows) {
      if (!has_effect(result, r, p)) continue;
      panel.series.push_back(series_of(course, r * result.factors.size() + p,
                                       1.0 / (result.factor_sigma[p] / display(response).si), result.factors[p].name,
                                       fmt::format("samples/{}/{}", r, p), pool));
    }
    lines.panels.push_back(std::move(panel));
  }
  return lines;
}

void add_how_sure(const StoredResult& result, std::span<const Table> tables, Page& page) {
  Section& section = add_how_sure(page, "How sure are the indices", sensitivity_of(result).conf_level);
  const EstimateCourse course = course_of(result);
  if (course.samples.size() < 2) {
    section.paragraph("With so few samples there is no smaller study to show how indices settle.");
  } else {
    section.paragraph(
        "What a study with fewer samples would have found: curves that have become flat, with narrow bands, would not "
        "change with more. Effects are index x sigma; errors without effect are left out.");
    add_figure(page, section, "convergence", effects_over_samples(result, course, page.figures.pool),
               "The effect of each error by the published estimator over the number of samples, with its interval.");
    section.paragraph(
        "The curves are of the published estimator. Where poses differ by little more than chance it is at the upper "
        "end of its interval, because chance adds to the spread between poses; more samples close the gap.");
  }
  section.table(tables, "convergence");
}

void warn_of_unknown_indices(const StoredResult& result, std::vector<std::string>& list) {
  const Result& found = sensitivity_of(result);
  std::vector<std::string> unknown;
  for (std::size_t p = 0; p < found.factors(); ++p) {
    bool known = true;
    for (std::size_t r = 0; r < found.responses(); ++r) known = known && !std::isnan(found.global(r, p));
    if (!known) unknown.push_back(result.factors[p].name);
  }
  const auto cells = std::ranges::count_if(found.count.row(0), [](std::uint64_t count) { return count < 2; });
  if (cells == 0 && unknown.empty()) return;
  std::string text =
      fmt::format("{} (an error at a pose) fewer than two samples that count, so no index is known there.",
                  cells == 1 ? "1 cell has" : fmt::format("{} cells have", cells));
  if (!unknown.empty()) text += " Without a global index therefore: " + some_names(unknown) + ".";
  list.push_back(text);
}

void warn_of_small_errors(const StoredResult& result, std::vector<std::string>& list) {
  std::vector<std::string> small;
  const GlobalIndices shown = shown_indices(result);
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    const auto is_small = [&](std::size_t r) {
      return is_too_small_to_tell(shown.value(r, p), index_rounding(result, r, p));
    };
    if (std::ranges::any_of(result.headline, is_small)) small.push_back(result.factors[p].name);
  }
  if (small.empty()) return;
  list.push_back(
      fmt::format("{} so small in this study that an effect cannot be told from the rounding of the solves: "
                  "{}. Study larger errors.",
                  counted(small.size(), "error is", "errors are"), some_names(small)));
}

/// Warns of errors whose indices change with their size, unless they hardly contribute to the mean square.
void warn_of_sizes(const StoredResult& result, std::vector<std::string>& list) {
  const std::size_t response = response_named(result, default_ranking(result));
  const MeanSquare square =
      mean_square(response_study(sensitivity_of(result), result.factor_sigma, result.factor_mean, response));
  const std::vector<std::size_t> negligible =
      negligible_errors(result, response, square, square.growth(result.factor_sigma));
  if (changing_errors(result, response).size() == negligible.size()) return;
  list.push_back(fmt::format("Some indices say something about the size of the errors in this study and no other: {}.",
                             index_change_text(result, response, negligible)));
}

void warn_of_wide_intervals(const StoredResult& result, std::vector<std::string>& list) {
  const Result& found = sensitivity_of(result);
  const GlobalIndices shown = shown_indices(result);
  std::size_t wide = 0;
  std::size_t all = 0;
  double widest = 0.0;
  std::size_t response = 0;
  std::size_t factor = 0;
  for (const std::size_t r : result.headline) {
    for (std::size_t p = 0; p < found.factors(); ++p) {
      if (!has_effect(result, r, p)) continue;
      ++all;
      const double relative = relative_reach(shown, r, p);
      if (!(relative > kWideInterval)) continue;
      ++wide;
      if (!(relative > widest)) continue;
      widest = relative;
      response = r;
      factor = p;
    }
  }
  if (wide == 0) return;
  list.push_back(
      fmt::format("{} of {} indices have a {:.3g} % interval that reaches more than 10 % away from the index; the "
                  "widest is that of {} on {}, {}. More samples make them narrower.",
                  wide, all, 100.0 * found.conf_level, result.factors[factor].name, result.responses[response].name,
                  percent_text(widest)));
}

std::vector<double> rms_at_poses(const StoredResult& result, std::size_t response) {
  const Result& found = sensitivity_of(result);
  ErrorCells effects({found.factors(), found.poses()});
  for (std::size_t p = 0; p < found.factors(); ++p) {
    for (std::size_t m = 0; m < found.poses(); ++m) {
      effects(p, m) = found.local(response, p, m) * result.factor_sigma[p];
    }
  }
  return root_sum_squares(effects);
}

/// The share of each error in the mean square, and the combined effect of all errors at each pose.
ErrorShares error_shares(const StoredResult& result) {
  if (result.factors.empty() || result.poses.size() == 0) return {};
  const std::size_t r = response_named(result, default_ranking(result));
  if (!varies(result, r)) return {};
  const std::string& response = result.responses[r].name;
  const MeanSquare found =
      mean_square(response_study(sensitivity_of(result), result.factor_sigma, result.factor_mean, r));
  return {.what = "share of the mean square of " + response,
          .values = mean_square_shares(found, result.factor_sigma),
          .pose_what = "the effect of all errors on " + response,
          .at_poses = root_sum_squares(local_effects(result, r))};
}

Settling settling(const StoredResult& result) {
  return {"global indices", names_of(result.factors), positions(result.responses.size())};
}

void warn(const StoredResult& result, std::vector<std::string>& list) {
  warn_of_unknown_indices(result, list);
  warn_of_small_errors(result, list);
  warn_of_sizes(result, list);
  if (std::string text = not_settled_text(result, settling(result)); !text.empty()) list.push_back(std::move(text));
  warn_of_wide_intervals(result, list);
}

void add_page(const StoredResult& result, std::span<const Table> tables, Page& page) {
  add_which_errors_matter(result, tables, page);
  add_where(result, page);
  add_how_sure(result, tables, page);
  add_tolerance_section(result, page);
  add_separation_section(result, tables, page);
  add_fidelity_section(result, tables, page);
}

MethodWords method(const StoredResult&) {
  return {
      "The index of an error is the standard deviation of the response over that of the error while only this error "
      "varies; indices over the workspace are the mean of the poses' indices plus their standard deviation, "
      "without the noise of sampling, and have intervals by the method of Zou and Donner. The effect of an error is "
      "its index times its standard deviation.",
      {kDu, kZouDonner}};
}

}  // namespace

constinit const ReportKind kReport{.tally = sensitivity_tally,
                                   .tables = sensitivity_tables,
                                   .two_rankings = two_rankings,
                                   .merits = sensitivity_merits,
                                   .sorts = true,
                                   .settling = settling,
                                   .words = [](const StoredResult&) { return StudyWords{.draws = true}; },
                                   .method = method,
                                   .warn = warn,
                                   .answer = sensitivity_answer,
                                   .shown_cells = sensitivity_cells,
                                   .page = add_page,
                                   .error_shares = error_shares,
                                   .rms_at_poses = rms_at_poses,
                                   .comparable = comparable_sensitivity,
                                   .compare = compare_sensitivity};

}  // namespace poesy::sensitivity
