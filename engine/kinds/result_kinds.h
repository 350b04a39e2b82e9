#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/files/file_kind.h"
#include "engine/kinds/tolerances.h"
#include "engine/report/report_kind.h"
#include "engine/run/runner.h"

/// What results of each kind of study are, for files, reports and commands.
namespace poesy {

/// Solves of errors that were given and not drawn: how they are addressed, and their errors. Refers to the result.
struct GivenErrors {
  std::string_view word;           ///< for what a name stands: "case"
  std::vector<std::string> names;  ///< that there are
  std::size_t samples = 0;         ///< solves with a number at each pose; 0: the name's position is its row of errors
  Pairing pairing = Pairing::every_pose_with_every_row;  ///< of poses with rows: a row is a sample, or a pose
  std::span<const double> values;                        ///< [rows x P] SI
};

/// A kind of result.
struct ResultKind {
  const FileKind& file;      ///< how files keep it
  const ReportKind& report;  ///< how tables and reports show it
  /// Its solves one by one; null: they were drawn, or they have no addresses.
  GivenErrors (*given_errors)(const StoredResult& result) = nullptr;
  SetTolerances set_tolerances = nullptr;  ///< null: it has no tolerances
};

/// The kind of this name; null where there is none.
const ResultKind* find_result_kind(std::string_view name);

/// The kind of a result. Precondition: there is such a kind.
const ResultKind& kind_of(const StoredResult& result);

/// "'NAME'" of the kinds that rank errors, for messages.
std::string kinds_that_rank();

/// The kinds whose solves can be replayed, for messages.
inline constexpr std::string_view kReplayable = "sensitivity, Monte Carlo or evaluate";

/// The rows of all kinds, each in its folder.
/// @{
extern const FileKind kSensitivityFile;
extern const ReportKind kSensitivityReport;
extern const FileKind kMonteCarloFile;
extern const ReportKind kMonteCarloReport;
extern const FileKind kIdentificationFile;
extern const ReportKind kIdentificationReport;
extern const FileKind kCouplingFile;
extern const ReportKind kCouplingReport;
extern const FileKind kEvaluationFile;
extern const ReportKind kEvaluationReport;
/// @}

}  // namespace poesy
