#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"

namespace poesy {

/// Reads a whole file. `what` names what it should be, for messages ("study").
/// Throws InputError for what is no plain file or has more than most_bytes, FileError when it cannot be read.
std::string read_text(const std::string& path, std::string_view what, std::size_t most_bytes);

/// One comma-separated part of a line, without the spaces around it.
struct CsvCell {
  std::string_view text;  ///< refers to the lines, which must live as long
  Place place;            ///< where it begins
};

/// The lines of a CSV file, one by one: commas between cells, no quotes, no blank lines but at the end. A byte order
/// mark and line ends of Windows are passed over.
class CsvLines {
 public:
  /// `what` names what the file should be, for messages ("table of poses"). Throws InputError for an empty file or
  /// what is no plain file, FileError when it cannot be read.
  CsvLines(const std::string& path, std::string_view what);
  CsvLines(const CsvLines&) = delete;
  CsvLines& operator=(const CsvLines&) = delete;

  bool done() const { return rest_.empty(); }                 ///< Whether all lines were taken.
  Place next_place() const { return {path_, line_ + 1, 1}; }  ///< Where the next line begins.
  /// Takes a line. Throws InputError when its cells are separated by semicolons.
  std::vector<CsvCell> next();

 private:
  std::string path_;
  std::string text_;
  std::string_view rest_;
  std::size_t line_ = 0;
};

}  // namespace poesy
