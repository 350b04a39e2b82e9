#pragma once

#include <any>
#include <cstddef>
#include <string>
#include <vector>

#include "engine/kinds/kind.h"
#include "engine/result/result_file.h"

/// Functions on the results of every kind of study.
namespace poesy {

/// Writes the result of a study. found: of the kind's own type; it is moved, and its lists are freed as they are
/// written. The file is written under a temporary name, synced and renamed, so it appears complete or not at all.
/// Throws FileError and then leaves an existing file as it was. drawing: null, or what the features of a drawing do.
void write_result(const std::string& path, const Study& study, const SelectedPoses& poses, std::any found,
                  const RunFacts& facts, const DrawingResult* drawing = nullptr);

/// Reads a result file. Throws FileError if it is not one, or has another major version. A file that was changed after
/// it was written is read, and the result says so.
StoredResult read_result(const std::string& path);

/// Writes every table of a result as CSV into a folder; see engine/result/result_file.h.
std::vector<std::string> export_tables(const StoredResult& result, const std::string& folder);
/// The same for a result that is read from a file.
std::vector<std::string> export_tables(const std::string& result_path, const std::string& folder);

/// Sets the tolerances of a result, see SetTolerances. Throws InputError if its kind sets none.
std::string set_tolerances(const StoredResult& result, const TolerancesOptions& options, const Catalog& catalog,
                           std::size_t width);

}  // namespace poesy
