#include "engine/io/table_file.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/io/error_bound.h"
#include "engine/io/text_file.h"
#include "engine/io/wording.h"

namespace poesy {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 31;

/// One comma-separated part of a line, without the spaces around it.
struct Cell {
  std::string_view text;
  Place place;
};

/// The lines of a CSV file: no quotes, no blank lines but at the end.
class Lines {
 public:
  Lines(const std::string& path, std::string_view what) : path_(path), text_(read_text(path, what, kMostBytes)) {
    rest_ = text_;
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
    rest_.remove_suffix(rest_.size() - (rest_.find_last_not_of(" \t\r\n") + 1));
    if (rest_.empty()) throw InputError({path_, 1, 1}, "the file is empty", "write the column names in the first line");
  }

  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  bool done() const { return rest_.empty(); }
  Place next_place() const { return {path_, line_ + 1, 1}; }

  std::vector<Cell> next() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++line_;
    return split(line);
  }

 private:
  std::vector<Cell> split(std::string_view line) const {
    std::vector<Cell> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(',', begin), line.size());
      cells.push_back(cell(line, begin, end));
      begin = end + 1;
    }
    return cells;
  }

  Cell cell(std::string_view line, std::size_t begin, std::size_t end) const {
    const std::string_view text = line.substr(begin, end - begin);
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {{}, {path_, line_, begin + 1}};
    const std::size_t last = text.find_last_not_of(" \t");
    return {text.substr(first, last - first + 1), {path_, line_, begin + first + 1}};
  }

  std::string path_;
  std::string text_;
  std::string_view rest_;
  std::size_t line_ = 0;
};

/// The names of the columns, all different and all known. They refer to the names in the model.
std::vector<std::string_view> read_header(Lines& lines, std::span<const std::string_view> known,
                                          std::string_view what) {
  std::vector<std::string_view> columns;
  for (const Cell& cell : lines.next()) {
    const auto found = std::find(known.begin(), known.end(), cell.text);
    if (found == known.end()) {
      throw InputError(cell.place, "column '" + printable(cell.text) + "' is no " + std::string(what) + " of the model",
                       suggestion(cell.text, known));
    }
    if (std::find(columns.begin(), columns.end(), *found) != columns.end()) {
      throw InputError(cell.place, "column '" + std::string(*found) + "' stands here a second time", "remove it");
    }
    columns.push_back(*found);
  }
  return columns;
}

double number(const Cell& cell, std::string_view column) {
  if (const auto value = parse_number(cell.text)) return *value;
  throw InputError(cell.place,
                   "'" + printable(cell.text) + "' in column '" + std::string(column) + "' is not a finite number",
                   "write a plain number in SI units");
}

/// Throws for a number that does not belong into its column.
using CheckCell = std::function<void(const Place& place, std::size_t column, double value)>;

/// Appends one line of numbers, in the order of the file's columns.
void read_row(Lines& lines, std::span<const std::string_view> columns, const CheckCell& check,
              std::vector<double>& values) {
  const Place line = lines.next_place();
  const std::vector<Cell> cells = lines.next();
  if (cells.size() != columns.size()) {
    throw InputError(
        cells.size() > columns.size() ? cells[columns.size()].place : line,
        "this line should have " + std::to_string(columns.size()) + " cells, but has " + std::to_string(cells.size()),
        "write one number a column, with commas between them");
  }
  for (std::size_t k = 0; k < cells.size(); ++k) {
    values.push_back(number(cells[k], columns[k]));
    if (check) check(cells[k].place, k, values.back());
  }
}

/// All lines of numbers, row-major, in the order of the file's columns.
std::vector<double> read_rows(Lines& lines, std::span<const std::string_view> columns, const CheckCell& check) {
  if (lines.done()) {
    throw InputError(lines.next_place(), "there is no data below the column names",
                     "write at least one line of numbers");
  }
  std::vector<double> values;
  while (!lines.done()) read_row(lines, columns, check, values);
  return values;
}

}  // namespace

PoseSet read_poses(const std::string& path, const ModelDescription& model) {
  const std::vector<std::string_view> known = names(model.pose_coordinates);
  Lines lines(path, "table of poses");
  const std::vector<std::string_view> columns = read_header(lines, known, "pose coordinate");
  for (const std::string_view coordinate : known) {
    if (std::find(columns.begin(), columns.end(), coordinate) != columns.end()) continue;
    throw InputError({path, 1, 1}, "column '" + std::string(coordinate) + "' is missing",
                     "name every pose coordinate of the model in the first line");
  }
  const std::vector<double> written = read_rows(lines, columns, {});
  std::vector<double> values(written.size());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto target = static_cast<std::size_t>(std::find(known.begin(), known.end(), columns[k]) - known.begin());
    for (std::size_t row = 0; row < values.size(); row += columns.size()) values[row + target] = written[row + k];
  }
  return PoseSet(known.size(), std::move(values));
}

ErrorTable read_errors(const std::string& path, const Model& model) {
  const ModelDescription& description = model.description();
  Lines lines(path, "table of errors");
  const std::vector<std::string_view> columns = read_header(lines, names(description.factors), "factor");
  ErrorTable table;
  for (const std::string_view column : columns) table.factors.push_back(*description.find_factor(column));
  const auto check = [&](const Place& place, std::size_t column, double value) {
    if (const auto problem = beyond_bound(model, table.factors[column], value, "an error")) {
      throw InputError(place, "this cell " + *problem, "write a smaller one, in SI units (m, rad)");
    }
  };
  table.values = read_rows(lines, columns, check);
  table.rows = table.values.size() / columns.size();
  return table;
}

}  // namespace poesy
