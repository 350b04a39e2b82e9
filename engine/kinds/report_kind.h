#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/html/comparison.h"
#include "engine/report/html/page.h"
#include "engine/report/html/parts.h"
#include "engine/report/solves.h"
#include "engine/report/tables.h"

namespace poesy {

/// The quantities of a sampled result that settle with the number of samples. Refers to the result.
struct Settling {
  std::string_view quantities;         ///< what they are: "global indices"
  std::vector<std::string> slots;      ///< [P] names of what has quantities: errors
  std::vector<std::size_t> responses;  ///< those that decide when a study with adaptive samples ends
  const ConvergenceResult* adaptive;   ///< none where the number of samples is fixed
};

/// What a kind of study says of its errors in the list of what was run.
struct StudyWords {
  bool draws = false;                   ///< whether errors were drawn from distributions
  bool from_tables = false;             ///< whether poses and errors came from tables and not from the study
  std::string samples = {};             ///< at each pose; empty: what the study sets
  std::vector<std::string> sizes = {};  ///< of the errors, where they are not drawn
};

/// What a report asks of a kind of study. Each kind makes its tables in NAME_tables.cpp and all else in
/// html/NAME_page.cpp.
struct ReportKind {
  std::string_view name;                                                   ///< StoredResult::kind
  SolveTally (*tally)(const StoredResult&);                                ///< how its solves ended
  std::vector<Table> (*tables)(const StoredResult&, const TableOptions&);  ///< all of them
  Settling (*settling)(const StoredResult&) = nullptr;                     ///< null: it is not sampled
  StudyWords (*words)(const StoredResult&);                                ///< for the list of what was run
  /// Adds warnings of its own; null: it has none.
  void (*warn)(const StoredResult&, std::vector<std::string>& list) = nullptr;
  ShownCells (*shown_cells)(const StoredResult&);                            ///< what its figures by pose show
  void (*page)(const StoredResult&, std::span<const Table> tables, Page&);   ///< adds its sections, with its tables
  Comparable (*comparable)(const StoredResult&, const StoredResult& other);  ///< what it compares with the other
  /// Adds the sections of two results; null: add_comparison.
  void (*compare)(const ReportedResult& a, const ReportedResult& b, const Comparison& compared, Page&) = nullptr;
};

/// All kinds.
/// @{
extern const ReportKind kSensitivityReport;
extern const ReportKind kMonteCarloReport;
extern const ReportKind kIdentificationReport;
extern const ReportKind kCouplingReport;
extern const ReportKind kEvaluationReport;
/// @}

/// The kind of a result; what no kind is called is an evaluation.
const ReportKind& kind_of(const StoredResult& result);

}  // namespace poesy
