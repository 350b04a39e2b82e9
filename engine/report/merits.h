#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/nan.h"
#include "engine/report/table.h"
#include "engine/result/result_file.h"

/// Compares two or more results: which is better, by how much, and whether that is certain.
namespace poesy {

struct ReportKind;

/// A figure of merit: one number of a result by which designs are compared, such as a yield, a total or a cost.
struct Merit {
  std::string what;        ///< what the number is: "yield", "cost of all parts"
  std::string unit = {};   ///< unit in which it is shown; empty for a number without unit
  double value = kNaN;     ///< the number in this unit
  double low = kNaN;       ///< lower end of its confidence interval; NaN if it has none
  double high = kNaN;      ///< upper end of its confidence interval; NaN if it has none
  bool most_best = false;  ///< true if a larger value is better, false if a smaller one is
};

/// The name of the yield as a figure of merit.
inline constexpr std::string_view kYieldMerit = "yield";

/// The largest number of results that can be compared, because letters name them.
inline constexpr std::size_t kMostResults = 26;

/// The name of one of several results: 'A', 'B', ... Precondition: result < kMostResults.
char letter_of(std::size_t result);

/// The response whose totals are compared. If all results have the first result's default_ranking(), it is that
/// response; otherwise it is the first response that all results have. Empty if they have no response in common.
std::string compared_response(std::span<const StoredResult* const> results);

/// The yield of machines as a figure of merit. If errors are drawn from measured parts, its interval also includes the
/// uncertainty from the small number of these parts.
Merit yield_merit(const YieldVerdict& yield);

/// The figures of merit of each of these results, with the totals of compared_response(). The lists are empty if the
/// kind of study has no figures of merit, or if the results have different metrics, because equal names then mean
/// different things.
std::vector<std::vector<Merit>> compared_merits(const ReportKind& kind, std::span<const StoredResult* const> results);

/// The verdict on a change.
enum class Change { better, worse, not_told_apart, without_interval };

/// The change of a figure of merit from result A (with value a) to result B (with value b).
struct MeritChange {
  double value = kNaN;                        ///< difference b - a, in the unit shown
  double low = kNaN;                          ///< lower end of the interval of `value`; NaN if a or b has no interval
  double high = kNaN;                         ///< upper end of the interval of `value`; NaN if a or b has no interval
  Change verdict = Change::without_interval;  ///< verdict on the change
};

/// The change from a to b. Its interval is made from the intervals of both values (Zou and Donner 2008, Statistics in
/// Medicine 27, 1693-1702; for shares, Newcombe 1998, ibid. 17, 873-890), as if the values were drawn independently. If
/// both results share draws that move the values alike, the interval is too wide, never too narrow.
MeritChange change_of(const Merit& a, const Merit& b);

/// A table of the figures of merit that all results have, with a row for each result and the changes from the first
/// result. None if the results have no figure of merit in common. results: the figures of merit of each result, at
/// least two results.
std::optional<Table> merits_table(std::span<const std::vector<Merit>> results);

/// A sentence on each figure of merit that both results have: "B is better: the yield is 8.96 % in A and 15.7 % in B
/// (+6.74 percentage points, interval +5.5 to +8.0)." Empty if they have none in common. letter: the name of the second
/// result.
std::string merit_sentences(const std::vector<Merit>& a, const std::vector<Merit>& b, char letter = 'B');

/// A table of the settings of the studies of two results: those that agree if `same` is true, otherwise those that
/// differ; in the order of the first result, a. other: index of b among the compared results, 1 for B.
Table settings_table(const StoredResult& a, const StoredResult& b, std::size_t other, bool same);

}  // namespace poesy
