#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/html/parts.h"
#include "engine/report/html/robot.h"
#include "engine/report/solves.h"
#include "engine/report/tables.h"

namespace poesy {

/// What a kind of study says of its errors in the list of what was run.
struct StudyWords {
  bool draws = false;                   ///< whether errors were drawn from distributions
  bool from_tables = false;             ///< whether poses and errors came from tables and not from the study
  std::string samples = {};             ///< at each pose; empty: what the study sets
  std::vector<std::string> sizes = {};  ///< of the errors, where they are not drawn
};

/// What a report asks of a kind of study: a row for each kind.
struct ReportKind {
  SolveTally (*tally)(const StoredResult&);                                ///< how its solves ended
  std::vector<Table> (*tables)(const StoredResult&, const TableOptions&);  ///< those that not every kind has
  /// Puts the errors of two results in order beside each other; null: it ranks nothing.
  TwoRankings (*two_rankings)(const RankedResult& a, const RankedResult& b, RowOrder order) = nullptr;
  bool sorts = false;                                   ///< whether its ranked tables come in any RowOrder
  Settling (*settling)(const StoredResult&) = nullptr;  ///< null: it is not sampled
  StudyWords (*words)(const StoredResult&);             ///< for the list of what was run
  /// Adds warnings of its own; null: it has none.
  void (*warn)(const StoredResult&, std::vector<std::string>& list) = nullptr;
  /// The lines that come first. A line "How sure" is continued with how the solves ended.
  Answer (*answer)(const StoredResult&);
  ShownCells (*shown_cells)(const StoredResult&);                           ///< what its figures by pose show
  void (*page)(const StoredResult&, std::span<const Table> tables, Page&);  ///< adds its sections, with its tables
  ErrorShares (*error_shares)(const StoredResult&) = nullptr;  ///< by which its picture is coloured; null: by none
  Comparable (*comparable)(const StoredResult&, const StoredResult& other);  ///< what it compares with the other
  /// Adds the sections of two results; null: add_comparison.
  void (*compare)(const ReportedResult& a, const ReportedResult& b, const Comparison& compared, Page&) = nullptr;
};

/// The tables of a result of this kind: its limits, unless the kind has that table itself, the kind's own, how adaptive
/// samples came to their end.
std::vector<Table> result_tables(const ReportKind& kind, const StoredResult& result, const TableOptions& options);

/// The report of one result, or the comparison of two, as one HTML document that needs no other file: what was run,
/// warnings, figures with their numbers, tables. It reads without JavaScript, which draws the figures alone. Whatever
/// comes from a file is escaped. Throws InputError for two results that have nothing to be compared: different kinds,
/// mechanisms, or neither errors, cases or sources, nor responses in common.
/// Precondition: one result or two; kind is that of the first.
std::string html_report(const ReportKind& kind, std::span<const ReportedResult> results);

}  // namespace poesy
