#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/kinds/sweep/kind.h"
#include "engine/kinds/sweep/result.h"
#include "engine/report/display.h"
#include "engine/report/merits.h"
#include "engine/report/requirements.h"
#include "engine/report/sources.h"
#include "engine/report/tables.h"

namespace poesy::sweep {
namespace {

constexpr int kDigits = 4;

/// The text with all characters except letters and digits replaced by '_': "root_mean_square_of_gap".
std::string slug(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')); }, '_');
  return text;
}

bool has_numbers(const Result& found, std::size_t key) {
  for (std::size_t d = 0; d < found.designs(); ++d) {
    if (std::isnan(found.number(d, key))) return false;
  }
  return true;
}

bool has_any(std::span<const double> values) {
  return std::ranges::any_of(values, [](double value) { return !std::isnan(value); });
}

/// Whether figure of merit q is estimated from random draws, so that some interval has a width. Without draws, both
/// ends of an interval equal the value.
bool is_by_chance(const Result& found, std::size_t q) {
  for (std::size_t d = 0; d < found.designs(); ++d) {
    if (found.low(q, d) < found.high(q, d)) return true;
  }
  return false;
}

std::string value_text(const Result& found, std::size_t q, double value) {
  const std::string& unit = found.quantity_unit(q);
  if (unit == "%") return percent_text(value / 100.0);
  return number_text(value, kDigits) + (unit.empty() ? "" : " " + unit);
}

std::string unit_of_change(const Result& found, std::size_t q) {
  const std::string& unit = found.quantity_unit(q);
  return unit == "%" ? " percentage points" : unit.empty() ? "" : " " + unit;
}

/// The topic of designs that leave out different shares of the workspace.
constexpr std::string_view kOtherPoses = "poses";

/// Whether designs d and e are judged at different poses because they leave out different shares of the workspace.
bool leave_out_otherwise(const Result& found, std::size_t d, std::size_t e) {
  if (found.left_out.empty() || (found.has_first_poses(d) != 0 && found.has_first_poses(e) != 0)) return false;
  return poesy::leave_out_otherwise(found.left_out(d), found.left_out(e));
}

/// Whether some design leaves out poses of the workspace.
bool some_left_out(const Result& found) {
  return std::ranges::any_of(found.left_out, [](double share) { return !(share <= 0.0); });
}

/// Whether some design leaves out another share of the workspace than the first one.
bool some_leave_out_otherwise(const Result& found) {
  for (std::size_t d = 1; d < found.designs(); ++d) {
    if (leave_out_otherwise(found, d, 0)) return true;
  }
  return false;
}

/// The requirement, such as "limits", in which designs d and e differ and on which figure of merit q depends. Empty if
/// there is none; the two designs can then be compared by q.
std::string_view required_otherwise(const Result& found, std::size_t q, std::size_t d, std::size_t e) {
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    const std::string& key = found.keys[k];
    const std::string_view topic = required_by(key, found.quantities[q]);
    const auto required = [&](std::size_t design) { return required_value(key, found.value(design, k)); };
    if (!topic.empty() && required(d) != required(e)) return topic;
  }
  return leave_out_otherwise(found, d, e) ? kOtherPoses : std::string_view();
}

/// The requirement, such as "limits", in which some design differs from the first one and on which figure of merit q
/// depends. Empty if there is none; all designs can then be compared by q.
std::string_view required_otherwise(const Result& found, std::size_t q) {
  for (std::size_t d = 1; d < found.designs(); ++d) {
    if (const std::string_view topic = required_otherwise(found, q, d, 0); !topic.empty()) return topic;
  }
  return {};
}

/// The verdict on a design from the interval of its change from another one: "better", "worse", "equal" if the
/// change is exactly zero, or "not told apart" if the interval includes zero. Empty without an interval.
std::string_view verdict_on_change(double low, double high, bool most_is_best) {
  if (std::isnan(low) || std::isnan(high)) return "";
  if (low == 0.0 && high == 0.0) return "equal";
  if (low <= 0.0 && high >= 0.0) return "not told apart";
  return (low > 0.0) == most_is_best ? "better" : "worse";
}

/// The verdict on design d compared with the first one: that of verdict_on_change(), or a text like "other limits" if
/// the two designs differ in a requirement.
std::string verdict_on_first(const Result& found, std::size_t q, std::size_t d) {
  if (const std::string_view topic = required_otherwise(found, q, d, 0); !topic.empty()) {
    return fmt::format("other {}", topic);
  }
  return std::string(verdict_on_change(found.change_low(q, d), found.change_high(q, d), found.most_is_best(q) != 0));
}

std::string_view verdict_on_best(const Result& found, std::size_t q, std::size_t d) {
  if (d == best_design(found, q)) return "the best";
  return verdict_on_change(found.from_best_low(q, d), found.from_best_high(q, d), found.most_is_best(q) != 0);
}

/// The designs that have this verdict of verdict_on_best().
std::vector<std::size_t> designs_with(const Result& found, std::size_t q, std::string_view verdict) {
  std::vector<std::size_t> list;
  for (std::size_t d = 0; d < found.designs(); ++d) {
    if (verdict_on_best(found, q, d) == verdict) list.push_back(d);
  }
  return list;
}

/// The names of designs in one text: "490, 500 mm" if only one key differs and its values are numbers.
std::string joined_names(const Result& found, std::span<const std::size_t> designs) {
  constexpr std::size_t kMost = 8;
  const bool numbers = found.keys.size() == 1 && has_numbers(found, 0);
  std::vector<std::string> names;
  for (const std::size_t d : designs) {
    names.push_back(numbers ? number_text(found.number(d, 0), 12) : fmt::format("({})", design_name(found, d)));
  }
  return some_names(names, kMost) + (numbers && !found.unit(0).empty() ? " " + found.unit(0) : "");
}

/// A clause on the designs that equal the best one or cannot be distinguished from it: "; not told apart from it: 490,
/// 500 mm". If draws show that all other designs are worse, the clause says so. Otherwise empty.
std::string near_best_clause(const Result& found, std::size_t q) {
  std::string text;
  for (const auto& [verdict, words] :
       {std::pair("equal", "equal to it"), {"not told apart", "not told apart from it"}}) {
    const std::vector<std::size_t> designs = designs_with(found, q, verdict);
    if (!designs.empty()) text += fmt::format("; {}: {}", words, joined_names(found, designs));
  }
  const bool all_are_worse = designs_with(found, q, "worse").size() + 1 == found.designs();
  return is_by_chance(found, q) && all_are_worse ? "; all others are told apart from it" : text;
}

std::string names_of_keys(const Result& found) {
  std::string text;
  for (std::size_t k = 0; k < found.keys.size(); ++k) text += (k == 0 ? "" : " and ") + short_key(found, k);
  return text;
}

/// A figure of merit of a design, with the name of the design: "42.3 % at tip_position = 0.1 mm".
std::string at_design(const Result& found, std::size_t q, std::size_t d) {
  return fmt::format("{} at {}", value_text(found, q, found.merit(q, d)), design_name(found, d));
}

/// A sentence for designs that differ in a requirement: "No design is called best, because the limits differ
/// (tip_position): the yield is 42.3 % at tip_position = 0.1 mm, the first design, and 96.3 % at tip_position = 0.2 mm,
/// the last."
std::string no_best_text(const Result& found, std::size_t q, std::string_view topic) {
  std::vector<std::string> keys;
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    if (required_by(found.keys[k], found.quantities[q]) == topic) keys.push_back(short_key(found, k));
  }
  if (keys.empty()) keys.emplace_back("they leave out different shares of the workspace");
  return fmt::format(
      "No design is called best, because the {} differ ({}): the {} is {}, the first design, and {}, the "
      "last.",
      topic, fmt::join(keys, ", "), found.quantities[q], at_design(found, q, 0),
      at_design(found, q, found.designs() - 1));
}

/// Sentences on the best design: "The yield is largest at R = 375 mm: 78.9 %; not told apart from it: 350 mm. At R =
/// 150 mm, the first design, it is 14.1 %; from there to the best it changes by +64.8 percentage points (interval +63.5
/// to +66.1)."
std::string best_text(const Result& found, std::size_t q) {
  if (const std::string_view topic = required_otherwise(found, q); !topic.empty()) return no_best_text(found, q, topic);
  const std::optional<std::size_t> best = best_design(found, q);
  if (!best) return fmt::format("The {} is not known of any design.", found.quantities[q]);
  std::string text = fmt::format("The {} is {} at {}: {}{}{}.", found.quantities[q],
                                 found.most_is_best(q) != 0 ? "largest" : "smallest", design_name(found, *best),
                                 value_text(found, q, found.merit(q, *best)), *best == 0 ? ", the first design" : "",
                                 near_best_clause(found, q));
  if (*best == 0) return text;
  text += fmt::format(" At {}, the first design, it is {}; from there to the best it changes by {:+.3g}{}",
                      design_name(found, 0), value_text(found, q, found.merit(q, 0)), found.change(q, *best),
                      unit_of_change(found, q));
  if (!std::isnan(found.change_low(q, *best))) {
    text += fmt::format(" (interval {:+.3g} to {:+.3g})", found.change_low(q, *best), found.change_high(q, *best));
  }
  return text + ".";
}

/// A note on what the intervals of changes from the best design do not take into account.
std::string best_note(const Result& found) {
  return fmt::format(
      "against the best: each interval alone has the level {}; the best design was chosen by the same numbers, so its "
      "value tends to be too good",
      percent_text(found.conf_level));
}

std::string interval_note(const Result& found, std::size_t q) {
  const std::string level = percent_text(found.conf_level);
  if (found.is_paired(q) != 0) {
    return fmt::format(
        "low, high: {} intervals; those of a change are paired, because machine n has the same errors in all designs",
        level);
  }
  return fmt::format("low, high: {} intervals; those of a change are as if both designs were drawn independently",
                     level);
}

Cell change_cell(double change) {
  Cell cell = number_cell(change, 3);
  if (change > 0.0) cell.text.insert(0, "+");
  return cell;
}

/// The word that `poesy run` and `poesy show` print for the limits of one design; empty if it has no limits.
std::string_view limits_word(std::string_view verdict) {
  if (verdict == "kept") return "PASS";
  if (verdict == "not kept") return "FAIL";
  return verdict == "undecided" ? "UNDECIDED" : "";
}

FilledColumn key_column(const Result& found, std::size_t k) {
  const std::string name = short_key(found, k);
  if (!has_numbers(found, k)) {
    return {text_column(slug(found.keys[k]), name),
            [&found, k](std::size_t d) { return text_cell(found.value(d, k)); }};
  }
  return {number_column(slug(found.keys[k]), name, found.unit(k)),
          [&found, k](std::size_t d) { return number_cell(found.number(d, k), 12); }};
}

/// True if a table shows changes from the best design: they have intervals, no requirement differs, and there are more
/// than two designs.
bool shows_best(const Result& found, std::size_t q) {
  return found.designs() > 2 && required_otherwise(found, q).empty() && has_any(found.from_best_low.row(q));
}

/// The table of one figure of merit, with a row for each design.
Table quantity_table(const Result& found, std::size_t q) {
  const std::string& unit = found.quantity_unit(q);
  Table table{.name = slug(found.quantities[q]),
              .caption = fmt::format("The {} by {}, and its change from the first{} design", found.quantities[q],
                                     names_of_keys(found), shows_best(found, q) ? " and from the best" : ""),
              .columns = {}};
  std::vector<FilledColumn> columns;
  for (std::size_t k = 0; k < found.keys.size(); ++k) columns.push_back(key_column(found, k));
  const auto number = [&](const std::string& name, const std::string& heading, const Result::Numbers& numbers,
                          int dispensable = 0) {
    columns.push_back({number_column(name, heading, unit, dispensable),
                       [&numbers, q](std::size_t d) { return number_cell(numbers(q, d), kDigits); }});
  };
  const auto change = [&](const std::string& name, const std::string& heading, const Result::Numbers& numbers,
                          int dispensable = 0) {
    columns.push_back({number_column(name, heading, unit == "%" ? "points" : unit, dispensable),
                       [&numbers, q](std::size_t d) { return change_cell(numbers(q, d)); }});
  };
  number("value", "value", found.merit);
  const bool has_intervals = has_any(found.low.row(q));
  if (has_intervals) {
    number("low", "low", found.low, 1);
    number("high", "high", found.high, 1);
  }
  change("change", "change", found.change);
  if (has_intervals) {
    change("change_low", "low", found.change_low);
    change("change_high", "high", found.change_high);
    if (is_by_chance(found, q)) table.notes.push_back(interval_note(found, q));
  }
  const std::string_view topic = required_otherwise(found, q);
  if (has_intervals || !topic.empty()) {
    columns.push_back({text_column("verdict", "against the first"),
                       [&, q](std::size_t d) { return text_cell(verdict_on_first(found, q, d)); }});
  }
  if (some_left_out(found)) {
    columns.push_back(
        {percent_column("left_out", "left out"), [&](std::size_t d) { return percent_cell(found.left_out(d)); }});
    table.notes.emplace_back(
        "left out: share of the workspace's poses that the design does not reach, or that joint limits exclude; - for "
        "an unknown part of a boundary");
  }
  if (some_leave_out_otherwise(found)) {
    table.notes.emplace_back(
        "other poses: designs that leave out different shares of the workspace are judged at different poses, so no "
        "design is called better; take a workspace that all reach");
  } else if (!topic.empty()) {
    table.notes.push_back(fmt::format(
        "other {0}: a {1} under other {0} does not say which design is better; sweep other keys with the same {0}",
        topic, found.quantities[q]));
  }
  if (shows_best(found, q)) {
    change("from_best", "from best", found.from_best);
    change("from_best_low", "low", found.from_best_low, 2);
    change("from_best_high", "high", found.from_best_high, 2);
    columns.push_back({text_column("verdict_on_best", "against the best"),
                       [&, q](std::size_t d) { return text_cell(verdict_on_best(found, q, d)); }});
    if (is_by_chance(found, q)) table.notes.push_back(best_note(found));
  }
  if (std::ranges::any_of(found.verdict.all(), [](const std::string& verdict) { return verdict != "none"; })) {
    columns.push_back(
        {text_column("limits", "limits"), [&](std::size_t d) { return text_cell(limits_word(found.verdict(d))); }});
  }
  fill(table, positions(found.designs()), columns);
  return table;
}

std::vector<Table> sweep_tables(const StoredResult& result, const TableOptions&) {
  const Result& found = sweep_of(result);
  std::vector<Table> tables;
  for (std::size_t q = 0; q < found.quantities.size(); ++q) tables.push_back(quantity_table(found, q));
  tables.back().notes.push_back(
      "The file of the sweep has these figures of each design, not its whole result; the run of a design's own study "
      "writes that, with the same bits (/sweep/content_sha256 says which)");
  return tables;
}

std::vector<std::string> design_names(const Result& found) {
  std::vector<std::string> names;
  for (std::size_t d = 0; d < found.designs(); ++d) names.push_back(design_name(found, d));
  return names;
}

SolveTally tally(const StoredResult& result) {
  const Result& found = sweep_of(result);
  return {"design", design_names(found), 1, found.solves};
}

/// A sentence on how certain it is which design is the best. Empty if the changes have no intervals or are exact, or if
/// designs differ in a requirement.
std::string best_certainty(const Result& found, std::size_t q) {
  const bool is_compared = required_otherwise(found, q).empty() && has_any(found.from_best_low.row(q));
  if (!is_compared || !is_by_chance(found, q)) return {};
  return fmt::format(
      " Each design is compared with the best by an interval that alone has the level {}; the best was chosen after "
      "all were seen, so its value tends to be too good.",
      percent_text(found.conf_level));
}

/// Whether more samples make the interval of figure of merit q narrower. For a yield they do not if errors are drawn
/// from measured parts, because the number of parts limits how well it is known.
bool narrows(const StoredResult& result, const Result& found, std::size_t q) {
  return found.quantities[q] != kYieldMerit ||
         std::ranges::none_of(readable_settings(result.study_text), [](const auto& setting) {
           return setting.first.starts_with("errors.") && setting.second.find("measured") != std::string::npos;
         });
}

/// The keys for which the design has the smallest or the largest number in the sweep.
std::vector<std::string> keys_at_an_end(const Result& found, std::size_t design) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    const double own = found.number(design, k);
    double low = own;
    double high = own;
    for (std::size_t d = 0; d < found.designs(); ++d) {
      low = std::min(low, found.number(d, k));
      high = std::max(high, found.number(d, k));
    }
    if (low < high && (own == low || own == high)) names.push_back(short_key(found, k));
  }
  return names;
}

/// Advice that follows from the best design.
std::string what_to_do(const StoredResult& result, const Result& found, std::size_t q) {
  if (const std::string_view topic = required_otherwise(found, q); !topic.empty()) {
    return fmt::format("Compare designs with the same {}.", topic);
  }
  const std::optional<std::size_t> best = best_design(found, q);
  const std::string_view more = designs_with(found, q, "not told apart").empty() || !narrows(result, found, q)
                                    ? ""
                                    : " To tell the designs apart that are near the best, take more samples.";
  const std::vector<std::string> ends = best ? keys_at_an_end(found, *best) : std::vector<std::string>();
  if (!ends.empty()) {
    return fmt::format("The best design is at an end of {}: look beyond it.{}", fmt::join(ends, " and of "), more);
  }
  return fmt::format("The best design lies within the sweep: look closer around it.{}", more);
}

/// A sentence on how many designs keep the limits; empty if no design is judged by limits.
std::string passes_text(const Result& found) {
  const auto count = [&](std::string_view verdict) { return std::ranges::count(found.verdict.all(), verdict); };
  const std::size_t all = found.designs();
  if (static_cast<std::size_t>(count("not kept")) == all) return fmt::format("All {} designs FAIL.", all);
  if (count("kept") + count("not kept") + count("undecided") == 0) return {};
  const std::string undecided = count("undecided") == 0 ? "" : fmt::format(", {} UNDECIDED", count("undecided"));
  return fmt::format("{} of {} PASS{}.", count("kept"), counted(all, "design", "designs"), undecided);
}

Answer answer(const StoredResult& result) {
  const Result& found = sweep_of(result);
  std::string best = passes_text(found);
  for (std::size_t q = 0; q < found.quantities.size(); ++q) best += (best.empty() ? "" : " ") + best_text(found, q);
  const bool paired = std::ranges::any_of(found.is_paired.all(), [](std::uint8_t is) { return is != 0; });
  const std::string sure = paired
                               ? "All designs have the same machines, so their differences are surer than their values."
                               : "All designs draw the same errors.";
  const std::size_t q = 0;
  return {{"Answer", best},
          {"How sure", sure + best_certainty(found, q)},
          {std::string(kWhatToDo), what_to_do(result, found, q)}};
}

/// Designs as points of curves over the first key, with a curve for each combination of the other keys' values.
struct Grid {
  std::size_t points = 0;  ///< number of values of the first key
  std::size_t curves = 0;  ///< number of combinations of the other keys' values

  explicit Grid(const Result& found) {
    // The last key changes fastest, so the first key keeps its value for as many designs as there are curves.
    const auto is_first = [&](std::size_t d) { return found.value(d, 0) == found.value(0, 0); };
    while (curves < found.designs() && is_first(curves)) ++curves;
    points = found.designs() / curves;
  }
};

std::string curve_name(const Result& found, std::size_t design) {
  std::string text;
  for (std::size_t k = 1; k < found.keys.size(); ++k) {
    text += fmt::format("{}{} = {}", k == 1 ? "" : ", ", short_key(found, k), found.value(design, k));
  }
  return text;
}

/// Draws numbers of all designs as curves, with intervals if there are any.
class Curves {
 public:
  Curves(const Result& found, ArrayPool& pool) : found_(found), grid_(found), pool_(pool) {}

  Coordinate x() const {
    std::vector<double> values(grid_.points);
    const bool numbers = has_numbers(found_, 0);
    for (std::size_t n = 0; n < grid_.points; ++n) {
      values[n] = numbers ? found_.number(n * grid_.curves, 0) : static_cast<double>(n);
    }
    const std::string name = short_key(found_, 0);
    return {numbers ? name : "number of " + name, numbers ? found_.unit(0) : "", pool_.add("swept", values)};
  }
  Panel panel(const std::string& label, const std::string& unit, std::size_t q, const Result::Numbers& value,
              const Result::Numbers& low, const Result::Numbers& high) const {
    Panel panel{label, unit, {}};
    for (std::size_t c = 0; c < grid_.curves; ++c) {
      const std::string name = grid_.curves > 1 ? curve_name(found_, c) : found_.quantities[q];
      const auto add = [&](const char* what, const Result::Numbers& numbers) {
        if (!has_any(numbers.row(q))) return ArrayName();
        return pool_.add(fmt::format("{}/{}/{}/{}", label, what, q, c), curve(numbers.row(q), c));
      };
      panel.series.push_back({name, add("value", value), add("low", low), add("high", high)});
    }
    return panel;
  }

 private:
  std::vector<double> curve(std::span<const double> values, std::size_t c) const {
    // Only values that fill the grid are used, because a damaged file may have more designs.
    const std::span<const double> whole = values.first(grid_.points * grid_.curves);
    const ArrayView<const double, Axis<"point">, Axis<"curve">> grid(whole, {grid_.points, grid_.curves});
    std::vector<double> of_curve;
    for (std::size_t n = 0; n < grid_.points; ++n) of_curve.push_back(grid(n, c));
    return of_curve;
  }

  const Result& found_;
  Grid grid_;
  ArrayPool& pool_;
};

void add_page(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const Result& found = sweep_of(result);
  const Curves curves(found, page.figures.pool);
  for (std::size_t q = 0; q < found.quantities.size(); ++q) {
    const std::string& what = found.quantities[q];
    const std::string& unit = found.quantity_unit(q);
    Section& section = page.add_section("quantity-" + std::to_string(q), "The " + what + " of each design");
    Lines lines{.x = curves.x(), .panels = {curves.panel(what, unit, q, found.merit, found.low, found.high)}};
    if (found.is_paired(q) != 0) {
      lines.panels.push_back(curves.panel("change from the first design", unit == "%" ? "points" : unit, q,
                                          found.change, found.change_low, found.change_high));
    }
    add_figure(page, section, "sweep-" + std::to_string(q), std::move(lines),
               fmt::format("The {} by {}, with intervals where there are some.", what, names_of_keys(found)));
    section.table(tables[q]);
  }
}

Comparable comparable(const StoredResult& result, const StoredResult&) {
  const Result& found = sweep_of(result);
  Comparable all{
      .option_word = "quantity", .options = found.quantities, .item_word = "design", .items = design_names(found)};
  const auto list = [](const Result::Numbers& numbers) {
    return std::vector<double>(numbers.all().begin(), numbers.all().end());
  };
  std::vector<std::vector<std::string>> units;
  for (const std::string& unit : found.quantity_unit.all()) units.push_back({unit});
  all.quantities.push_back({"value", "value", std::move(units), list(found.merit), list(found.low), list(found.high)});
  return all;
}

/// The values of a key in all designs, each once: "150, 200, 250 mm".
std::string values_of_key(const Result& found, std::size_t k) {
  std::vector<std::string> values;
  const bool numbers = has_numbers(found, k);
  for (std::size_t d = 0; d < found.designs(); ++d) {
    std::string value = numbers ? number_text(found.number(d, k), 12) : readable_setting(found.value(d, k));
    if (std::ranges::find(values, value) == values.end()) values.push_back(std::move(value));
  }
  const std::string unit = numbers ? found.unit(k) : std::string();
  return fmt::format("{}{}{}", fmt::join(values, ", "), unit.empty() ? "" : " ", unit);
}

StudyWords words(const StoredResult& result) { return {.draws = true, .design = design_name(sweep_of(result), 0)}; }

MethodWords method(const StoredResult& result) {
  const Result& found = sweep_of(result);
  std::vector<std::string> keys;
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    keys.push_back(fmt::format("{} = {}", found.keys[k], values_of_key(found, k)));
  }
  MethodWords words{
      fmt::format("{} of the kind {} were compared, with these values: {}. All draw the same errors; other settings "
                  "stated here are "
                  "those of the first design.",
                  counted(found.designs(), "design", "designs"), found.kind, fmt::join(keys, "; "))};
  if (std::ranges::find(found.quantities, kYieldMerit) != found.quantities.end()) {
    words.text += " Intervals of yields are those of Clopper and Pearson.";
    words.sources.push_back(kClopperPearson);
  }
  if (std::ranges::any_of(found.is_paired.all(), [](std::uint8_t is) { return is != 0; })) {
    words.text += " Intervals of differences of yields are those of paired shares (Agresti and Min).";
    words.sources.push_back(kAgrestiMin);
  }
  return words;
}

/// Runs nothing, because no study has the kind `sweep`.
std::optional<StudyResult> run_nothing(const StudyRun&) { return std::nullopt; }

/// Returns zeros, because no study has the kind `sweep`; a StudyKind must have this function.
AtPose nothing_at_pose(const Study&) { return {0.0, "values", 0.0, "solves"}; }

const StudyKind kStudy{
    .name = "sweep", .asks = "which of several designs is best", .keys = {}, .at_pose = nothing_at_pose};

}  // namespace

constinit const ReportKind kReport{.tally = tally,
                                   .tables = sweep_tables,
                                   .words = words,
                                   .method = method,
                                   .answer = answer,
                                   .shown_cells = [](const StoredResult& result) { return shown_cells(result, 1); },
                                   .page = add_page,
                                   .comparable = comparable};

constinit const Kind kKind{.study = kStudy, .run = {run_nothing, nullptr, nullptr}, .file = kFile, .report = kReport};

}  // namespace poesy::sweep
