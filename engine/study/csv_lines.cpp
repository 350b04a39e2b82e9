#include "engine/study/csv_lines.h"

#include <algorithm>
#include <cstddef>

#include "engine/study/text_file.h"

namespace poesy {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 31;

}  // namespace

CsvLines::CsvLines(const std::string& path, std::string_view what)
    : path_(path), text_(read_text(path, what, kMostBytes)) {
  rest_ = text_;
  if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  rest_.remove_suffix(rest_.size() - (rest_.find_last_not_of(" \t\r\n") + 1));
  if (rest_.empty()) throw InputError({path_, 1, 1}, "the file is empty", "write the column names in the first line");
}

std::vector<CsvCell> CsvLines::next() {
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  ++line_;
  return split(line);
}

std::vector<CsvCell> CsvLines::split(std::string_view line) const {
  if (const std::size_t semicolon = line.find(';'); semicolon != std::string_view::npos) {
    throw InputError({path_, line_, semicolon + 1},
                     "columns are separated by semicolons, but poesy reads commas and decimal points",
                     "save the table with commas between columns and points in numbers");
  }
  std::vector<CsvCell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(cell(line, begin, end));
    begin = end + 1;
  }
  return cells;
}

CsvCell CsvLines::cell(std::string_view line, std::size_t begin, std::size_t end) const {
  const std::string_view text = line.substr(begin, end - begin);
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {{}, {path_, line_, begin + 1}};
  const std::size_t last = text.find_last_not_of(" \t");
  return {text.substr(first, last - first + 1), {path_, line_, begin + first + 1}};
}

}  // namespace poesy
