#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/report/solves.h"
#include "engine/report/table.h"
#include "engine/result/result_file.h"

namespace poesy {

/// What was run and how long it took, a few lines, broken at `width` as by prose_of. tally: of the result.
std::string summary_text(const StoredResult& result, const SolveTally& tally, std::size_t width);

/// Whether a response varies, or the result does not say.
bool varies(const StoredResult& result, std::size_t response);

/// That this response does not vary, and what follows: a sentence without its stop.
std::string constant_text(const NamedUnit& response);

/// The same responses, with those that do not vary at the end.
std::vector<std::size_t> varying_first(const StoredResult& result, std::vector<std::size_t> responses);

/// The response a result is ranked by unless asked otherwise: of those of the headline that vary, or of all where none
/// does, the first length, else the first.
std::string default_ranking(const StoredResult& result);

/// In which order tables show ranked errors; the largest first.
enum class RowOrder {
  effect,        ///< index x sigma: what the error does at the size that the study gives it
  index,         ///< in the units shown
  name,          ///< a to z
  study,         ///< as the study has them
  not_converged  ///< share of the samples
};

/// What users call them, in the order of RowOrder.
inline constexpr std::array<std::string_view, 5> kRowOrders{"effect", "index", "name", "order", "not-converged"};

/// How tables show a result.
struct TableOptions {
  std::string ranked_by = {};         ///< a response of the result; its errors go by it where the kind ranks them
  RowOrder order = RowOrder::effect;  ///< of ranked errors
};

/// Leaves the first rows of the tables that are ranked; where that takes some away, a note says how many there are.
void keep_first(std::size_t most, std::span<Table> tables);

/// The quantities of a sampled result that settle with the number of samples.
struct Settling {
  std::string_view quantities;         ///< what they are: "global indices"
  std::vector<std::string> slots;      ///< [P] names of what has quantities: errors
  std::vector<std::size_t> responses;  ///< those that decide when a study with adaptive samples ends
};

/// How many quantities reached the interval that the study asks for, with how many samples, and which did not; none
/// for a fixed number of samples.
std::optional<Table> convergence_table(const StoredResult& result, const Settling& settling);

/// How many quantities did not reach it, in a sentence; empty where all did, and for a fixed number of samples.
std::string not_settled_text(const StoredResult& result, const Settling& settling);

/// The verdict on a response; null where the study does not limit it.
const LimitVerdict* verdict_on(const StoredResult& result, std::size_t response);

/// The yield with its interval and what became of it, then what each limit alone makes of it. Precondition:
/// verdicts.yield is there.
Table yield_table(const StoredResult& result, const LimitVerdicts& verdicts);

/// Errors that are drawn as parts were measured: from how many, and how parts and draws scatter; none where there are
/// none.
std::optional<Table> measured_table(const StoredResult& result);

/// What the fewest of the measured parts can show of a yield, in sentences. Precondition: errors are measured.
std::string few_parts_text(const StoredResult& result, double conf_level, double asked);

/// PASS or FAIL for each limit, with the value that was found and the limit; none where the study states none. By
/// Judge::yield it is yield_table.
std::optional<Table> limits_table(const StoredResult& result);

/// A result, and the response by which its errors are ranked; it must have it.
struct RankedResult {
  const StoredResult& result;  ///< must outlive this
  std::string path;            ///< of the result
  std::string response;        ///< name
  SolveCounts solves;          ///< all of them
};

/// Two rankings of the same errors by their effects, at the sizes that each study gives them.
struct TwoRankings {
  Table table;                       ///< of each error its rank and effect in A and in B, in an order of A
  double tau;                        ///< Kendall's, of the effects; NaN where it is not known
  std::vector<std::string> remarks;  ///< Sentences for people: the tau, how the metrics differ, what is left out.
};

/// Throws InputError, at the path of B, where the results are of two kinds or mechanisms.
void check_comparable(const StoredResult& a, const std::string& path_a, const StoredResult& b,
                      const std::string& path_b);

/// Whether two results are by different metrics; not where one of them weighs nothing.
bool differ_in_metric(const StoredResult& a, const StoredResult& b);

/// What a reader must know of one of them, on one line: "A: title (path); metric: ...; ranked by gap; 5 of 1 000 solves
/// did not converge".
std::string ranked_text(char letter, const RankedResult& ranked);

/// A result's summary and its tables as one JSON object, for programs:
///
/// - kind, model, title, poesy_version, git_commit, content_sha256
/// - metric: name, null where nothing is weighed; metric_points: [[x, y, z]] in m, null where it has none
/// - seed, where the study has one; poses
/// - errors, responses: [{name, unit (SI), description}]
/// - solves: total, not_converged, by_status: {converged, stagnated, ...}
/// - run: created, threads, wall_seconds
/// - tables: [{name, caption, columns: [{name, heading, unit, kind}], rows, shown, notes}]
///
/// A row of `rows` has the values by the names of the columns: numbers so that they read back as the same double, in
/// the column's unit, null where there is none; text as it is. `shown` has the texts of the same cells, as a list for
/// each row. Text that is not UTF-8 is made so. solves: all of the result.
std::string json_of(const StoredResult& result, const SolveCounts& solves, std::span<const Table> tables);

/// Two rankings beside each other as one JSON object:
///
///     results: [{path, response (that ranks), and of the result all that is above but its tables}, ...], A before B
///     kendall_tau (null where it is not known), remarks: [sentences]
///     tables: [the one table, as above]
std::string json_of(const RankedResult& a, const RankedResult& b, const TwoRankings& rankings);

std::string json_of(const Table& table);  ///< One of the tables above alone, as JSON.

std::string models_text(const Catalog& catalog);  ///< All mechanisms, a line each.

/// One mechanism: geometry, pose coordinates, workspace, factors, factor sets, responses, details.
std::string model_text(const CatalogEntry& entry);

}  // namespace poesy
