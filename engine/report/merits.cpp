#include "engine/report/merits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "engine/base/contract.h"
#include "engine/report/display.h"
#include "engine/report/report_kind.h"
#include "engine/report/requirements.h"
#include "engine/stats/proportion.h"

namespace poesy {
namespace {

constexpr int kDigits = 4;
/// Notes on the table of figures of merit, if some have intervals and if none has.
/// @{
constexpr std::string_view kIntervals =
    "low, high: intervals of the value, and of its change as if both results were drawn independently; common draws "
    "make it wider than it need be";
constexpr std::string_view kNoIntervals =
    "no verdict, because these numbers have no intervals; a study of machines with a limit has a yield with one, and "
    "poesy sweep compares designs by the same machines";
/// @}

const Merit* find(std::span<const Merit> merits, std::string_view what) {
  const auto at = std::ranges::find(merits, what, &Merit::what);
  return at == merits.end() ? nullptr : &*at;
}

std::string_view word_of(Change verdict) {
  constexpr std::array<std::string_view, 5> kWords{"better", "worse", "not told apart", "", ""};
  return kWords[static_cast<std::size_t>(verdict)];
}

/// A value of a figure of merit with its unit; a share is shown in percent.
std::string text_of(const Merit& merit, double value) {
  if (merit.unit == "%") return percent_text(value / 100.0);
  return number_text(value, kDigits) + (merit.unit.empty() ? "" : " " + merit.unit);
}

/// A change of a figure of merit in words: "+6.74 percentage points" for a share, otherwise in percent of the value in
/// A: "-17 %".
std::string change_text(const Merit& a, const MeritChange& change) {
  if (a.unit == "%") return fmt::format("{:+.3g} percentage points", change.value);
  return fmt::format("{:+.3g} %", 100.0 * change.value / std::abs(a.value));
}

std::string interval_text(const Merit& a, const MeritChange& change) {
  // The text is empty if the interval is not known or the change is exact.
  if (std::isnan(change.low) || change.low == change.high) return {};
  const double scale = a.unit == "%" ? 1.0 : 100.0 / std::abs(a.value);
  return fmt::format(", interval {:+.3g} to {:+.3g}", scale * change.low, scale * change.high);
}

/// The values in both results: "the yield is 8.96 % in A and 15.7 % in B". letter: letter of the second result.
std::string values_text(const Merit& a, const Merit& b, char letter) {
  return fmt::format("the {} is {} in A and {} in {}", a.what, text_of(a, a.value), text_of(b, b.value), letter);
}

std::string sentence(const Merit& a, const Merit& b, char letter) {
  const MeritChange change = change_of(a, b);
  const std::string numbers =
      fmt::format("{} ({}{})", values_text(a, b, letter), change_text(a, change), interval_text(a, change));
  switch (change.verdict) {
    case Change::better:
      return fmt::format("{} is better: {}.", letter, numbers);
    case Change::worse:
      return "A is better: " + numbers + ".";
    case Change::not_told_apart:
      return fmt::format("A and {} are not told apart: {}.", letter, numbers);
    case Change::without_interval:
    case Change::other_requirements:
      break;
  }
  return fmt::format("T{}.", numbers.substr(1));
}

/// Figures of merit without a verdict, grouped by the reason why there is none. Each pair has the reason (what
/// differs), and a text for each figure of merit.
using NoVerdicts = std::vector<std::pair<std::string, std::vector<std::string>>>;

void add_no_verdict(const Merit& b, char letter, std::string text, NoVerdicts& list) {
  std::string reason = others_text(b.others, letter);
  auto at = std::ranges::find(list, reason, [](const auto& one) { return one.first; });
  if (at == list.end()) at = list.insert(list.end(), {std::move(reason), {}});
  at->second.push_back(std::move(text));
}

/// The names of the figures of merit that all results have, in the order of the first result.
std::vector<std::string> shared_merits(std::span<const std::vector<Merit>> results) {
  std::vector<std::string> names;
  for (const Merit& merit : results.front()) {
    const auto has = [&](const std::vector<Merit>& other) { return find(other, merit.what) != nullptr; };
    if (std::ranges::all_of(results, has)) names.push_back(merit.what);
  }
  return names;
}

Cell change_cell(double change) {
  Cell cell = number_cell(change, 3);
  if (change > 0.0) cell.text.insert(0, "+");
  return cell;
}

/// A row of the table of figures of merit: one figure of merit of one result. first: the same figure of merit of result
/// A. result: index of the result.
std::vector<Cell> row_of(const Merit& first, const Merit& merit, std::size_t result) {
  const MeritChange change = result == 0 ? MeritChange{} : change_of(first, merit);
  return {text_cell(merit.what),
          text_cell(std::string(1, letter_of(result))),
          text_cell(merit.others.empty() ? std::string(word_of(change.verdict)) : "other " + topics_text(merit.others)),
          change_cell(change.value),
          change_cell(change.low),
          change_cell(change.high),
          number_cell(merit.value, kDigits),
          number_cell(merit.low, kDigits),
          number_cell(merit.high, kDigits),
          text_cell(merit.unit)};
}

/// The factor by which the number of samples must grow until the interval of this change excludes zero, if the change
/// keeps its value. The width of an interval is inversely proportional to the square root of the number of samples. NaN
/// if the change is zero or exact.
double times_as_many(const MeritChange& change) {
  const double nearer = change.value > 0.0 ? change.value - change.low : change.high - change.value;
  return change.value == 0.0 || change.low == change.high ? kNaN : std::pow(nearer / change.value, 2);
}

/// A note on how many more samples would show whether a result is better than the first one, or that no number of
/// samples would show it. Empty if the verdict is not Change::not_told_apart, or if more samples do not make the
/// intervals narrower (Merit::narrows).
std::string remedy_text(const Merit& first, const Merit& merit, std::size_t result) {
  constexpr double kTooMany = 1e4;
  const MeritChange change = change_of(first, merit);
  if (change.verdict != Change::not_told_apart || !first.narrows || !merit.narrows) return {};
  const double times = times_as_many(change);
  const std::string name = fmt::format("{}, A and {} not told apart: ", merit.what, letter_of(result));
  std::string text = name + "they are equal";
  if (!std::isnan(times)) {
    text = name + (times > kTooMany ? std::string("the difference is too small for any number of samples")
                                    : fmt::format("about {} times as many samples of each would show a difference "
                                                  "as large as this one",
                                                  number_text(times, 2)));
  }
  return text;
}

/// The shares of machines within each limit as figures of merit. Empty if machines are not judged, or by one limit
/// only, because then the share within it is the yield. If errors are drawn from measured parts, the shares have no
/// intervals, because Clopper-Pearson intervals would leave out the uncertainty from the small number of parts.
std::vector<Merit> limit_merits(const StoredResult& result) {
  if (!result.verdicts || !result.verdicts->yield || result.verdicts->limits.size() < 2) return {};
  const YieldVerdict& yield = *result.verdicts->yield;
  std::vector<Merit> list;
  for (const LimitVerdict& limit : result.verdicts->limits) {
    const Estimate share = proportion(limit.within, limit.tried, yield.conf_level);
    Merit merit{.what = std::string(kLimitMerit) + result.responses[limit.response].name,
                .unit = "%",
                .value = 100.0 * share.value,
                .most_best = true};
    if (!yield.with_parts) {
      merit.low = 100.0 * share.interval.low;
      merit.high = 100.0 * share.interval.high;
    }
    list.push_back(std::move(merit));
  }
  return list;
}

/// The caption of the table of these figures of merit. first: name of the figure of merit in the first row.
std::string merits_caption(std::span<const std::vector<Merit>> results, const std::string& first) {
  if (results.size() > 2) return "Which is better: each against A";
  const std::vector<OtherRequirement>& others = find(results[1], first)->others;
  if (others.empty()) return "Which is better: B against A";
  return fmt::format("Which is better: no verdict on the {}, because the {} differ", first, topics_text(others));
}

/// Returns PosesFrom::table if the poses of at least one of two results come from a table.
PosesFrom poses_from(const ReportKind& kind, const StoredResult& a, const StoredResult& b) {
  return kind.words(a).own_poses && kind.words(b).own_poses ? PosesFrom::study : PosesFrom::table;
}

}  // namespace

char letter_of(std::size_t result) {
  POESY_EXPECTS(result < kMostResults);
  return static_cast<char>('A' + result);
}

std::string compared_response(std::span<const StoredResult* const> results, const std::string& wanted) {
  const auto in_all = [&](const std::string& name) {
    return std::ranges::all_of(results, [&](const StoredResult* result) {
      return std::ranges::find(result->responses, name, &NamedUnit::name) != result->responses.end();
    });
  };
  const StoredResult& first = *results.front();
  for (const std::string& name : {wanted, default_ranking(first)}) {
    if (in_all(name)) return name;
  }
  const auto at = std::ranges::find_if(first.responses, in_all, &NamedUnit::name);
  return at == first.responses.end() ? std::string() : at->name;
}

/// The verdict on the wanted yield: "FAIL (90 % wanted)"; empty if the study asks for no yield.
static std::string verdict_text(const YieldVerdict& yield) {
  const std::string words = verdict_words(yield);
  return words.empty() || !(yield.asked > 0.0) ? std::string()
                                               : fmt::format("{} ({} wanted)", words, percent_text(yield.asked));
}

Merit yield_merit(const YieldVerdict& yield) {
  const Interval machines{yield.ci_low, yield.ci_high};
  const Interval interval = yield.with_parts.value_or(machines);
  return {.what = std::string(kYieldMerit),
          .unit = "%",
          .value = 100.0 * yield.value,
          .low = 100.0 * interval.low,
          .high = 100.0 * interval.high,
          .most_best = true,
          .narrows = !yield.with_parts.has_value(),
          .asked = verdict_text(yield)};
}

std::vector<std::vector<Merit>> compared_merits(const ReportKind& kind, std::span<const StoredResult* const> results,
                                                const std::string& wanted) {
  const auto differs = [&](const StoredResult* result) { return differ_in_metric(*results.front(), *result); };
  if (kind.merits == nullptr || std::ranges::any_of(results, differs))
    return std::vector<std::vector<Merit>>(results.size());
  const std::string response = compared_response(results, wanted);
  std::vector<std::vector<Merit>> found;
  for (const StoredResult* result : results) {
    found.push_back(kind.merits(*result, response));
    if (find(found.back(), kYieldMerit) != nullptr) {
      std::ranges::move(limit_merits(*result), std::back_inserter(found.back()));
    }
    const PosesFrom poses = poses_from(kind, *results.front(), *result);
    for (Merit& merit : found.back()) merit.others = other_requirements(*results.front(), *result, merit.what, poses);
  }
  return found;
}

MeritChange change_of(const Merit& a, const Merit& b) {
  MeritChange change{.value = b.value - a.value};
  change.low = change.value - std::hypot(b.value - b.low, a.high - a.value);
  change.high = change.value + std::hypot(b.high - b.value, a.value - a.low);
  if (!b.others.empty()) {
    change.verdict = Change::other_requirements;
  } else if (std::isnan(change.low) || std::isnan(change.high)) {
    change.verdict = Change::without_interval;
  } else if (change.low <= 0.0 && change.high >= 0.0) {
    change.verdict = Change::not_told_apart;
  } else {
    change.verdict = (change.value > 0.0) == a.most_best ? Change::better : Change::worse;
  }
  return change;
}

/// A clause with the verdicts of results on the value of a figure of merit that each study asks for: "A FAIL (90 %
/// wanted), B PASS (90 % wanted)". Empty if no study asks for one. merits: each result's letter and figure of merit.
static std::string verdicts_text(std::span<const std::pair<char, const Merit*>> merits) {
  std::vector<std::string> parts;
  for (const auto& [letter, merit] : merits) {
    if (!merit->asked.empty()) parts.push_back(fmt::format("{} {}", letter, merit->asked));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::optional<Table> merits_table(std::span<const std::vector<Merit>> results) {
  const std::vector<std::string> shared = shared_merits(results);
  if (shared.empty()) return std::nullopt;
  Table table{.name = "merits",
              .caption = merits_caption(results, shared.front()),
              // A narrow page hides the dispensable columns first, and then the others from right to left.
              .columns = {text_column("quantity", "quantity"), main_column(text_column("result", "in")),
                          text_column("verdict", "verdict"), number_column("change", "change"),
                          number_column("change_low", "low", "", 1), number_column("change_high", "high", "", 1),
                          main_column(number_column("value", "value")), number_column("low", "low", "", 1),
                          number_column("high", "high", "", 1), text_column("unit", "unit")},
              .notes = {}};
  NoVerdicts no_verdicts;
  bool has_interval = false;
  for (const std::string& what : shared) {
    const Merit& first = *find(results.front(), what);
    std::vector<std::pair<char, const Merit*>> all;
    for (std::size_t n = 0; n < results.size(); ++n) {
      const Merit& merit = *find(results[n], what);
      all.emplace_back(letter_of(n), &merit);
      has_interval = has_interval || !std::isnan(merit.low);
      table.rows.push_back(row_of(first, merit, n));
      if (!merit.others.empty()) add_no_verdict(merit, letter_of(n), what, no_verdicts);
      std::string remedy = n == 0 ? std::string() : remedy_text(first, merit, n);
      if (!remedy.empty()) table.notes.push_back(std::move(remedy));
    }
    if (std::string verdicts = verdicts_text(all); !verdicts.empty()) {
      table.notes.push_back(what + ": " + verdicts);
    }
    if (!first.note.empty()) table.notes.push_back(first.note);
  }
  table.notes.insert(table.notes.begin(), std::string(has_interval ? kIntervals : kNoIntervals));
  for (const auto& [reason, merits] : no_verdicts) {
    table.notes.push_back(fmt::format("no verdict on {}, because {}", fmt::join(merits, " and "), reason));
  }
  return table;
}

/// A sentence that names the figures of merit, other than costs, whose verdict is the opposite of that on the yield.
/// Empty if there are none.
static std::string disagreement(const std::vector<Merit>& a, const std::vector<Merit>& b) {
  const auto verdict_on = [&](const Merit& merit) {
    const Merit* other = find(b, merit.what);
    return other == nullptr ? Change::without_interval : change_of(merit, *other).verdict;
  };
  const Merit* yield = find(a, kYieldMerit);
  if (yield == nullptr || verdict_on(*yield) > Change::worse) return {};
  const Change opposite = verdict_on(*yield) == Change::better ? Change::worse : Change::better;
  std::vector<std::string> names;
  for (const Merit& merit : a) {
    if (merit.what == kCostMerit || merit.what.starts_with(kLimitMerit)) continue;
    if (verdict_on(merit) == opposite) names.push_back("the " + merit.what);
  }
  if (names.empty()) return {};
  return fmt::format(
      "By {} the other is better: the yield counts machines that keep all limits, and not how far they are from them.",
      fmt::join(names, " and "));
}

std::string merit_sentences(const std::vector<Merit>& a, const std::vector<Merit>& b, char letter) {
  std::vector<std::string> sentences;
  NoVerdicts no_verdicts;
  for (const Merit& merit : a) {
    const Merit* other = find(b, merit.what);
    if (other == nullptr) continue;
    const bool is_of_limit = merit.what.starts_with(kLimitMerit);
    if (is_of_limit && change_of(merit, *other).verdict > Change::worse) continue;  // shown only in merits_table()
    const std::string verdicts = verdicts_text(std::array{std::pair('A', &merit), std::pair(letter, other)});
    if (other->others.empty()) {
      sentences.push_back(
          sentence(merit, *other, letter) +
          (verdicts.empty() ? "" : fmt::format(" Verdict on the {} of each: {}.", merit.what, verdicts)));
    } else {
      add_no_verdict(*other, letter, values_text(merit, *other, letter), no_verdicts);
    }
  }
  std::vector<std::string> first;
  for (const auto& [reason, values] : no_verdicts) {
    first.push_back(fmt::format("No verdict, because {}: {}.", reason, fmt::join(values, "; ")));
  }
  sentences.insert(sentences.begin(), first.begin(), first.end());
  if (std::string text = disagreement(a, b); !text.empty()) sentences.push_back(std::move(text));
  return fmt::format("{}", fmt::join(sentences, " "));
}

Table settings_table(const StoredResult& a, const StoredResult& b, std::size_t other, bool same) {
  Table table{.name = same ? "settings_alike" : "settings",
              .caption = same ? "Settings that are the same" : "Settings that differ",
              .columns = {text_column("setting", "setting"), text_column("a", "A"),
                          text_column("b", std::string(1, letter_of(other)))}};
  const auto list_a = readable_settings(a.study_text);
  const auto list_b = readable_settings(b.study_text);
  const std::map<std::string, std::string> of_a(list_a.begin(), list_a.end());
  const std::map<std::string, std::string> of_b(list_b.begin(), list_b.end());
  const auto add = [&](const std::string& name, const std::string& in_a, const std::string& in_b) {
    if ((in_a == in_b) == same) table.rows.push_back({text_cell(name), text_cell(in_a), text_cell(in_b)});
  };
  for (const auto& [name, value] : list_a) {
    const auto at = of_b.find(name);
    add(name, value, at == of_b.end() ? std::string() : at->second);
  }
  for (const auto& [name, value] : list_b) {
    if (!of_a.contains(name)) add(name, {}, value);
  }
  return table;
}

}  // namespace poesy
