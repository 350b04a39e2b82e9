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

/// Which of two or more results is better, by how much, and whether that is certain.
namespace poesy {

struct ReportKind;

/// A figure of merit: one number of a result by which designs are compared first, such as a yield, a total or a cost.
struct Merit {
  std::string what;        ///< "yield", "cost of all parts"
  std::string unit = {};   ///< unit that people read; empty for a pure number
  double value = kNaN;     ///< in that unit
  double low = kNaN;       ///< lower end of its interval; NaN if it has none
  double high = kNaN;      ///< upper end
  bool most_best = false;  ///< whether a larger value is better
};

/// As many results can be compared as there are letters to name them.
inline constexpr std::size_t kMostResults = 26;

/// The name of one of several results: 'A', 'B', ... Precondition: result < kMostResults.
char letter_of(std::size_t result);

/// The response whose totals are compared: the first result's default_ranking() if all have it, otherwise the first
/// that all have; empty if there is none.
std::string compared_response(std::span<const StoredResult* const> results);

/// The yield of machines as a figure of merit; its interval counts measured parts too, if there are some.
Merit yield_merit(const YieldVerdict& yield);

/// The figures of merit of each of these results, totals for compared_response(). Empty lists if the kind has none, or
/// the results have different metrics, by which a number means different things.
std::vector<std::vector<Merit>> compared_merits(const ReportKind& kind, std::span<const StoredResult* const> results);

/// What is said of a change.
enum class Change { better, worse, not_told_apart, without_interval };

/// The change of a figure of merit from A to B.
struct MeritChange {
  double value = kNaN;                        ///< b - a, in the unit shown
  double low = kNaN;                          ///< lower end of its interval; NaN if one of both values has none
  double high = kNaN;                         ///< upper end
  Change verdict = Change::without_interval;  ///< what is said of it
};

/// The interval is made from those of both values (Zou and Donner 2008, Statistics in Medicine 27, 1693-1702; for
/// shares, Newcombe 1998, ibid. 17, 873-890), as if both were drawn independently. Common draws make it too wide, never
/// too narrow, where they move both values alike.
MeritChange change_of(const Merit& a, const Merit& b);

/// The figures of merit that all results have, a row for each result, with the changes from the first; none if they
/// have none in common. results: the merits of each, two at least.
std::optional<Table> merits_table(std::span<const std::vector<Merit>> results);

/// A sentence on each figure of merit that both have, "B is better: the yield is 8.96 % in A and 15.7 % in B (+6.74
/// percentage points, interval +5.5 to +8.0)."; empty if they have none in common. letter: the name
/// of the second result.
std::string merit_sentences(const std::vector<Merit>& a, const std::vector<Merit>& b, char letter = 'B');

/// The settings in which the studies of A and of another result differ, or agree (`same`), in the order of A. other:
/// the number of b among the results, 1 for B.
Table settings_table(const StoredResult& a, const StoredResult& b, std::size_t other, bool same);

}  // namespace poesy
