#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/html/parts.h"
#include "engine/report/html/robot.h"
#include "engine/report/merits.h"
#include "engine/report/solves.h"
#include "engine/report/tables.h"

namespace poesy {

/// What a kind of study adds to the list of what was run.
struct StudyWords {
  bool draws = false;                   ///< whether errors were drawn from distributions
  bool from_tables = false;             ///< whether poses and errors came from tables instead of the study
  std::string samples = {};             ///< samples at each pose; empty: the number in the study
  std::vector<std::string> sizes = {};  ///< sizes of the errors, if they are not drawn
};

/// What a report needs from a kind of study. Each kind has one such row.
struct ReportKind {
  SolveTally (*tally)(const StoredResult&);                                ///< how its solves ended
  std::vector<Table> (*tables)(const StoredResult&, const TableOptions&);  ///< tables that only this kind has
  /// Compares the rankings of errors in two results; null: it ranks nothing.
  TwoRankings (*two_rankings)(const RankedResult& a, const RankedResult& b, RowOrder order) = nullptr;
  /// Figures of merit, by which results are compared first. response: that of totals, which the result has; empty: no
  /// totals. Null: the kind has none.
  std::vector<Merit> (*merits)(const StoredResult&, std::string_view response) = nullptr;
  bool sorts = false;                                   ///< whether its ranked tables support every RowOrder
  Settling (*settling)(const StoredResult&) = nullptr;  ///< null: the kind is not sampled
  StudyWords (*words)(const StoredResult&);             ///< texts for the list of what was run
  /// Adds warnings of the kind; null: it has none.
  void (*warn)(const StoredResult&, std::vector<std::string>& list) = nullptr;
  /// The summary at the top. The line "How sure" is extended by how the solves ended.
  Answer (*answer)(const StoredResult&);
  ShownCells (*shown_cells)(const StoredResult&);  ///< the part of the numbers that its figures by pose show
  void (*page)(const StoredResult&, std::span<const Table> tables, Page&);  ///< adds its sections, with its tables
  ErrorShares (*error_shares)(const StoredResult&) = nullptr;  ///< shares that colour its picture; null: none
  Comparable (*comparable)(const StoredResult&,
                           const StoredResult& other);  ///< the part that is compared with the other result
  /// Adds the sections of two results; null: add_comparison() is used.
  void (*compare)(const ReportedResult& a, const ReportedResult& b, const Comparison& compared, Page&) = nullptr;
};

/// The tables of a result of this kind: its limits (unless the kind has that table itself), the kind's own, and the
/// convergence of adaptive samples.
std::vector<Table> result_tables(const ReportKind& kind, const StoredResult& result, const TableOptions& options);

/// The report of one result, or the comparison of two or more, as one HTML document that needs no other file: what was
/// run, warnings, figures with their numbers, tables. It can be read without JavaScript, which only draws the figures.
/// Text from files is escaped. Throws InputError for results that cannot be compared: they have different kinds, or no
/// responses and no errors, cases or sources in common. Precondition: there is a result; kind is that of the first.
std::string html_report(const ReportKind& kind, std::span<const ReportedResult> results);

}  // namespace poesy
