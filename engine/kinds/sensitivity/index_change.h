#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/files/result_file.h"
#include "engine/kinds/sensitivity/tolerance_files.h"
#include "engine/report/table.h"

/// Whether the indices of a sensitivity result hold for errors of other sizes (kinds/sensitivity/linearity.h).
namespace poesy {

/// Whether the result says it; those of older versions do not.
bool has_index_changes(const StoredResult& result);

/// By which share the index changes where the error is a tenth as large, for a percent_column.
Cell change_cell(double change);

/// The errors that have an effect on the response and whose index changes with size, the largest change first.
/// Precondition: has_index_changes.
std::vector<std::size_t> changing_errors(const StoredResult& result, std::size_t response);

/// For how many of the errors that have an effect the response's index holds, and for which not, the largest change
/// first: "the index on gap holds at a tenth of the size, within 2 %: 15 of 25 errors with an effect; not for
/// epsilon_3_4_z (-99.1 %), ...". Precondition: has_index_changes.
std::string index_change_text(const StoredResult& result, std::size_t response);

/// Beyond this ratio to the size studied, in either direction, a tolerance is of another size.
inline constexpr double kSameSize = 2.0;

/// Which errors have an index that changes with size and a tolerance of another size than what was studied, by either
/// way to share a limit, and at which size to study them: "2 errors have an index on gap that changes with size, by so
/// much at a tenth of it, and a tolerance of another size than was studied: epsilon_3_4_z (-99.1 %; study it at 0.02
/// deg), ...", the largest change first, ten at the most. The size is where the tolerance will be about the size, if
/// the index grows with a power of it. Empty where there is none, or the result does not say how indices change.
std::string wrong_sizes_text(const StoredResult& result, const ResponseTolerances& tolerances);

}  // namespace poesy
