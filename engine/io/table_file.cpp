#include "engine/io/table_file.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
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

/// Whether a table of poses has a column of times.
enum class Timed { no, yes };

constexpr std::string_view kTime = "t";

std::vector<std::string_view> header(const std::vector<PoseCoordinate>& coordinates, Timed timed) {
  std::vector<std::string_view> columns;
  columns.reserve(coordinates.size() + 1);
  if (timed == Timed::yes) columns.push_back(kTime);
  for (const PoseCoordinate& coordinate : coordinates) columns.push_back(coordinate.name);
  return columns;
}

/// The columns that a table of poses may have: one list for the pose's own coordinates, then one for each chart.
std::vector<std::vector<std::string_view>> possible_headers(const ModelDescription& model, Timed timed) {
  std::vector<std::vector<std::string_view>> headers{header(model.pose_coordinates, timed)};
  for (const PoseChart& chart : model.charts) headers.push_back(header(chart.coordinates, timed));
  return headers;
}

std::string one_of(const std::vector<std::vector<std::string_view>>& headers) {
  std::string text;
  for (const auto& header : headers) {
    text += text.empty() ? "" : " | ";
    for (const std::string_view name : header) text += (name == header.front() ? "" : ",") + std::string(name);
  }
  return text;
}

bool contains(std::span<const std::string_view> list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// The position of the header whose names these columns are, in any order.
std::size_t header_of(std::span<const std::string_view> columns,
                      const std::vector<std::vector<std::string_view>>& headers, const std::string& path) {
  const auto missing = [&](const std::vector<std::string_view>& header) {
    return std::find_if(header.begin(), header.end(), [&](auto name) { return !contains(columns, name); });
  };
  const std::vector<std::string_view>* unfinished = nullptr;
  for (std::size_t k = 0; k < headers.size(); ++k) {
    const auto fits = [&](std::string_view column) { return contains(headers[k], column); };
    if (!std::all_of(columns.begin(), columns.end(), fits)) continue;
    if (missing(headers[k]) == headers[k].end()) return k;
    if (unfinished == nullptr) unfinished = &headers[k];
  }
  const std::string possible = headers.size() == 1 ? "" : "; possible are " + one_of(headers);
  if (unfinished == nullptr) {
    throw InputError({path, 1, 1}, "the columns mix coordinates that do not belong together",
                     "name the columns of one kind only: " + one_of(headers));
  }
  throw InputError({path, 1, 1}, "column '" + std::string(*missing(*unfinished)) + "' is missing",
                   "name every pose coordinate of the model in the first line" + possible);
}

double number(const Cell& cell, std::string_view column) {
  if (const auto value = parse_number(cell.text)) return *value;
  throw InputError(
      cell.place, "'" + printable(cell.text) + "' in column '" + std::string(column) + "' " + number_problem(cell.text),
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

/// The names of all possible columns, each once.
std::vector<std::string_view> all_names(const std::vector<std::vector<std::string_view>>& headers) {
  std::vector<std::string_view> list;
  for (const auto& header : headers) {
    std::copy_if(header.begin(), header.end(), std::back_inserter(list),
                 [&](std::string_view name) { return !contains(list, name); });
  }
  return list;
}

/// Takes the times, the column before all others, apart from the coordinates. Throws unless they ascend.
std::vector<double> take_times(std::vector<double>& values, std::size_t width, const std::string& path) {
  std::vector<double> time;
  std::vector<double> rest;
  for (std::size_t row = 0; row * width < values.size(); ++row) {
    const double t = values[row * width];
    if (row > 0 && !(t > time.back())) {
      const std::string line = std::to_string(row + 1);
      throw InputError({path, row + 2, 1},
                       t == time.back()
                           ? "t = " + shortest(t) + " s stands here a second time, after line " + line
                           : "t = " + shortest(t) + " s follows t = " + shortest(time.back()) + " s of line " + line,
                       "sort the rows by t, each time once");
    }
    time.push_back(t);
    rest.insert(rest.end(), values.begin() + std::ptrdiff_t(row * width + 1),
                values.begin() + std::ptrdiff_t((row + 1) * width));
  }
  values = std::move(rest);
  return time;
}

TimedPoints read_points(Lines& lines, const std::string& path, const ModelDescription& model, Timed timed) {
  const auto headers = possible_headers(model, timed);
  const std::vector<std::string_view> columns =
      read_header(lines, all_names(headers), timed == Timed::yes ? "time or pose coordinate" : "pose coordinate");
  const std::size_t kind = header_of(columns, headers, path);
  const std::vector<std::string_view>& wanted = headers[kind];
  const std::vector<double> written = read_rows(lines, columns, {});
  std::vector<double> values(written.size());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto target = static_cast<std::size_t>(std::find(wanted.begin(), wanted.end(), columns[k]) - wanted.begin());
    for (std::size_t row = 0; row < values.size(); row += columns.size()) values[row + target] = written[row + k];
  }
  TimedPoints points;
  if (timed == Timed::yes) points.time = take_times(values, wanted.size(), path);
  if (kind > 0) points.table.chart = kind - 1;
  points.table.points = PoseSet(coordinates(model, points.table.chart).size(), std::move(values));
  return points;
}

}  // namespace

PoseTable read_poses(const std::string& path, const ModelDescription& model) {
  Lines lines(path, "table of poses");
  return read_points(lines, path, model, Timed::no).table;
}

TimedPoints read_trajectory(const std::string& path, const ModelDescription& model) {
  Lines lines(path, "trajectory");
  TimedPoints points = read_points(lines, path, model, Timed::yes);
  if (points.time.size() < 2) {
    throw InputError(lines.next_place(), "the trajectory has only one row", "write at least two rows, or use a pose");
  }
  return points;
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
