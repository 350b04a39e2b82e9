#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"

namespace poesy {

/// Reads a whole file. what: the kind of file for messages ("study"). Throws InputError if it is not a plain file or
/// has more than most_bytes, FileError if it cannot be read.
std::string read_text(const std::string& path, std::string_view what, std::size_t most_bytes);

/// A comma-separated part of a line, without surrounding blanks.
struct CsvCell {
  std::string_view text;  ///< a view of the lines
  Place place;            ///< place of its beginning
};

/// Reads a CSV file line by line: commas between cells, no quotes, no blank lines except at the end. A byte order mark
/// and line ends of Windows are ignored.
class CsvLines {
 public:
  /// what: the kind of file for messages ("table of poses"). Throws InputError for an empty file or one that is not a
  /// plain file, FileError if it cannot be read.
  CsvLines(const std::string& path, std::string_view what);
  CsvLines(const CsvLines&) = delete;
  CsvLines& operator=(const CsvLines&) = delete;

  bool done() const { return rest_.empty(); }                 ///< Whether all lines were read.
  Place next_place() const { return {path_, line_ + 1, 1}; }  ///< The place of the next line.
  /// Reads a line. Throws InputError if its cells are separated by semicolons.
  std::vector<CsvCell> next();

 private:
  std::string path_;
  std::string text_;
  std::string_view rest_;
  std::size_t line_ = 0;
};

}  // namespace poesy
