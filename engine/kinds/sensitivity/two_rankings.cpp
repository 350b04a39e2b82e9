#include "engine/kinds/sensitivity/two_rankings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/report/display.h"
#include "engine/stats/rank_correlation.h"

namespace poesy {
namespace {

/// The effects of one result's errors on its response, in SI, for the errors that both results have.
struct Ranking {
  std::vector<double> effects;  ///< 0: none; NaN: not known
  std::string metric;           ///< its name
  NamedUnit response;           ///< that ranks
};

Ranking ranking_of(const RankedResult& ranked, const std::vector<std::size_t>& factors) {
  const StoredResult& result = ranked.result;
  const std::size_t r = response_named(result, ranked.response);
  const GlobalIndices shown = shown_indices(result);
  Ranking ranking{{}, result.metric, result.responses[r]};
  for (const std::size_t p : factors) {
    const double index = without_rounding(result, shown.value[r * result.factors.size() + p], r, p);
    ranking.effects.push_back(index * result.factor_sigma[p]);
  }
  return ranking;
}

/// One more than the number of errors with a larger effect.
Cell rank_cell(const Ranking& ranking, std::size_t at) {
  if (std::isnan(ranking.effects[at])) return text_cell("");
  const auto larger = [&](double effect) { return effect > ranking.effects[at]; };
  return count_cell(1 + static_cast<std::uint64_t>(std::ranges::count_if(ranking.effects, larger)));
}

/// Rank and effect of each error. Refers to the ranking.
void add_columns(std::vector<FilledColumn>& columns, char letter, const Ranking& ranking, bool by_metric) {
  const std::string suffix = letter == 'A' ? "_a" : "_b";
  const NamedUnit& response = ranking.response;
  const std::string in = fmt::format(" in {}", letter);
  columns.push_back({number_column("rank" + suffix, "rank" + (by_metric ? ", " + ranking.metric : in)),
                     [&ranking](std::size_t n) { return rank_cell(ranking, n); }});
  columns.push_back(
      {number_column("effect" + suffix, response.name + (by_metric ? ", " + ranking.metric + " metric" : in),
                     unit_text(response)),
       [&ranking](std::size_t n) { return value_cell(ranking.effects[n], ranking.response); }});
}

/// How many errors have a known effect in both.
std::size_t known_in_both(const Ranking& a, const Ranking& b) {
  std::size_t known = 0;
  for (std::size_t n = 0; n < a.effects.size(); ++n) known += !std::isnan(a.effects[n]) && !std::isnan(b.effects[n]);
  return known;
}

std::string tau_text(double tau, std::size_t errors) {
  if (std::isnan(tau))
    return "Kendall's tau of the two rankings is not known: too few errors have a known effect in both.";
  return fmt::format(
      "Kendall's tau of the two rankings is {}, over {}: 1 where they have the same order, 0 where one says nothing of "
      "the other, -1 where one is the other reversed.",
      number_text(tau, 2), counted(errors, "error", "errors"));
}

constexpr std::string_view kWhyMetricsDiffer =
    "The published metric weighs radians against metres, so its ranking depends on the unit of length and on where the "
    "base frame is; the platform's metric measures how far its points move, which depends on neither.";

std::vector<std::string> remarks(const RankedResult& a, const RankedResult& b, double tau, std::size_t errors) {
  std::vector<std::string> list{tau_text(tau, errors)};
  if (differ_in_metric(a.result, b.result)) {
    list.emplace_back(kWhyMetricsDiffer);
  } else if (a.result.metric == b.result.metric && a.result.metric_points != b.result.metric_points) {
    list.emplace_back("The two metrics have different points of the platform, and so different effects.");
  }
  const auto names_a = names_of(a.result.factors);
  const auto names_b = names_of(b.result.factors);
  for (const auto& [letter, only] : {std::pair('A', only_in(names_a, names_b)), {'B', only_in(names_b, names_a)}}) {
    if (!only.empty()) list.push_back(fmt::format("Only in {}: {}.", letter, fmt::join(only, ", ")));
  }
  return list;
}

/// The errors that both have, in this order of A.
Common errors_in_order(const RankedResult& a, const RankedResult& b, RowOrder order) {
  Common both = common(names_of(a.result.factors), names_of(b.result.factors));
  if (both.empty()) {
    throw InputError({.file = b.path}, fmt::format("has no error in common with {}", a.path),
                     "compare two results that share some");
  }
  const std::vector<std::size_t> rows = ranked_errors(a.result, a.response, order).rows;
  std::ranges::sort(both, {}, [&](const auto& one) { return std::ranges::find(rows, one.first) - rows.begin(); });
  return both;
}

}  // namespace

TwoRankings two_rankings(const RankedResult& a, const RankedResult& b, RowOrder order) {
  check_comparable(a.result, a.path, b.result, b.path);
  std::vector<std::size_t> of_a;
  std::vector<std::size_t> of_b;
  for (const auto& [pa, pb] : errors_in_order(a, b, order)) {
    of_a.push_back(pa);
    of_b.push_back(pb);
  }
  const Ranking first = ranking_of(a, of_a);
  const Ranking second = ranking_of(b, of_b);
  const bool by_metric = differ_in_metric(a.result, b.result);
  Table table{.name = "rankings",
              .caption = "Two rankings: the effect of each error at the size that its study gives it",
              .columns = {},
              .ranked = true};
  std::vector<FilledColumn> columns{
      {text_column("error", "error"), [&](std::size_t n) { return text_cell(a.result.factors[of_a[n]].name); }}};
  add_columns(columns, 'A', first, by_metric);
  add_columns(columns, 'B', second, by_metric);
  fill(table, positions(of_a.size()), columns);
  const double tau = kendall_tau(first.effects, second.effects);
  return {std::move(table), tau, remarks(a, b, tau, known_in_both(first, second))};
}

}  // namespace poesy
