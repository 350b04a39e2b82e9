#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"

namespace poesy {

/// One comma-separated part of a line, without the spaces around it.
struct CsvCell {
  std::string_view text;  ///< refers to the lines, which must live as long
  Place place;            ///< where it begins
};

/// The lines of a CSV file, one by one: commas between cells, no quotes, no blank lines but at the end. A byte order
/// mark and line ends of Windows are passed over.
class CsvLines {
 public:
  /// `what` names what the file should be, for messages ("table of poses"). Throws InputError for an empty file or a
  /// folder, FileError when it cannot be read.
  CsvLines(const std::string& path, std::string_view what);
  CsvLines(const CsvLines&) = delete;
  CsvLines& operator=(const CsvLines&) = delete;

  /// Whether all lines were taken.
  bool done() const { return rest_.empty(); }
  /// Where the next line begins.
  Place next_place() const { return {path_, line_ + 1, 1}; }
  /// Takes a line. Throws InputError when its cells are separated by semicolons.
  std::vector<CsvCell> next();

 private:
  std::vector<CsvCell> split(std::string_view line) const;
  CsvCell cell(std::string_view line, std::size_t begin, std::size_t end) const;

  std::string path_;
  std::string text_;
  std::string_view rest_;
  std::size_t line_ = 0;
};

}  // namespace poesy
