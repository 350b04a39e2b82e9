#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/files/file_kind.h"
#include "engine/files/result_parts.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/report_kind.h"
#include "engine/report/tables.h"
#include "engine/run/result.h"
#include "engine/stats/tolerance.h"

/// What a file keeps of a sensitivity study.
namespace poesy {

/// What a sensitivity result says, read back. Its failures and its convergence are those of StoredResult; its
/// `background` is empty in files of older versions.
struct StoredSensitivity : SensitivityResult {
  std::vector<std::uint64_t> factor_limb;                          ///< [P] empty in files of older versions
  std::vector<std::optional<ReferenceError>> tolerance_reference;  ///< [R] likewise; none where no error has an effect
  std::vector<double> mean_square_bound;                           ///< [R] Response::mean_square_bound; likewise
  std::string separation_measure;                                  ///< what length `separation` speaks of
  std::vector<std::string> published_class;  ///< [P] the literature's class of each error, where that is separated
  std::vector<std::string> fidelities;       ///< the two that `fidelity` compares
};

/// Precondition: a sensitivity result.
inline const StoredSensitivity& sensitivity_of(const StoredResult& result) {
  return found_of<StoredSensitivity>(result);
}

/// What a program that sets tolerances needs, without the rest: /tolerances.
/// @{
void add_tolerances(ResultBuilder& result, const Study& study, const SensitivityResult& found);
void read_tolerances(const h5::File& file, const std::vector<NamedUnit>& factors, StoredSensitivity& found);
/// @}
/// tolerances_RESPONSE.csv; none for a file of an older version.
void append_tolerance_tables(CsvTables& tables, const StoredResult& result);

/// What calibration can remove of each error's effect: /separation.
/// @{
void add_separation(ResultBuilder& result, const Study& study, const std::optional<SeparationResult>& found);
void read_separation(const h5::File& file, StoredSensitivity& found);
/// @}
/// separation.csv and its tables by pose.
void append_separation_tables(CsvTables& tables, const StoredResult& result);

/// A second fidelity beside the first: /fidelity.
/// @{
void add_fidelity(ResultBuilder& result, const Study& study, const std::optional<FidelityResult>& found);
void read_fidelity(const h5::File& file, StoredSensitivity& found);
/// @}
/// fidelity.csv and fidelity_not_converged.csv.
void append_fidelity_tables(CsvTables& tables, const StoredResult& result);

/// With the errors in the order asked for:
/// - ranked: the errors with the effect on the response that ranks (global index x sigma), its index and interval,
///   those of the headline's other responses, the share of samples not converged, and the published index where that
///   is not the one shown, in mm and deg;
/// - separation: what calibration can remove of each error's effect, where the result says it;
/// - fidelity: the largest discrepancy of two fidelities and the verdict, where the study compares two;
/// - convergence.
std::vector<Table> sensitivity_tables(const StoredResult& result, const TableOptions& options);

/// How files keep what such a study found, and how reports show it.
/// @{
extern const FileKind kSensitivityFile;
extern const ReportKind kSensitivityReport;
/// @}

}  // namespace poesy
