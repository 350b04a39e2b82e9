#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/table.h"
#include "engine/result/result_file.h"

/// Tables as LaTeX, for papers.
namespace poesy {

/// A text with every character escaped that means something to LaTeX, for pdflatex without further packages: signs by
/// their commands, those of a drawing by their words. Control characters, and letters of alphabets that are not Latin,
/// become "?".
std::string latex_text(std::string_view text);

/// A table as a `table` with the rules of the package booktabs, or as a `longtable` if it has more rows than a page:
/// caption, label "tab:NAME", headings with units, rows, notes. Numbers have the digits that `poesy show` prints, in
/// mathematics: "$1.2\times10^{-5}$". Of a table with more than nine columns those that are dispensable are left out,
/// and columns of words without any. The first line, a comment, names the packages.
std::string latex_of(const Table& table);

/// Tables of the coordinates of a pose, the errors and the responses of a result, with their units and meanings in the
/// words of the mechanism's file.
std::vector<Table> name_tables(const StoredResult& result);

/// Writes each table into a folder as NAME.tex; export_tables() describes the folder. Returns the paths of the files.
/// Throws FileError and InputError.
std::vector<std::string> write_latex(const StoredResult& result, std::span<const Table> tables,
                                     const std::string& folder);

}  // namespace poesy
