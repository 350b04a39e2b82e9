#include "engine/report/html/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "engine/report/display.h"
#include "engine/report/tables.h"
#include "engine/study/limit_keys.h"

namespace poesy {
namespace {

/// The decision on a yield in words, which precede a sentence: "FAIL, 95 % are asked for: ". Empty if the study asks
/// for no yield.
std::string decision_text(const YieldVerdict& yield) {
  const std::string words = verdict_words(yield);
  return words.empty() ? "" : fmt::format("{}, {} are asked for: ", words, percent_text(yield.asked));
}

}  // namespace

std::vector<std::string> names_of(const std::vector<NamedUnit>& things, std::span<const std::size_t> positions) {
  std::vector<std::string> list;
  for (const std::size_t at : positions) list.push_back(things[at].name);
  return list;
}

std::vector<std::size_t> headline_order(const StoredResult& result) {
  std::vector<std::size_t> order = varying_first(result, result.headline);
  const auto first = std::ranges::find(order, response_named(result, default_ranking(result)));
  if (first != order.end()) std::rotate(order.begin(), first, first + 1);
  return order;
}

std::vector<std::size_t> response_order(const StoredResult& result) {
  std::vector<std::size_t> order = headline_order(result);
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    if (std::ranges::find(result.headline, r) == result.headline.end()) order.push_back(r);
  }
  return varying_first(result, std::move(order));
}

std::vector<std::vector<std::string>> response_units(const StoredResult& result,
                                                     std::span<const std::size_t> responses) {
  std::vector<std::vector<std::string>> units;
  for (const std::size_t r : responses) units.push_back({unit_text(result.responses[r])});
  return units;
}

std::string order_by_effect(bool mixed) {
  return std::string("by their effect, the largest first") +
         (mixed ? "; indices per mm and per deg do not compare" : "");
}

bool mixed_units(const std::vector<NamedUnit>& things) {
  return std::ranges::any_of(things, [&](const NamedUnit& one) { return one.unit != things[0].unit; });
}

std::vector<double> ShownCells::at_poses(std::span<const double> values) const {
  std::vector<double> kept;
  if (poses.empty()) return kept;
  kept.reserve(values.size() / all_poses * poses.size());
  for (std::size_t row = 0; row < values.size(); row += all_poses) {
    for (const std::size_t m : poses) kept.push_back(values[row + m]);
  }
  return kept;
}

std::string ShownCells::note() const {
  std::string text;
  if (responses.size() < all_responses) {
    text += fmt::format("So that the report stays small, its figures by pose show {} of the {} responses. ",
                        responses.size(), all_responses);
  }
  if (thinned()) {
    text += fmt::format(
        "So that the report stays small, its figures by pose show {} of the {} poses, evenly spread over their order; "
        "tables and indices are of all. ",
        count_text(poses.size()), count_text(all_poses));
  }
  if (!text.empty()) text += "The result file and 'poesy export' have everything.";
  return text;
}

ShownCells shown_cells(const StoredResult& result, std::size_t rows,
                       std::optional<std::vector<std::size_t>> responses) {
  rows = std::max<std::size_t>(rows, 1);
  ShownCells shown;
  shown.responses = responses ? *responses : response_order(result);
  shown.all_responses = shown.responses.size();
  shown.all_poses = result.poses.size();
  const bool all = rows * shown.all_poses * shown.all_responses <= ShownCells::kMostWithAllResponses;
  if (!all && !responses) shown.responses = headline_order(result);
  const std::size_t layers = std::max<std::size_t>(shown.responses.size(), 1);
  const std::size_t most =
      std::max<std::size_t>(1, std::min(ShownCells::kMostInLayer / rows, ShownCells::kMost / (rows * layers)));
  const std::size_t kept = std::min(shown.all_poses, most);
  for (std::size_t n = 0; n < kept; ++n) shown.poses.push_back(n * shown.all_poses / kept);
  return shown;
}

PoseFigures::PoseFigures(const StoredResult& result, ShownCells shown, Page& page)
    : result_(result), page_(page), shown_(std::move(shown)) {}

void PoseFigures::add_note(Section& section) const {
  if (const std::string note = shown_.note(); !note.empty()) section.paragraph(note);
}

ArrayName PoseFigures::add(const std::string& name, std::span<const double> values, double unit) const {
  return page_.figures.pool.add(name, shown_.at_poses(values), unit);
}

ArrayName PoseFigures::add(const std::string& name, std::span<const double> values, const NamedUnit& response) const {
  return add(name, values, display(response).si);
}

Coordinate PoseFigures::time_axis() const { return {"time", "s", add("axis_time", result_.time)}; }

Coordinate PoseFigures::number_axis() const {
  const std::vector<double> numbers(shown_.poses.begin(), shown_.poses.end());
  return {"pose number", "", page_.figures.pool.add("axis_number", numbers)};
}

ArrayName PoseFigures::numbers() const { return shown_.thinned() ? number_axis().value : ArrayName(); }

std::vector<Coordinate> PoseFigures::coordinates() const {
  std::vector<Coordinate> list;
  for (std::size_t c = 0; c < result_.pose_coordinates.size(); ++c) {
    const NamedUnit& named = result_.pose_coordinates[c];
    list.push_back({named.name, unit_text(named), add(fmt::format("pose/{}", c), result_.poses.column(c), named)});
  }
  return list;
}

Coordinate PoseFigures::axis() const { return result_.time.empty() ? number_axis() : time_axis(); }

HeatMap PoseFigures::heat_map(std::vector<HeatLayer> layers, std::vector<std::string> rows, std::string order) const {
  std::vector<Coordinate> columns = coordinates();
  if (!result_.time.empty()) columns.push_back(time_axis());
  return {std::move(layers), std::move(rows), "pose", std::move(columns), numbers(), std::move(order)};
}

void PoseFigures::add_condition(std::vector<Field>& fields) const {
  fields.push_back({"condition number of the pose", "", add("condition", result_.condition)});
}

Field PoseFigures::not_converged(std::span<const double> shares) const {
  return {"not converged", "%", add("not_converged_poses", shares, 0.01)};
}

void PoseFigures::add_workspace(Section& section, std::vector<Field> fields, std::string_view caption,
                                const std::string& key) const {
  add_figure(page_, section, key, WorkspaceMap{coordinates(), std::move(fields), numbers()}, caption);
}

EstimateCourse with_ends(EstimateCourse course) {
  if (course.half_width.empty()) return course;
  course.ci_low = course.ci_high = course.value;
  for (std::size_t at = 0; at < course.value.size(); ++at) {
    course.ci_low[at] -= course.half_width[at];
    course.ci_high[at] += course.half_width[at];
  }
  return course;
}

Series series_of(const EstimateCourse& course, std::size_t at, double unit, std::string label, const std::string& array,
                 ArrayPool& pool) {
  const std::size_t numbers = course.samples.size();
  const auto add = [&](const std::string& suffix, const std::vector<double>& all) {
    return pool.add(array + suffix, std::span(all).subspan(at * numbers, numbers), unit);
  };
  return {std::move(label), add("", course.value), add("_low", course.ci_low), add("_high", course.ci_high)};
}

Lines over_samples(const EstimateCourse& course, ArrayPool& pool) {
  const std::vector<double> samples(course.samples.begin(), course.samples.end());
  return {.x = {"samples at each pose", "", pool.add("axis_samples", samples)}, .panels = {}, .log = true};
}

Section& add_how_sure(Page& page, std::string heading, double conf_level) {
  return page.add_section("how-sure", std::move(heading))
      .paragraph(
          fmt::format("Intervals are {} ones and speak of the samples alone: other poses, other sizes of errors, and "
                      "samples that did not converge are not in them.",
                      percent_text(conf_level)));
}

std::vector<Mark> limit_marks(const StoredResult& result, std::size_t response, bool has_negative) {
  const LimitVerdict* verdict = verdict_on(result, response);
  if (verdict == nullptr) return {};
  const ValueLimit& limit = verdict->limit;
  if (limit.is_spread()) return {};
  const double si = display(result.responses[response]).si;
  std::vector<Mark> marks;
  if (std::isfinite(limit.to())) marks.push_back({"limit", limit.to() / si, "above"});
  if (std::isfinite(limit.from()) && has_negative) marks.push_back({"limit", limit.from() / si, "below"});
  return marks;
}

std::string as_sentence(std::string clause) {
  if (!clause.empty()) clause.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(clause.front())));
  return clause + ".";
}

std::string limits_text(const StoredResult& result) {
  if (!result.verdicts) return {};
  if (const std::optional<YieldVerdict>& yield = result.verdicts->yield) {
    return fmt::format("{}{} of {} are within all limits at all poses ({} interval {} to {}).", decision_text(*yield),
                       percent_text(yield->value), counted(yield->machines, "machine", "machines"),
                       percent_text(yield->conf_level), percent_text(yield->ci_low), percent_text(yield->ci_high));
  }
  std::string text;
  for (const LimitVerdict& one : result.verdicts->limits) {
    const NamedUnit& response = result.responses[one.response];
    text += fmt::format("{}{} {} its limit of {}{} with {}{}.", text.empty() ? "" : " ", response.name,
                        one.passed ? "keeps" : "does not keep",
                        limit_text(one.limit, [&](double value) { return response_text(response, value); }),
                        judged_text(*result.verdicts), response_text(response, one.value),
                        not_within_text(*result.verdicts, one));
  }
  return text;
}

void add_limits(std::span<const Table> tables, Page& page) {
  for (const char* name : {"yield", "limits"}) {
    if (std::ranges::find(tables, name, &Table::name) == tables.end()) continue;
    page.sections.emplace_front("limits", "Are the limits kept").table(tables, name);
  }
}

void add_figure(Page& page, Section& section, const std::string& key, Figure figure, std::string_view caption) {
  page.figures.figures.emplace(key, std::move(figure));
  section.figure(key, caption);
}

}  // namespace poesy
