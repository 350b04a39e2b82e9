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

namespace poesy::sensitivity {

/// Tolerances of the errors for one response of a sensitivity result. If there is a limit on the response, also the
/// tolerances with which it is kept.
struct ResponseTolerances {
  std::size_t response;                  ///< position of the response
  Tolerances all;                        ///< tolerances without a limit
  std::optional<LimitTolerances> limit;  ///< tolerances with which the limit is kept, if there is one
  /// Positions of errors that get the studied size as tolerance; see negligible_errors().
  std::vector<std::size_t> negligible = {};
  std::string caveat = {};  ///< reason why the tolerances may not hold, for tables and studies; empty if none is known
};

/// Sets the members of a result that tolerances need: `limb`, `reference` and `mean_square_bound`. The reference of
/// each response is the error that the study states, or else the error with the smallest effect, with one display unit
/// as tolerance.
void set_references(const Study& study, Result& found);

/// Writes the group /tolerances, which contains all data that a program needs to set tolerances.
/// @{
void write_tolerance_group(ResultBuilder& result, const Study& study, const Result& found);
/// Reads the group /tolerances. Throws h5::Error if a reference is not one of these factors.
void read_tolerance_group(const h5::File& file, const std::vector<NamedUnit>& factors, Result& found);
/// @}
/// Adds to `tables` a table tolerances_RESPONSE.csv for each response.
void append_tolerance_tables(CsvTables& tables, const StoredResult& result);
/// Adds to the page the section on tolerances.
void add_tolerance_section(const StoredResult& result, Page& page);

/// The lists of tolerances [errors] that are proposed: with a limit, those of LimitTolerances::equal_effect and
/// LimitTolerances::equal_tolerance; without a limit, Tolerances::equal_effect. The lists refer to the argument.
std::vector<std::span<const double>> proposed_tolerances(const ResponseTolerances& tolerances);

/// The largest sensible tolerance for each error of a sensitivity result, SI: a quarter of the dimension of the
/// mechanism that the error changes (Model::error_bound). Throws InputError if the stored study cannot be read with
/// this catalog.
std::vector<double> largest_tolerances(const StoredResult& result, const Catalog& catalog);

/// The tolerances for one response, without a limit, relative to the reference error in the result.
ResponseTolerances stored_tolerances(const StoredResult& result, std::size_t response);

/// Writes tolerances.csv for programs that assign tolerances. The folder is made if missing. Columns:
///
///     factor, kind (linear or angular), limb, unit (SI), display_unit, index_unit, studied_as (distribution of the
///     error in the study), index, index_ci_low, index_ci_high, mean_square_share, index_change (see
///     Result::index_change); then the tolerances in `unit`: limit_equal_effect and limit_equal_tolerance
///     (only with a limit), and equal_effect (which does not depend on a limit); then these tolerances in
///     `display_unit`: equal_effect_display ...
///
/// A tolerance is the standard deviation of a normal error, whatever distribution was studied; "inf" means that the
/// error alone has no effect. Returns the path. Throws FileError.
std::string write_tolerances(const std::string& folder, const StoredResult& result,
                             const ResponseTolerances& tolerances);

/// Announces to the folder (OutputFolder::claim) that tolerances.csv will be written, and with a limit the studies of
/// write_confirmation() and the files that they read. Throws InputError if a file would be replaced that poesy did not
/// write.
void claim_tolerance_files(OutputFolder& folder, const StoredResult& result, const ResponseTolerances& tolerances,
                           const Catalog& catalog);

/// The studies that test tolerances, as they were written.
struct Confirmation {
  std::vector<std::string> paths;       ///< paths of the studies
  std::vector<std::string> at_largest;  ///< errors whose tolerance was cut to the largest one, each once: "delta_1_0_y
                                        ///< is 15 mm"
};

/// Writes two Monte Carlo studies that confirm or refute the tolerances within the limit: confirm_equal_effect.toml and
/// confirm_equal_tolerance.toml. Both have the mechanism and the poses of the sensitivity study, but each error is
/// normal and has its tolerance as standard deviation. A tolerance above largest_tolerances() is cut to it. Poses that
/// came from a file are written beside the studies as confirm_poses.csv. Each study states its limit
/// ([analysis.limits], judged by the root mean square), so that a run reports PASS or FAIL. If tolerances.caveat gives
/// a reason why the tolerances may not hold, each study begins with this reason as a comment. Precondition:
/// tolerances.limit is set. Throws FileError; InputError if the stored study cannot be read with this catalog.
Confirmation write_confirmation(const std::string& folder, const StoredResult& result,
                                const ResponseTolerances& tolerances, const Catalog& catalog);

/// The table of the tolerances of every error for one response, in mm and deg. Notes state the limit; or without a
/// limit the reference, and the predicted root mean square with the tolerances of equal effect.
Table tolerance_table(const StoredResult& result, const ResponseTolerances& tolerances);

/// Sets tolerances from the indices of a sensitivity result; see SetTolerances.
std::string set_sensitivity_tolerances(const StoredResult& result, const TolerancesOptions& options,
                                       const Catalog& catalog, std::size_t width);

}  // namespace poesy::sensitivity
