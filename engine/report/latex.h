#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/report/table.h"
#include "engine/result/result_file.h"

/// Tables as LaTeX, for papers.
namespace poesy {

/// A table as a `table` with the rules of the package booktabs, or as a `longtable` if it has too many rows for a page:
/// caption, label "tab:NAME", headings with units, rows, notes, in type of 8 points. A table of more than 85 mm is a
/// `table*`, which spans both columns of a page. Numbers have the digits that `poesy show` prints, in mathematics:
/// "$1.2\times10^{-5}$", and in a column all as many. The columns are those of fitted() for this width; notes on the
/// others are left out as well. The first lines are comments: the packages that are needed, and the columns that do not
/// fit.
std::string latex_of(const Table& table, double millimetres);

/// Tables of the pose coordinates, the errors and the responses of a result, with units and descriptions.
std::vector<Table> name_tables(const StoredResult& result);

/// Writes each table as a file NAME.tex for this width into a folder; see export_tables() for the rules of the folder.
/// Returns the paths of the files. Throws FileError and InputError.
std::vector<std::string> write_latex(const StoredResult& result, std::span<const Table> tables,
                                     const std::string& folder, double millimetres);

}  // namespace poesy
