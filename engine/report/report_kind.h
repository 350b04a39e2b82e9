#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/html/parts.h"
#include "engine/report/html/robot.h"
#include "engine/report/merits.h"
#include "engine/report/solves.h"
#include "engine/report/tables.h"

namespace poesy {

/// Facts about the study of one result, which depend on the kind of study. Reports use these facts in the sentences
/// that describe the run.
struct StudyWords {
  bool draws = false;        ///< true if errors were drawn from distributions
  bool from_tables = false;  ///< true if errors, or measurements of them, came from a table
  bool own_poses = true;     ///< true if the study selects the poses, false if they came from a table
  /// True if errors were fitted to measurements. The poses of the result are then those at which the remaining pose
  /// errors are predicted.
  bool fitted = false;
  std::string samples = {};  ///< number of samples at each pose, as text; empty: the number that the study states
  std::vector<std::string> sizes = {};  ///< sizes of the errors as text, if the errors are not drawn
  /// Sizes with which errors are drawn, as text, if the kind of study chose them itself; empty: the sizes are those of
  /// [errors].
  std::vector<std::string> drawn = {};
  std::optional<std::uint64_t> seed = {};  ///< seed of the samples, if it differs from the seed in [run]
  /// Name of the design that the picture of the mechanism shows; empty: the result has only one.
  std::string design = {};
};

/// What a kind of study adds to the description of the method for a paper.
struct MethodWords {
  std::string text;                            ///< sentences on the method of the kind
  std::vector<std::string_view> sources = {};  ///< publications behind the method, as BibTeX (report/sources.h)
};

/// What a report needs from a kind of study. Each kind of study has one such object. Members with the default nullptr
/// are optional.
struct ReportKind {
  SolveTally (*tally)(const StoredResult&);                                ///< how the solves ended
  std::vector<Table> (*tables)(const StoredResult&, const TableOptions&);  ///< makes the tables that only this kind has
  /// Compares the rankings of errors in two results; null: the kind ranks no errors.
  TwoRankings (*two_rankings)(const RankedResult& a, const RankedResult& b, RowOrder order) = nullptr;
  /// The figures of merit by which results are compared; null: the kind has none. response: the response to which a
  /// figure of merit such as a root mean square belongs; empty: only figures of merit that belong to no response, such
  /// as a yield.
  std::vector<Merit> (*merits)(const StoredResult&, std::string_view response) = nullptr;
  bool sorts = false;  ///< true if the kind's tables of ranked errors support every RowOrder
  /// The quantities that become more exact with the number of samples; null: the kind has no samples.
  Settling (*settling)(const StoredResult&) = nullptr;
  StudyWords (*words)(const StoredResult&);              ///< texts for the list of what was run
  MethodWords (*method)(const StoredResult&) = nullptr;  ///< the method, for a paper; null: the kind adds nothing
  /// Adds the kind's own warnings; null: it has none.
  void (*warn)(const StoredResult&, std::vector<std::string>& list) = nullptr;
  /// Notes on limits far from the judged values (report/far_limits.h); null: the kind judges no limits.
  std::vector<std::string> (*far_limits)(const StoredResult&) = nullptr;
  /// The summary at the top of a report. The report appends a sentence on how the solves ended to the line "How sure".
  Answer (*answer)(const StoredResult&);
  ShownCells (*shown_cells)(const StoredResult&);  ///< the responses and poses that figures by pose show
  /// Adds the sections that only this kind has. tables: the tables of the result (result_tables()).
  void (*page)(const StoredResult&, std::span<const Table> tables, Page&);
  /// Adds sections for which the study's machines are solved again; null: the kind has none. It is called after `page`,
  /// if the study and the model could be made from the result file and the model fits the result (has_pictures()).
  void (*solved_page)(const ReportedResult&, Page&) = nullptr;
  /// The shares of the errors, which colour the picture of the mechanism; null: none.
  ErrorShares (*error_shares)(const StoredResult&) = nullptr;
  /// The root mean square of a response over the errors at each pose, SI; null: the kind has no such values.
  std::vector<double> (*rms_at_poses)(const StoredResult&, std::size_t response) = nullptr;
  /// The numbers of a result that can be compared with those of the result `other`.
  Comparable (*comparable)(const StoredResult&, const StoredResult& other);
  /// Adds the sections that compare two results; null: add_comparison() adds them.
  void (*compare)(const ReportedResult& a, const ReportedResult& b, const Comparison& compared, Page&) = nullptr;
};

/// The tables of a result of this kind: the limits (unless the kind's own tables include them), the kind's own tables,
/// the features of the drawing (placed after the first table), the errors drawn from measured parts, the errors with a
/// stated mean or new draws at each pose, and the convergence of adaptive samples.
std::vector<Table> result_tables(const ReportKind& kind, const StoredResult& result, const TableOptions& options);

/// The report of one result, or the comparison of two or more, as one HTML document that needs no other file. It says
/// what was run, and has warnings, figures with their numbers, and tables. It can be read without JavaScript, which
/// only draws the figures. Text from files is escaped. Throws InputError if the results cannot be compared: if they are
/// of different kinds, have no response in common, or, if there are two, have no items (such as errors or cases) in
/// common. Precondition: there is at least one result, and `kind` is the kind of the first one.
std::string html_report(const ReportKind& kind, std::span<const ReportedResult> results);

}  // namespace poesy
