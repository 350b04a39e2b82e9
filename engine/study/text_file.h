#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"

namespace poesy {

/// Reads a whole file. `what` names what it should be, for messages ("study").
/// Throws InputError for a folder or a file of more than most_bytes, FileError when it cannot be read.
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
  /// `what` names what the file should be, for messages ("table of poses"). Throws InputError for an empty file or a
  /// folder, FileError when it cannot be read.
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

/// Gives a file a second name: POSIX link(), or what stands for it in a test. 0, or -1 and errno.
using LinkFile = int (*)(const char* existing, const char* second);

/// Puts the file at `path` at `second` as well, in place of what is there. `path` stays all the while, and `second`
/// is replaced at once. A file system without hard links gets a copy. Throws FileError; then both are as they were.
void put_at_second_name(const std::string& path, const std::string& second, LinkFile link_file);

void put_at_second_name(const std::string& path, const std::string& second);  ///< The same with POSIX link().

}  // namespace poesy
