#pragma once

#include <any>
#include <cstddef>
#include <string>
#include <vector>

#include "engine/kinds/kind.h"
#include "engine/result/result_file.h"

/// What is done with the results of every kind of study.
namespace poesy {

/// Writes the result of a study. found: of the type that its kind finds; moved here, its lists go as they are written.
/// The file appears whole or not at all under its name: written beside it under a temporary name, synced, renamed.
/// Throws FileError and leaves an existing file as it was.
void write_result(const std::string& path, const Study& study, const SelectedPoses& poses, std::any found,
                  const RunFacts& facts);

/// Reads a result file. Throws FileError when it is not one, or of another major version. One that was changed since it
/// was written is read as it is, and says so.
StoredResult read_result(const std::string& path);

/// Writes every table of a result as CSV into a folder; see engine/result/result_file.h.
std::vector<std::string> export_tables(const StoredResult& result, const std::string& folder);
/// The same for a result that is still to be read.
std::vector<std::string> export_tables(const std::string& result_path, const std::string& folder);

/// Sets the tolerances of a result, see SetTolerances. Throws InputError also for a kind that has none.
std::string set_tolerances(const StoredResult& result, const TolerancesOptions& options, const Catalog& catalog,
                           std::size_t width);

}  // namespace poesy
