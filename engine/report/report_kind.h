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

/// Facts about the study of a result that its kind states, for the list of what was run.
struct StudyWords {
  bool draws = false;        ///< true if errors were drawn from distributions
  bool from_tables = false;  ///< true if errors, or measurements of them, came from a table
  bool own_poses = true;     ///< true if the poses are those of the study
  /// True if errors were fitted to measurements. The poses of the result are then those of a prediction.
  bool fitted = false;
  std::string samples = {};             ///< number of samples at each pose, as text; empty: that of the study
  std::vector<std::string> sizes = {};  ///< sizes of the errors, if they are not drawn
  /// Sizes with which errors are drawn, if the kind chose them itself; empty: those of [errors].
  std::vector<std::string> drawn = {};
  std::optional<std::uint64_t> seed = {};  ///< the seed of the samples, if it differs from [run] seed
};

/// What a kind adds to the description of the method for a paper.
struct MethodWords {
  std::string text;                            ///< sentences on the method of the kind
  std::vector<std::string_view> sources = {};  ///< BibTeX entries of the publications behind it (report/sources.h)
};

/// What a report needs from a kind of study. Each kind of study has one such object. A member that is null has no
/// effect.
struct ReportKind {
  SolveTally (*tally)(const StoredResult&);                                ///< how the solves ended
  std::vector<Table> (*tables)(const StoredResult&, const TableOptions&);  ///< makes the tables that only this kind has
  /// Compares the rankings of errors in two results; null: the kind ranks no errors.
  TwoRankings (*two_rankings)(const RankedResult& a, const RankedResult& b, RowOrder order) = nullptr;
  /// The figures of merit by which results are compared; null: the kind has none. response: a response of the result;
  /// totals over the errors are those of this response; empty: no totals.
  std::vector<Merit> (*merits)(const StoredResult&, std::string_view response) = nullptr;
  bool sorts = false;  ///< true if the kind's tables of ranked errors support every RowOrder
  /// The quantities that become more exact with the number of samples; null: the kind has no samples.
  Settling (*settling)(const StoredResult&) = nullptr;
  StudyWords (*words)(const StoredResult&);              ///< texts for the list of what was run
  MethodWords (*method)(const StoredResult&) = nullptr;  ///< the method, for a paper; null: the kind adds nothing
  /// Adds the kind's own warnings; null: it has none.
  void (*warn)(const StoredResult&, std::vector<std::string>& list) = nullptr;
  /// The summary at the top of a report. The report appends to the line "How sure" how the solves ended.
  Answer (*answer)(const StoredResult&);
  ShownCells (*shown_cells)(const StoredResult&);  ///< the responses and poses that figures by pose show
  /// Adds the kind's sections, with its tables.
  void (*page)(const StoredResult&, std::span<const Table> tables, Page&);
  /// Adds sections for which the study's machines are solved again; null: the kind has none. It is called after `page`
  /// if study and model are known and the model has the result's poses.
  void (*solved_page)(const ReportedResult&, Page&) = nullptr;
  /// Shares of the errors that colour the picture of the mechanism; null: none.
  ErrorShares (*error_shares)(const StoredResult&) = nullptr;
  /// The root mean square of a response over the errors at each pose, SI; null: the kind has no such values.
  std::vector<double> (*rms_at_poses)(const StoredResult&, std::size_t response) = nullptr;
  /// The numbers of a result that are compared with those of the result `other`.
  Comparable (*comparable)(const StoredResult&, const StoredResult& other);
  /// Adds the sections that compare two results; null: add_comparison() adds them.
  void (*compare)(const ReportedResult& a, const ReportedResult& b, const Comparison& compared, Page&) = nullptr;
};

/// The tables of a result of this kind: the limits (unless the kind's own tables include them), the features of the
/// drawing, the kind's own tables, and the convergence of adaptive samples.
std::vector<Table> result_tables(const ReportKind& kind, const StoredResult& result, const TableOptions& options);

/// The report of one result, or the comparison of two or more, as one HTML document that needs no other file. It has
/// what was run, warnings, figures with their numbers, and tables. It can be read without JavaScript, which only draws
/// the figures. Text from files is escaped. Throws InputError if results cannot be compared: if they are of different
/// kinds, have no response in common, or, if there are two, have no errors, cases or sources in common. Precondition:
/// there is at least one result, and `kind` is the kind of the first one.
std::string html_report(const ReportKind& kind, std::span<const ReportedResult> results);

}  // namespace poesy
