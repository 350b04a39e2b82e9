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

/// A setting that differs between two studies and changes what they require of a design. Because of it, a figure of
/// merit does not tell which design is better.
struct OtherRequirement {
  std::string_view topic;  ///< what the setting is about: "limits", "wanted yields", "draws" or "poses"
  std::string name;        ///< full name of the setting: "analysis.limits.gap"
  std::string in_a;        ///< value in result A, as text for people; empty: not set
  std::string in_b;        ///< value in the other result, as text for people; empty: not set

  bool operator==(const OtherRequirement&) const = default;  ///< Returns true if all members are equal.
};

/// A figure of merit: one number of a result by which designs are compared, such as a yield, a total or a cost.
struct Merit {
  std::string what;        ///< what the number is: "yield", "cost of all parts"
  std::string unit = {};   ///< unit of the numbers below; empty if they have no unit
  double value = kNaN;     ///< value of the figure of merit
  double low = kNaN;       ///< lower end of the confidence interval; NaN if there is none
  double high = kNaN;      ///< upper end of the confidence interval; NaN if there is none
  bool most_best = false;  ///< true if a larger value is better, false if a smaller one is
  bool narrows = true;     ///< true if more samples make the interval narrower
  std::string note = {};   ///< sentence on what the interval does not include; empty: none
  /// Verdict on the value that the study asks for: "FAIL (90 % wanted)"; empty if it asks for none.
  std::string asked = {};
  /// Requirements in which the result differs from the first of the compared results; empty: none.
  std::vector<OtherRequirement> others = {};
};

/// The name of the yield as a figure of merit (Merit::what).
inline constexpr std::string_view kYieldMerit = "yield";

/// The name of the cost of an allocation as a figure of merit (Merit::what).
inline constexpr std::string_view kCostMerit = "cost of all parts";

/// The beginning of the name of the share of machines within one limit as a figure of merit (Merit::what); the name of
/// the limited response follows.
inline constexpr std::string_view kLimitMerit = "share within the limit of ";

/// The largest number of results that can be compared, because each has a letter from A to Z.
inline constexpr std::size_t kMostResults = 26;

/// The letter for one of several results: 'A', 'B', ... Precondition: result < kMostResults.
char letter_of(std::size_t result);

/// The response whose figures of merit, such as a root mean square, are compared: `wanted` if all results have it,
/// otherwise default_ranking() of the first result if all results have that, otherwise the first response that all
/// results have. Empty if they have no response in common. wanted: name of a response; may be empty.
std::string compared_response(std::span<const StoredResult* const> results, const std::string& wanted = {});

/// The yield of machines as a figure of merit. If errors are drawn from measured parts, the interval also includes the
/// uncertainty from the small number of measured parts.
Merit yield_merit(const YieldVerdict& yield);

/// The figures of merit of each of these results; figures of merit of a response, such as its root mean square, are
/// those of compared_response(). If machines are judged by several limits, the share of machines within each limit is a
/// figure of merit as well. The lists are empty if the kind of study has no figures of merit, or if the results have
/// different metrics, because then equal names mean different things. wanted: see compared_response().
std::vector<std::vector<Merit>> compared_merits(const ReportKind& kind, std::span<const StoredResult* const> results,
                                                const std::string& wanted = {});

/// The verdict on a change of a figure of merit from one result to another.
enum class Change { better, worse, not_told_apart, without_interval, other_requirements };

/// The change of a figure of merit from result A, where its value is a, to result B, where its value is b.
struct MeritChange {
  double value = kNaN;                        ///< difference b - a, in the unit of the figure of merit
  double low = kNaN;                          ///< lower end of the interval of `value`; NaN if a or b has no interval
  double high = kNaN;                         ///< upper end of the interval of `value`; NaN if a or b has no interval
  Change verdict = Change::without_interval;  ///< verdict on the change
};

/// The change from a to b. Its interval is made from the intervals of both values (Zou and Donner 2008, Statistics in
/// Medicine 27, 1693-1702; for shares, Newcombe 1998, ibid. 17, 873-890), as if the values were independent. If both
/// results use the same draws, so that both values deviate in the same direction, the interval is too wide, never too
/// narrow. The verdict is Change::other_requirements if the requirements of b differ from those of a.
MeritChange change_of(const Merit& a, const Merit& b);

/// A table of the figures of merit that all results have, with a row for each result and its change from the first
/// result. None if the results have no figure of merit in common. results: the figures of merit of each result, at
/// least two results.
std::optional<Table> merits_table(std::span<const std::vector<Merit>> results);

/// A sentence on each figure of merit that both results have: "B is better: the yield is 8.96 % in A and 15.7 % in B
/// (+6.74 percentage points, interval +5.5 to +8.0)." Figures of merit with other requirements come first, without a
/// verdict: "No verdict, because the limits differ (analysis.limits.gap: 0.15 mm in A, 0.2 mm in B): the yield is 81.3
/// % in A and 96.3 % in B." Empty if the results have no figure of merit in common. letter: the letter of the second
/// result.
std::string merit_sentences(const std::vector<Merit>& a, const std::vector<Merit>& b, char letter = 'B');

/// A table of the settings of the studies of two results, in the order of the first result, a: the settings that are
/// equal if `same` is true, otherwise those that differ. other: index of b among the compared results, 1 for B.
Table settings_table(const StoredResult& a, const StoredResult& b, std::size_t other, bool same);

}  // namespace poesy
