#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/kind.h"
#include "engine/kinds/result_file.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/model/model.h"
#include "engine/report/display.h"
#include "engine/report/table.h"
#include "engine/result/result_parts.h"
#include "engine/stats/tolerance.h"
#include "engine/storage/output_folder.h"

namespace poesy {

/// Tolerances for one response of a sensitivity result, within a limit on it if there is one.
struct ResponseTolerances {
  std::size_t response;                  ///< position among the result's
  Tolerances all;                        ///< without a limit
  std::optional<LimitTolerances> limit;  ///< within the limit, if there is one
  /// Positions of errors for which the size studied is proposed; see negligible_errors().
  std::vector<std::size_t> negligible = {};
  std::string caveat = {};  ///< why they may not hold, for tables and studies; empty if no reason is known
};

/// Sets the members that tolerances need: limb, reference and mean_square_bound. The reference of each response is the
/// one that the study states, or else the error of smallest effect, with one unit in which people read it as tolerance.
void set_references(const Study& study, SensitivityResult& found);

/// Writes the group /tolerances, which has all that a program needs to set tolerances.
/// @{
void write_tolerance_group(ResultBuilder& result, const Study& study, const SensitivityResult& found);
/// Reads the group /tolerances. Throws h5::Error if a reference is none of these factors.
void read_tolerance_group(const h5::File& file, const std::vector<NamedUnit>& factors, SensitivityResult& found);
/// @}
/// Adds tolerances_RESPONSE.csv.
void append_tolerance_tables(CsvTables& tables, const StoredResult& result);
/// Adds the section of a report.
void add_tolerance_section(const StoredResult& result, Page& page);

/// The lists of tolerances to be used: with a limit, those of both ways to share it; without, those of equal effect.
/// Refers to the tolerances.
std::vector<std::span<const double>> proposed_tolerances(const ResponseTolerances& tolerances);

/// The largest sensible tolerance for each error of a sensitivity result, SI: a quarter of the part to which the error
/// belongs (Model::error_bound). Throws InputError if the stored study cannot be read with this catalog.
std::vector<double> largest_tolerances(const StoredResult& result, const Catalog& catalog);

/// The tolerances of one response, relative to the reference that the result states.
ResponseTolerances stored_tolerances(const StoredResult& result, std::size_t response);

/// Writes tolerances.csv for programs that assign tolerances. The folder is made if missing. Columns:
///
///     factor, kind (linear or angular), limb, unit (SI), display_unit, index_unit, studied_as (its distribution in the
///     study) | index, index_ci_low, index_ci_high, mean_square_share, index_change (as
///     /sensitivity/index_change), with a limit limit_equal_effect and limit_equal_tolerance, and equal_effect, which
///     keeps no limit, in `unit`; then the tolerances once more in `display_unit`: equal_effect_display ...
///
/// This is the only table in which more than the first column is text. A tolerance is the standard deviation of a
/// normal error, whatever distribution was studied; "inf" means that the error has no effect alone. Returns the path.
/// Throws FileError.
std::string write_tolerances(const std::string& folder, const StoredResult& result,
                             const ResponseTolerances& tolerances);

/// Claims the files that write_tolerances(), and with a limit write_confirmation(), are going to write. Throws
/// InputError if a file that poesy did not write would be replaced.
void claim_tolerance_files(OutputFolder& folder, const StoredResult& result, const ResponseTolerances& tolerances,
                           const Catalog& catalog);

/// The studies that test tolerances.
struct Confirmation {
  std::vector<std::string> paths;       ///< the studies that were written
  std::vector<std::string> at_largest;  ///< "delta_1_0_y is 15 mm", each error once
};

/// Writes Monte Carlo studies that confirm or refute the tolerances within the limit, confirm_equal_effect.toml and
/// confirm_equal_tolerance.toml: the study of the result with each of its errors normal with its tolerance. Poses that
/// came from a file are written beside them as confirm_poses.csv. Each study states its limit ([analysis.limits],
/// judged by the root mean square), so that running it says PASS or FAIL, and begins with the caveat as a comment. A
/// tolerance above largest_tolerances() is cut to it. Precondition: tolerances.limit. Throws FileError; InputError when
/// the stored study cannot be read with this catalog.
Confirmation write_confirmation(const std::string& folder, const StoredResult& result,
                                const ResponseTolerances& tolerances, const Catalog& catalog);

/// The table of the tolerances of every error for one response, in mm and deg. Notes state the reference, the limit,
/// and the root mean square that is predicted for the equal-effect tolerances.
Table tolerance_table(const StoredResult& result, const ResponseTolerances& tolerances);

/// Sets tolerances by the indices of a sensitivity result; see SetTolerances.
std::string set_sensitivity_tolerances(const StoredResult& result, const TolerancesOptions& options,
                                       const Catalog& catalog, std::size_t width);

}  // namespace poesy
