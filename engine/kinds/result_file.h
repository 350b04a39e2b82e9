#pragma once

#include <any>
#include <cstddef>
#include <string>
#include <vector>

#include "engine/kinds/kind.h"
#include "engine/result/result_file.h"

/// Functions that write, read and export the results of every kind of study.
namespace poesy {

/// Writes the result of a study. found: the result, as the type that the study's kind defines; it is moved, and its
/// lists are freed as they are written. drawing: effects of the features of the mechanism's drawing, or null. The file
/// is written under a temporary name, synced and renamed, so it appears complete or not at all. Throws FileError; an
/// existing file is then unchanged.
void write_result(const std::string& path, const Study& study, const SelectedPoses& poses, std::any found,
                  const RunFacts& facts, const DrawingResult* drawing = nullptr);

/// The result as read_result() would return it after write_result(), but without a file; see
/// engine/result/result_file.h.
StoredResult as_stored(const Study& study, const SelectedPoses& poses, std::any found,
                       const DrawingResult* drawing = nullptr);

/// Reads a result file. Throws FileError if the file is not a result, or if its format has another major version. A
/// file that was changed after it was written can be read; StoredResult records that it was changed.
StoredResult read_result(const std::string& path);

/// Writes every table of a result as CSV into a folder and returns the paths; see engine/result/result_file.h.
std::vector<std::string> export_tables(const StoredResult& result, const std::string& folder);
/// Reads a result and writes every table as CSV into a folder.
std::vector<std::string> export_tables(const std::string& result_path, const std::string& folder);

/// Sets tolerances from a result, see SetTolerances. Throws InputError if the result's kind sets none.
std::string set_tolerances(const StoredResult& result, const TolerancesOptions& options, const Catalog& catalog,
                           std::size_t width);

}  // namespace poesy
