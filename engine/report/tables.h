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

/// A sentence on candidate poses of the workspace that are not in the study, or on a boundary beyond the reach; empty
/// if there is nothing to say.
std::string rejected_text(const StoredResult& result);

/// A few lines on what was run and how long it took, wrapped at `width` by prose_of(). tally: how the solves of the
/// result ended.
std::string summary_text(const StoredResult& result, const SolveTally& tally, std::size_t width);

/// Returns true if a response varies, or if the result does not tell whether it varies. response: index in the result.
bool varies(const StoredResult& result, std::size_t response);

/// A sentence without a full stop. It says that this response does not vary, and what follows from that.
std::string constant_text(const NamedUnit& response);

/// The given indices of responses. The responses that do not vary are moved to the end; otherwise the order is kept.
std::vector<std::size_t> varying_first(const StoredResult& result, std::vector<std::size_t> responses);

/// The response by which errors are ranked by default. The candidates are the responses of StoredResult::headline that
/// vary, or all of them if none varies. The first candidate is taken if it has a limit, or is the displacement of the
/// tool or the platform. Otherwise the first candidate that is a length is taken, or the first candidate if none is a
/// length. Empty if StoredResult::headline is empty.
std::string default_ranking(const StoredResult& result);

/// The order in which tables show ranked errors.
enum class RowOrder {
  effect,        ///< largest effect (index x sigma in the study) first
  index,         ///< largest sensitivity index first, in the unit shown
  name,          ///< names from a to z
  study,         ///< order of the study
  not_converged  ///< largest share of samples that did not converge first
};

/// The words for the values of RowOrder in the command line, in the order of the enumeration.
inline constexpr std::array<std::string_view, 5> kRowOrders{"effect", "index", "name", "order", "not-converged"};

/// How tables show a result.
struct TableOptions {
  std::string ranked_by = {};         ///< name of the response by which errors are ranked, if the kind ranks errors
  RowOrder order = RowOrder::effect;  ///< order of ranked errors
};

/// Keeps the first `most` rows of ranked tables. If rows are removed, a note in the table states how many.
void keep_first(std::size_t most, std::span<Table> tables);

/// The quantities of a result that become more exact as the number of samples grows.
struct Settling {
  std::string_view quantities;         ///< name of the quantities: "global indices"
  std::vector<std::string> slots;      ///< names of errors that vary alone, or "all errors" if all vary together
  std::vector<std::size_t> responses;  ///< indices of the responses whose quantities decide when adaptive samples end
};

/// A table of how adaptive samples converged: how many quantities have intervals as narrow as the study asks for, the
/// samples that were needed, and the quantities with wider intervals. None if the number of samples was fixed.
std::optional<Table> convergence_table(const StoredResult& result, const Settling& settling);

/// A sentence with the number of quantities whose intervals are wider than the study asks for. Empty if there is no
/// such quantity, or if the number of samples was fixed.
std::string not_settled_text(const StoredResult& result, const Settling& settling);

/// The verdict on the limit of a response; null if the study does not limit it.
const LimitVerdict* verdict_on(const StoredResult& result, std::size_t response);

/// A table of the yield with its interval and the verdict, followed by the yield for each limit as if it were the only
/// one. Precondition: verdicts.yield is set.
Table yield_table(const StoredResult& result, const LimitVerdicts& verdicts);

/// A table of the errors that are drawn from measured parts: the number of parts, and the scatter of the parts and of
/// the values that are drawn. None if there are no such errors.
std::optional<Table> measured_table(const StoredResult& result);

/// A table of the errors whose mean the study states, and of the errors that a machine draws anew at each pose. None if
/// there are no such errors.
std::optional<Table> stated_table(const StoredResult& result);

/// A text on the largest yield that the measured parts can prove; the error with the fewest parts decides. conf_level:
/// confidence with which the yield is proved. asked: the yield that the study asks for; 0: none. Precondition: some
/// errors are drawn from measured parts.
std::string few_parts_text(const StoredResult& result, double conf_level, double asked);

/// A warning, as a clause, that measured parts leave the wanted yield open, with advice. Empty if they do not
/// (YieldVerdict::parts_leave_open()).
std::string open_parts_text(const YieldVerdict& yield);

/// The statistic of the draws that is judged (Judge), as words that follow PASS or FAIL: " by root mean square". Empty
/// for an evaluation, which judges each row. Precondition: limits are not judged by the yield.
std::string judged_text(const LimitVerdicts& verdicts);

/// A clause on the draws that are not within the limit: "; 9.4 % of the samples are not within it". Empty for an
/// evaluation.
std::string not_within_text(const LimitVerdicts& verdicts, const LimitVerdict& one);

/// A table with PASS or FAIL and the value for each limit. If a yield is judged (Judge::yield), it is yield_table().
/// None if the study states no limits.
std::optional<Table> limits_table(const StoredResult& result);

/// A result, and the response by which its errors are ranked. Precondition: the result has this response.
struct RankedResult {
  const StoredResult& result;  ///< must outlive this object
  std::string path;            ///< path of the result file
  std::string response;        ///< name of the response
  SolveCounts solves;          ///< how all solves ended
};

/// Two rankings of the same errors by their effects. Each ranking uses the sizes that the errors have in the study of
/// its result.
struct TwoRankings {
  Table table;                       ///< rank and effect of each error in the results A and B, in the order of A
  double tau;                        ///< Kendall's tau of the effects; NaN if not known
  std::vector<std::string> remarks;  ///< sentences on tau, on different metrics, and on what is left out
};

/// Throws InputError with the path of B if the results are of different kinds or have no response in common.
void check_comparable(const StoredResult& a, const std::string& path_a, const StoredResult& b,
                      const std::string& path_b);

/// Returns true if two results have different metrics. Returns false if at least one of them has no metric.
bool differ_in_metric(const StoredResult& a, const StoredResult& b);

/// One line about one of several results: "A: title (path); metric: ...; ranked by gap; 5 of 1 000 solves did not
/// converge". role: the words in front of the response.
std::string ranked_text(char letter, const RankedResult& ranked, std::string_view role = "ranked by");

/// The summary and the tables of a result as one JSON object, for programs:
///
/// - kind, model, title, poesy_version, git_commit, content_sha256
/// - metric: name, null if the mechanism has no metric; metric_points: [[x, y, z]] in m, null if the metric has none
/// - seed, null if the study has none; poses: their number
/// - candidate_poses: number, null if not known; rejected_poses: [{reason, count}]
/// - errors, responses: [{name, unit (SI), description}]
/// - solves: total, not_converged, by_status: {converged, stagnated, ...}
/// - run: created, threads, wall_seconds
/// - tables: [{name, caption, columns: [{name, heading, unit, kind}], rows, shown, notes}]
///
/// Each row of `rows` is an object that has a value under the name of each column. A number is in the unit of its
/// column, and reads back as the same double; it is null if the cell has none. Text is unchanged. `shown` has the texts
/// of the same cells, a list for each row. Invalid UTF-8 is replaced. solves: how all solves of the result ended.
std::string json_of(const StoredResult& result, const SolveCounts& solves, std::span<const Table> tables);

/// The comparison of two or more results of one kind.
struct ComparedResults {
  /// Tables of figures of merit, of settings that differ, and of errors or other items.
  std::vector<Table> tables = {};
  std::optional<double> tau = {};  ///< Kendall's tau of two rankings, NaN if not known; none if nothing was ranked
  std::vector<std::string> remarks = {};  ///< sentences on the comparison
};

/// A comparison as one JSON object:
///
///     results: [{path, response (by which errors are ranked), and the summary that json_of() of a result has}, ...]
///     kendall_tau (null if not known, or if nothing is ranked), remarks: [sentences]
///     tables: as in json_of() of a result
///
/// The results are in order, with A first.
std::string json_of(std::span<const RankedResult> results, const ComparedResults& compared);

std::string json_of(const Table& table);  ///< One table as JSON, in the form that json_of() of a result describes.

std::string models_text(const Catalog& catalog);  ///< A list of all mechanisms, with a line for each.

/// A description of one mechanism: geometry, pose coordinates, workspace, factors, factor sets, responses, additional
/// outputs.
std::string model_text(const CatalogEntry& entry);

}  // namespace poesy
