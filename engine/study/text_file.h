#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"

namespace poesy {

/// Reads a whole file. what: the kind of file for messages ("study"). Throws InputError if it is not a plain file, is
/// an HDF5 file, or has more than `most_bytes` bytes. Throws FileError if it cannot be read.
std::string read_text(const std::string& path, std::string_view what, std::size_t most_bytes);

/// A cell of a CSV line, without surrounding blanks.
struct CsvCell {
  std::string_view text;  ///< text of the cell, a view of the text in CsvLines
  Place place;            ///< place where the text begins
};

/// Reads a CSV file line by line. Commas separate the cells. A cell may be in double quotes as in RFC 4180: commas and
/// semicolons inside belong to its text, and two quotes inside are read as one. Unlike in RFC 4180, a cell cannot
/// continue on the next line. Blank lines may only be at the end. A byte order mark and line ends of Windows are
/// ignored.
class CsvLines {
 public:
  /// what: the kind of file for messages ("table of poses"). Throws InputError if the file is empty, not a plain file,
  /// a spreadsheet or in UTF-16. Throws FileError if it cannot be read.
  CsvLines(const std::string& path, std::string_view what);
  CsvLines(const CsvLines&) = delete;
  CsvLines& operator=(const CsvLines&) = delete;

  bool done() const { return rest_.empty(); }                 ///< Returns true if all lines were read.
  Place next_place() const { return {path_, line_ + 1, 1}; }  ///< The place of the next line.
  /// Reads the next line. Throws InputError if semicolons or tabs separate its columns instead of commas: it has a
  /// semicolon outside quotes, or tabs and no comma. Also throws for a cell that begins with a quote but does not end
  /// with one.
  std::vector<CsvCell> next();

 private:
  /// The text of a cell in quotes, without the quotes. Two quotes inside become one, in text_.
  std::string_view unquoted(std::string_view cell);

  std::string path_;
  std::string text_;
  std::string_view rest_;
  std::size_t line_ = 0;
};

}  // namespace poesy
