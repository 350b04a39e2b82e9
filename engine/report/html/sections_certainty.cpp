#include <fmt/format.h>

#include <cmath>

#include "engine/report/display.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/sections.h"
#include "engine/report/ranking.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

/// With the ends of its intervals also where it states half-widths.
EstimateCourse with_ends(EstimateCourse course) {
  if (course.half_width.empty()) return course;
  course.ci_low = course.ci_high = course.value;
  for (std::size_t at = 0; at < course.value.size(); ++at) {
    course.ci_low[at] -= course.half_width[at];
    course.ci_high[at] += course.half_width[at];
  }
  return course;
}

std::optional<EstimateCourse> course_of(const StoredResult& result) {
  const bool indices = result.kind == "sensitivity";
  const auto& adaptive = indices ? result.sensitivity.convergence : result.monte_carlo.convergence;
  if (adaptive) return with_ends(adaptive->course);
  return indices ? result.sensitivity.history : std::nullopt;
}

/// The curve of one quantity with its band, in the unit shown.
Series series_of(const EstimateCourse& course, std::size_t at, double scale, std::string label,
                 const std::string& array, ArrayPool& pool) {
  const std::size_t numbers = course.samples.size();
  const auto add = [&](std::string_view suffix, const std::vector<double>& all) {
    return pool.add(array + std::string(suffix), std::span(all).subspan(at * numbers, numbers), 1.0 / scale);
  };
  return {std::move(label), add("", course.value), add("_low", course.ci_low), add("_high", course.ci_high)};
}

/// Of a sensitivity result, effects in the order of importance; of a Monte Carlo result the overall mean.
Panel panel_of(const StoredResult& result, const EstimateCourse& course, std::size_t r, ArrayPool& pool) {
  const NamedUnit& response = result.responses[r];
  const double unit = display(response).si;
  const std::string array = fmt::format("samples/{}", r);
  Panel panel{response.name, unit_text(response), {}};
  if (result.kind != "sensitivity") {
    panel.series.push_back(series_of(course, r, 1.0 / unit, "all errors together", array, pool));
    return panel;
  }
  for (const std::size_t p : ranked_errors(result, response.name).rows) {
    const std::size_t at = r * result.factors.size() + p;
    if (!has_effect(result, r, p)) continue;
    panel.series.push_back(series_of(course, at, result.factor_sigma[p] / unit, result.factors[p].name,
                                     fmt::format("{}/{}", array, p), pool));
  }
  return panel;
}

Lines lines_of(const StoredResult& result, const EstimateCourse& course, ArrayPool& pool) {
  const std::vector<double> samples(course.samples.begin(), course.samples.end());
  Lines lines{.x = {"samples at each pose", "", pool.add("axis_samples", samples)}, .panels = {}, .log = true};
  for (const std::size_t r : headline_order(result)) lines.panels.push_back(panel_of(result, course, r, pool));
  return lines;
}

constexpr std::string_view kAtTheUpperEnd =
    "The curves are of the published estimator. Where poses differ by little more than chance it is at the upper end "
    "of its interval, because chance adds to the spread between poses; more samples close the gap.";

/// Why there is no course, and what gives one.
constexpr std::string_view kNoCourseOfIndices =
    "An older poesy wrote this result, which did not keep how its indices settled with the number of samples. Run the "
    "study again, and its report shows it.";
constexpr std::string_view kNoCourseOfMeans =
    "With a fixed number of samples a Monte Carlo study does not keep how its means settled. One with adaptive samples "
    "does: samples = { min = .., max = .., relative_error = .. } under [analysis].";

}  // namespace

void add_limits(std::vector<Table>& tables, Page& page) {
  for (const Table& table : take_tables(tables, std::vector<std::string_view>{"limits"})) {
    Section section("limits", "Are the limits kept");
    section.table(table);
    page.sections.push_back(std::move(section));
  }
}

void add_certainty(const StoredResult& result, std::vector<Table>& tables, Page& page) {
  const bool indices = result.kind == "sensitivity";
  Section section("how-sure", indices ? "How sure are the indices" : "How sure are the means");
  section.paragraph(
      fmt::format("Intervals are {} ones and speak of the samples alone: other poses, other sizes of errors, and "
                  "samples that did not converge are not in them.",
                  percent_text(indices ? result.sensitivity.conf_level : result.monte_carlo.conf_level)));
  if (const std::optional<EstimateCourse> course = course_of(result)) {
    section.paragraph(
        indices ? "What a study with fewer samples would have found: curves that have become flat, with narrow bands, "
                  "would not change with more. Effects are index x sigma; errors without effect are left out."
                : "The mean over the samples of all poses after so many samples, with its interval.");
    add_figure(page, section, "convergence", lines_of(result, *course, page.figures.pool),
               indices ? "The effect of each error by the published estimator over the number of samples, with its "
                         "interval."
                       : "The overall mean over the number of samples, with its interval.");
    if (indices) section.paragraph(kAtTheUpperEnd);
  } else {
    section.paragraph(indices ? kNoCourseOfIndices : kNoCourseOfMeans);
  }
  for (const Table& table : take_tables(tables, std::vector<std::string_view>{"convergence"})) section.table(table);
  page.sections.push_back(std::move(section));
}

}  // namespace poesy
