#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/table.h"
#include "engine/result/result_file.h"

/// Tables as LaTeX, for papers.
namespace poesy {

/// A table in LaTeX: a `table` with the rules of the package booktabs, or a `longtable` if it has too many rows for a
/// page. A `table` wider than 85 mm is a `table*`, which spans both columns of a page. It has a caption, the label
/// "tab:NAME", headings with units, rows and notes, in type of 8 points. Numbers have the digits that `poesy show`
/// prints, in mathematics: "$1.2\times10^{-5}$"; zeros are appended so that the numbers of a column have equally many
/// digits. Columns that do not fit (fitted()) are left out, and so are the notes on them. The first lines are comments
/// with the packages that are needed and the columns that do not fit. millimetres: width of the table.
std::string latex_of(const Table& table, double millimetres);

/// The name of the table of errors in name_tables().
inline constexpr std::string_view kErrorsTable = "errors";

/// Tables of the pose coordinates, the errors and the responses of a result, with units and descriptions.
std::vector<Table> name_tables(const StoredResult& result);

/// Writes each table as a file NAME.tex into a folder and returns the paths of the files. The rules of the folder are
/// those of OutputFolder. millimetres: width of the tables. Throws FileError and InputError.
std::vector<std::string> write_latex(const StoredResult& result, std::span<const Table> tables,
                                     const std::string& folder, double millimetres);

}  // namespace poesy
