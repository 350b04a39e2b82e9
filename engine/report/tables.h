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

/// A few lines on what was run and how long it took, wrapped at `width` by prose_of(). tally: of the result.
std::string summary_text(const StoredResult& result, const SolveTally& tally, std::size_t width);

/// Whether a response varies; also true if the result does not say.
bool varies(const StoredResult& result, std::size_t response);

/// A sentence without full stop: this response does not vary, and what follows from it.
std::string constant_text(const NamedUnit& response);

/// The same responses with those that do not vary at the end.
std::vector<std::size_t> varying_first(const StoredResult& result, std::vector<std::size_t> responses);

/// The response that ranks by default. Of those of the headline that vary (or of all, if none varies) it is the first
/// if it has a limit or is the displacement of tool or platform, otherwise the first length, or else the first.
std::string default_ranking(const StoredResult& result);

/// The order in which tables show ranked errors, the largest first.
enum class RowOrder {
  effect,        ///< index x sigma: the effect of the error at its size in the study
  index,         ///< index in the units shown
  name,          ///< name, a to z
  study,         ///< order of the study
  not_converged  ///< share of samples that did not converge
};

/// The words for users, in the order of RowOrder.
inline constexpr std::array<std::string_view, 5> kRowOrders{"effect", "index", "name", "order", "not-converged"};

/// How tables show a result.
struct TableOptions {
  std::string ranked_by = {};         ///< the response by which errors are ranked, if the kind ranks them
  RowOrder order = RowOrder::effect;  ///< order of ranked errors
};

/// Keeps the first rows of ranked tables. If some are removed, a note states how many there are.
void keep_first(std::size_t most, std::span<Table> tables);

/// The quantities of a sampled result that converge with the number of samples.
struct Settling {
  std::string_view quantities;         ///< their name: "global indices"
  std::vector<std::string> slots;      ///< [P] names of the errors that have quantities
  std::vector<std::size_t> responses;  ///< responses that decide when adaptive samples end
};

/// The number of quantities that reached the interval that the study asks for, the samples they took, and those that
/// did not reach it; none for a fixed number of samples.
std::optional<Table> convergence_table(const StoredResult& result, const Settling& settling);

/// A sentence with the number of quantities that did not reach it; empty if all did, and for a fixed number of samples.
std::string not_settled_text(const StoredResult& result, const Settling& settling);

/// The verdict on a response; null if the study does not limit it.
const LimitVerdict* verdict_on(const StoredResult& result, std::size_t response);

/// The yield with its interval and its verdict, then the yield of each limit alone. Precondition: verdicts.yield is
/// set.
Table yield_table(const StoredResult& result, const LimitVerdicts& verdicts);

/// Errors that are drawn from measured parts: the number of parts, and the scatter of parts and draws; none if there
/// are no such errors.
std::optional<Table> measured_table(const StoredResult& result);

/// Errors of which the study states a mean, or that a machine draws anew at each pose; none if there are no such
/// errors.
std::optional<Table> stated_table(const StoredResult& result);

/// Sentences on the yield that the smallest number of measured parts can show. Precondition: errors are measured.
std::string few_parts_text(const StoredResult& result, double conf_level, double asked);

/// PASS or FAIL for each limit, with the value and the limit; none if the study states no limits. For Judge::yield it
/// is yield_table().
std::optional<Table> limits_table(const StoredResult& result);

/// A result and the response by which its errors are ranked, which it must have.
struct RankedResult {
  const StoredResult& result;  ///< must outlive this object
  std::string path;            ///< path of the result
  std::string response;        ///< name of the response
  SolveCounts solves;          ///< all solves
};

/// Two rankings of the same errors by their effects, with the sizes in each study.
struct TwoRankings {
  Table table;                       ///< rank and effect of each error in A and in B, in an order of A
  double tau;                        ///< Kendall's tau of the effects; NaN if not known
  std::vector<std::string> remarks;  ///< sentences for people: the tau, how the metrics differ, what is left out
};

/// Throws InputError, with the path of B, if the results are of two kinds or have no response in common.
void check_comparable(const StoredResult& a, const std::string& path_a, const StoredResult& b,
                      const std::string& path_b);

/// Whether two results have different metrics; false if one of them has none.
bool differ_in_metric(const StoredResult& a, const StoredResult& b);

/// One line about one of several results: "A: title (path); metric: ...; ranked by gap; 5 of 1 000 solves did not
/// converge". role: what the response does there.
std::string ranked_text(char letter, const RankedResult& ranked, std::string_view role = "ranked by");

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
/// A row of `rows` has the values by the names of the columns: numbers in the column's unit, which read back as the
/// same double, null if there is none; text unchanged. `shown` has the texts of the same cells, a list for each row.
/// Invalid UTF-8 is replaced. solves: all of the result.
std::string json_of(const StoredResult& result, const SolveCounts& solves, std::span<const Table> tables);

/// What two or more results of a kind are compared by.
struct ComparedResults {
  std::vector<Table> tables = {};         ///< figures of merit, settings that differ, errors or other items
  std::optional<double> tau = {};         ///< Kendall's tau of two rankings, NaN if not known; none: nothing was ranked
  std::vector<std::string> remarks = {};  ///< sentences for people
};

/// A comparison as one JSON object:
///
///     results: [{path, response (that ranks), and of the result all that is above but its tables}, ...], A first
///     kendall_tau (null where it is not known, or nothing is ranked), remarks: [sentences]
///     tables: as above
std::string json_of(std::span<const RankedResult> results, const ComparedResults& compared);

std::string json_of(const Table& table);  ///< One table as JSON, in the form above.

std::string models_text(const Catalog& catalog);  ///< A list of all mechanisms, a line each.

/// One mechanism: geometry, pose coordinates, workspace, factors, factor sets, responses, details.
std::string model_text(const CatalogEntry& entry);

}  // namespace poesy
