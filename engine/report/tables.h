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

/// A few lines on what was run and how long it took, wrapped at `width` by prose_of(). tally: how the result's solves
/// ended.
std::string summary_text(const StoredResult& result, const SolveTally& tally, std::size_t width);

/// Returns true if a response varies, or if the result does not say.
bool varies(const StoredResult& result, std::size_t response);

/// A sentence without full stop which says that this response does not vary, and what follows from that.
std::string constant_text(const NamedUnit& response);

/// The responses in their order, except that those that do not vary come last.
std::vector<std::size_t> varying_first(const StoredResult& result, std::vector<std::size_t> responses);

/// The response by which errors are ranked by default. It is one of the responses of the headline that vary, or of all
/// responses of the headline if none varies. If the first of these has a limit, or is the displacement of the tool or
/// the platform, it is taken. Otherwise the first one that is a length is taken, or the first one if none is a length.
std::string default_ranking(const StoredResult& result);

/// The order in which tables show ranked errors, the largest first.
enum class RowOrder {
  effect,        ///< index x sigma: the effect of the error if it has its size in the study
  index,         ///< sensitivity index in the unit shown
  name,          ///< name, a to z
  study,         ///< order of the study
  not_converged  ///< share of samples that did not converge
};

/// The words that users write, in the order of RowOrder.
inline constexpr std::array<std::string_view, 5> kRowOrders{"effect", "index", "name", "order", "not-converged"};

/// How tables show a result.
struct TableOptions {
  std::string ranked_by = {};         ///< response by which errors are ranked, if the kind ranks errors
  RowOrder order = RowOrder::effect;  ///< order of ranked errors
};

/// Keeps the first `most` rows of ranked tables. If rows are removed, a note states how many.
void keep_first(std::size_t most, std::span<Table> tables);

/// The quantities of a result that converge as the number of samples grows.
struct Settling {
  std::string_view quantities;         ///< name of the quantities: "global indices"
  std::vector<std::string> slots;      ///< [P] names of the errors that have quantities
  std::vector<std::size_t> responses;  ///< indices of the responses that decide when adaptive samples end
};

/// A table of how adaptive samples converged: the number of quantities that reached the interval that the study asks
/// for, the samples that they took, and the quantities that did not reach it. None if the number of samples was fixed.
std::optional<Table> convergence_table(const StoredResult& result, const Settling& settling);

/// A sentence with the number of quantities that did not reach the interval that the study asks for. Empty if all did,
/// or if the number of samples was fixed.
std::string not_settled_text(const StoredResult& result, const Settling& settling);

/// The verdict on the limit of a response; null if the study does not limit it.
const LimitVerdict* verdict_on(const StoredResult& result, std::size_t response);

/// A table of the yield with its interval and its verdict, then of the yield under each limit alone. Precondition:
/// verdicts.yield is set.
Table yield_table(const StoredResult& result, const LimitVerdicts& verdicts);

/// A table of errors that are drawn from measured parts: the number of parts, and the scatter of parts and draws. None
/// if there are no such errors.
std::optional<Table> measured_table(const StoredResult& result);

/// A table of errors whose mean the study states, or which a machine draws anew at each pose. None if there are no such
/// errors.
std::optional<Table> stated_table(const StoredResult& result);

/// Sentences on the largest yield that the smallest number of measured parts can show. asked: the yield that the study
/// asks for. Precondition: some errors are drawn from measured parts.
std::string few_parts_text(const StoredResult& result, double conf_level, double asked);

/// A table with PASS or FAIL for each limit, and with its value. None if the study states no limits. For Judge::yield
/// it is yield_table().
std::optional<Table> limits_table(const StoredResult& result);

/// A result, and the response by which its errors are ranked. The result must have this response.
struct RankedResult {
  const StoredResult& result;  ///< must outlive this object
  std::string path;            ///< path of the result file
  std::string response;        ///< name of the response
  SolveCounts solves;          ///< how all solves ended
};

/// Two rankings of the same errors by their effects, with the sizes of the errors in each study.
struct TwoRankings {
  Table table;  ///< rank and effect of each error in the results A and B, in the order for A that was asked for
  double tau;   ///< Kendall's tau of the effects; NaN if not known
  std::vector<std::string> remarks;  ///< sentences on tau, on how the metrics differ, and on what is left out
};

/// Throws InputError with the path of B if the results are of different kinds or have no response in common.
void check_comparable(const StoredResult& a, const std::string& path_a, const StoredResult& b,
                      const std::string& path_b);

/// Returns true if two results have different metrics. Returns false if one of them has no metric.
bool differ_in_metric(const StoredResult& a, const StoredResult& b);

/// One line about one of several results: "A: title (path); metric: ...; ranked by gap; 5 of 1 000 solves did not
/// converge". role: the words before the response in the line.
std::string ranked_text(char letter, const RankedResult& ranked, std::string_view role = "ranked by");

/// The summary and the tables of a result as one JSON object, for programs:
///
/// - kind, model, title, poesy_version, git_commit, content_sha256
/// - metric: name, null if nothing is weighed; metric_points: [[x, y, z]] in m, null if the metric has none
/// - seed, if the study has one; poses
/// - errors, responses: [{name, unit (SI), description}]
/// - solves: total, not_converged, by_status: {converged, stagnated, ...}
/// - run: created, threads, wall_seconds
/// - tables: [{name, caption, columns: [{name, heading, unit, kind}], rows, shown, notes}]
///
/// A row of `rows` has a value for the name of each column. Numbers are in the column's unit and read back as the same
/// double, null if there is none; text is unchanged. `shown` has the texts of the same cells, a list for each row.
/// Invalid UTF-8 is replaced. solves: how all solves of the result ended.
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
///     results: [{path, response (by which errors rank), and json_of() of the result without its tables}, ...]
///     kendall_tau (null if not known, or if nothing is ranked), remarks: [sentences]
///     tables: as json_of() gives them
///
/// The results are in order, with A first.
std::string json_of(std::span<const RankedResult> results, const ComparedResults& compared);

std::string json_of(const Table& table);  ///< One table as JSON, in the form of `tables` above.

std::string models_text(const Catalog& catalog);  ///< A list of all mechanisms, with a line for each.

/// A description of one mechanism: geometry, pose coordinates, workspace, factors, factor sets, responses, additional
/// outputs.
std::string model_text(const CatalogEntry& entry);

}  // namespace poesy
