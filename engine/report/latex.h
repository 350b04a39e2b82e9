#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/table.h"
#include "engine/result/result_file.h"

/// Tables as LaTeX, for papers.
namespace poesy {

/// A text for LaTeX (pdflatex without further packages). Characters with a meaning in LaTeX are escaped, signs become
/// their commands, and signs of a drawing become words. Control characters and letters of other than Latin alphabets
/// become "?".
std::string latex_text(std::string_view text);

/// A table as a `table` with the rules of the package booktabs, or as a `longtable` if it has too many rows for a page:
/// caption, label "tab:NAME", headings with units, rows, notes. Numbers have the digits that `poesy show` prints, in
/// mathematics: "$1.2\times10^{-5}$", and in a column all as many. If the table is wider than a column of a journal,
/// dispensable columns are left out until it fits, or all of them and empty columns if it has more than nine; notes on
/// these columns are left out as well. The first line, a comment, names the packages that are needed.
std::string latex_of(const Table& table);

/// Tables of the pose coordinates, the errors and the responses of a result, with units and descriptions.
std::vector<Table> name_tables(const StoredResult& result);

/// Writes each table as a file NAME.tex into a folder; see export_tables() for the rules of the folder. Returns the
/// paths of the files. Throws FileError and InputError.
std::vector<std::string> write_latex(const StoredResult& result, std::span<const Table> tables,
                                     const std::string& folder);

}  // namespace poesy
