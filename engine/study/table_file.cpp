#include "engine/study/table_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <set>

#include "engine/base/contract.h"
#include "engine/base/text.h"
#include "engine/study/csv_title.h"
#include "engine/study/study.h"
#include "engine/study/text_file.h"

namespace poesy {
namespace {

using Names = std::vector<std::string_view>;

bool contains(const Names& list, std::string_view name) { return std::ranges::find(list, name) != list.end(); }

/// A column of numbers that the header of a table may name.
struct KnownColumn {
  std::string_view name;  ///< title in the header, without the unit
  Dimension dimension;    ///< dimension of the column's numbers
  /// Name of the coordinate or factor to which the numbers belong. It differs from `name` only if `name` is a synonym,
  /// as "time" is for "t".
  std::string_view meant;
};

/// The columns that the header of a table may name.
struct KnownColumns {
  std::vector<KnownColumn> numbers;  ///< columns of numbers, which are read
  Names facts = {};                  ///< titles of columns that `poesy export` writes; they are ignored
  Names labels = {};                 ///< titles of columns of labels; a table may have one column of labels
  bool has_texts = false;  ///< true if the table may have other columns, of text; one of them may label the rows
  std::string_view what;   ///< noun for a column of numbers in messages: "pose coordinate"
};

/// A column of the table that is being read.
struct TableColumn {
  /// What the cells of a column contain. A `fact` is ignored: a column that `poesy export` writes, or any column that
  /// read_column() does not ask for.
  enum class Role { number, fact, label, text };
  Role role;               ///< what the cells contain
  std::string_view name;   ///< for a column of numbers, the name of the coordinate or factor (KnownColumn::meant);
                           ///< otherwise the title without the unit
  std::string_view title;  ///< title in the header, with the unit; a view of the text in CsvLines
  Dimension dimension = Dimension::number;  ///< dimension of the column's numbers
  double si = 1.0;                          ///< factor that converts the column's numbers to SI
  Place place = {};                         ///< place of the title, for a column of text
  bool may_name_rows = false;               ///< true if people give this title to columns of labels: "Part No."
  bool bare = false;                        ///< true if the numbers need a unit and the title states none

  /// The title with the unit in which results show this dimension: "z [mm]".
  std::string with_unit() const { return std::string(name) + " [" + std::string(display_unit(dimension).name) + "]"; }
};

[[noreturn]] void refuse_unknown(const Place& place, std::string_view name, const KnownColumns& known) {
  if (parse_number(name) && !known.numbers.empty()) {
    throw InputError(place, fmt::format("'{}' is a number where the name of a column must be", printable(name)),
                     fmt::format("name the columns in the first line, each with its unit: {} [{}]",
                                 known.numbers.front().name, display_unit(known.numbers.front().dimension).name));
  }
  std::string advice = suggestion(name, names(known.numbers));
  for (const std::string_view between : {"_", "/", " in ", " "}) {
    const std::size_t end = name.rfind(between);
    if (end == std::string_view::npos) continue;
    const auto column = std::ranges::find(known.numbers, trimmed(name.substr(0, end)), &KnownColumn::name);
    const Unit* const unit = find_unit(trimmed(name.substr(end + between.size())));
    if (unit == nullptr || column == known.numbers.end() || unit->dimension != column->dimension) continue;
    advice = fmt::format("write its unit in brackets: {} [{}]", column->name, unit->name);
  }
  if (!known.labels.empty()) advice += "; or delete it, or call it 'part' if it names the rows";
  throw InputError(place, fmt::format("column '{}' is not a {} of the model", printable(name), known.what), advice);
}

/// Returns true for titles that people give to columns of labels, such as "Part No.", "part_no" and "Teil".
bool is_title_of_names(std::string_view title) {
  constexpr std::array<std::string_view, 20> kTitles{
      "part no",    "part nr",        "part number", "part id",      "partno",
      "parts",      "serial no",      "serial nr",   "no",           "nr",
      "teil",       "teil nr",        "teilenummer", "seriennummer", "machine",
      "machine no", "machine number", "maschine",    "piece",        "workpiece"};
  std::string words;
  for (const char c : lower_case(title)) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (is_letter) words += c;
    if (!is_letter && !words.empty() && words.back() != ' ') words += ' ';
  }
  return std::ranges::find(kTitles, trimmed(words)) != kTitles.end();
}

TableColumn column_of(const CsvCell& cell, const KnownColumns& known) {
  using enum TableColumn::Role;
  const CsvTitle title(cell.text);
  const auto found = std::ranges::find(known.numbers, title.name, &KnownColumn::name);
  if (found != known.numbers.end()) {
    return {.role = number,
            .name = found->meant,
            .title = cell.text,
            .dimension = found->dimension,
            .si = size_of_unit(cell, title, found->dimension),
            .bare = !title.unit && found->dimension != Dimension::number};
  }
  if (contains(known.facts, title.name)) return {.role = fact, .name = title.name, .title = cell.text};
  if (contains(known.labels, title.name)) return {.role = label, .name = title.name, .title = cell.text};
  refuse_other_tables(cell);
  if (title.name.empty()) {
    throw InputError(cell.place, "this column has no name", "name it, or remove it, or the comma at the ends of lines");
  }
  if (!known.has_texts) refuse_unknown(cell.place, title.name, known);
  return {.role = text,
          .name = title.name,
          .title = cell.text,
          .place = cell.place,
          .may_name_rows = is_title_of_names(title.name)};
}

/// Reads the first line. The unit of a column may follow the column's name in brackets, "z [mm]"; numbers without a
/// unit are SI. Throws InputError at the place of the mistake for an unknown or repeated column, for a unit that is
/// unknown or of another dimension, and for two columns of labels.
std::vector<TableColumn> read_header(CsvLines& lines, const KnownColumns& known) {
  std::vector<TableColumn> columns;
  for (const CsvCell& cell : lines.next()) {
    const TableColumn column = column_of(cell, known);
    if (std::ranges::find(columns, column.name, &TableColumn::name) != columns.end()) {
      throw InputError(cell.place, "column '" + std::string(column.name) + "' appears a second time", "remove it");
    }
    if (column.role == TableColumn::Role::label &&
        std::ranges::find(columns, column.role, &TableColumn::role) != columns.end()) {
      throw InputError(cell.place, "column '" + std::string(column.name) + "' names the rows, which another one does",
                       "remove one of the two");
    }
    columns.push_back(column);
  }
  return columns;
}

/// If no column is a column of labels, makes the first column of text with a title such as "serial" one, and renames it
/// "part". Its cells must then be valid labels and differ.
void take_likely_labels(std::vector<TableColumn>& columns) {
  constexpr std::array<std::string_view, 5> kTitles{"serial", "serial_number", "sn", "id", "number"};
  if (std::ranges::find(columns, TableColumn::Role::label, &TableColumn::role) != columns.end()) return;
  const auto likely = std::ranges::find_if(columns, [&](const TableColumn& column) {
    return column.role == TableColumn::Role::text &&
           std::ranges::find(kTitles, lower_case(column.name)) != kTitles.end();
  });
  if (likely == columns.end()) return;
  likely->role = TableColumn::Role::label;
  likely->name = "part";
}

/// The names of the columns of numbers.
Names names_of_numbers(std::span<const TableColumn> columns) {
  Names list;
  for (const TableColumn& column : columns) {
    if (column.role == TableColumn::Role::number) list.push_back(column.name);
  }
  return list;
}

/// Whether a table of poses must have a column of times: `no` for read_poses(), `yes` for read_trajectory().
enum class Timed { no, yes };

constexpr std::string_view kTime = "t";
constexpr std::string_view kExportedTime = "time";

/// The sets of columns that a table of poses may have: first the model's pose coordinates, then the coordinates of each
/// chart (PoseChart).
std::vector<Names> possible_headers(const ModelDescription& model, Timed timed) {
  const auto header = [&](const std::vector<PoseCoordinate>& coordinates) {
    Names columns;
    if (timed == Timed::yes) columns.push_back(kTime);
    std::ranges::copy(names(coordinates), std::back_inserter(columns));
    return columns;
  };
  std::vector<Names> headers{header(model.pose_coordinates)};
  for (const PoseChart& chart : model.charts) headers.push_back(header(chart.coordinates));
  return headers;
}

std::string one_of(const std::vector<Names>& headers) {
  std::vector<std::string> list;
  for (const Names& header : headers) list.push_back(fmt::format("{}", fmt::join(header, ",")));
  return fmt::format("{}", fmt::join(list, " | "));
}

/// The index in `headers` of the set that has exactly these columns, in any order. Throws InputError if no set has.
std::size_t header_of(const Names& columns, const std::vector<Names>& headers, const std::string& path) {
  const Names* unfinished = nullptr;
  for (std::size_t k = 0; k < headers.size(); ++k) {
    if (!std::ranges::all_of(columns, [&](auto column) { return contains(headers[k], column); })) continue;
    if (columns.size() == headers[k].size()) return k;
    if (unfinished == nullptr) unfinished = &headers[k];
  }
  if (unfinished == nullptr) {
    throw InputError({path, 1, 1}, "the columns mix coordinates that do not belong together",
                     "name the columns of one kind only: " + one_of(headers));
  }
  const auto missing = std::ranges::find_if(*unfinished, [&](auto name) { return !contains(columns, name); });
  const std::string possible = headers.size() == 1 ? "" : "; possible are " + one_of(headers);
  throw InputError({path, 1, 1}, fmt::format("column '{}' is missing", *missing),
                   "name every pose coordinate of the model in the first line" + possible);
}

/// The cells of all lines below the header.
struct Rows {
  std::vector<double> values;       ///< [rows x columns of numbers] numbers, row-major, SI
  std::vector<std::string> labels;  ///< labels of the rows; empty if the table has no column of labels
  /// Line number of each label. The labels are views of the text in CsvLines.
  std::map<std::string_view, std::size_t, std::less<>> line_of;
  std::set<std::string_view> texts;  ///< names of the columns of text in which a cell has a letter
  /// The cells of each column of text, by the column's name.
  std::map<std::string_view, std::vector<std::string_view>> cells_of_text;
};

/// Throws InputError if a cell of this line, the first below the header, has a unit where a number is expected.
void refuse_line_of_units(const std::vector<CsvCell>& cells, std::span<const TableColumn> columns) {
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (columns[k].role != TableColumn::Role::number || find_unit(cells[k].text) == nullptr) continue;
    throw InputError(
        cells[k].place, fmt::format("this line has units, such as '{}'", cells[k].text),
        fmt::format("write them into the first line, '{} [{}]', and remove this line", columns[k].name, cells[k].text));
  }
}

double number(const CsvCell& cell, const TableColumn& column) {
  if (const auto value = parse_number(cell.text)) return *value * column.si;
  throw InputError(
      cell.place,
      fmt::format("'{}' in column '{}' {}", printable(cell.text), printable(column.title), number_problem(cell.text)),
      fmt::format("write a plain number, in SI units unless the first line names another: '{}'", column.with_unit()));
}

/// Returns true if a cell begins like a number, or is "nan", "inf" or "infinity".
bool is_like_a_number(std::string_view cell) {
  const std::string_view body = cell.substr(std::min(cell.find_first_not_of("+-."), cell.size()));
  if (!body.empty() && body.front() >= '0' && body.front() <= '9') return true;
  const std::string word = lower_case(body);
  return word == "nan" || word == "inf" || word == "infinity";
}

/// Returns true if the cell has a letter of any language.
bool has_letter(std::string_view cell) {
  return std::ranges::any_of(cell, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) > 127;
  });
}

/// Adds the label in this cell to `rows`. Throws InputError if the label is not valid (label_problem()), or if an
/// earlier row has it.
void read_label(const CsvCell& cell, const TableColumn& column, Rows& rows) {
  const std::string what = std::string(column.name) + " '" + printable(cell.text) + "'";
  if (const auto problem = label_problem(cell.text)) {
    throw InputError(cell.place, what + " " + *problem, std::string(kLabelRule));
  }
  const auto [first, is_new] = rows.line_of.try_emplace(cell.text, cell.place.line);
  if (!is_new) {
    throw InputError(cell.place, what + " appears a second time, after line " + std::to_string(first->second),
                     "give each row a name of its own");
  }
  rows.labels.emplace_back(cell.text);
}

/// A check of a number (SI) of a row. n: index of the number among the numbers of the row. Throws InputError if the
/// number is not allowed.
using CheckCell = std::function<void(const Place& place, std::size_t n, const TableColumn& column, double value)>;

/// Reads one line and adds its cells to `rows`.
void read_row(CsvLines& lines, std::span<const TableColumn> columns, const KnownColumns& known, const CheckCell& check,
              Rows& rows) {
  const std::vector<CsvCell> cells = lines.next();
  check_cell_count(cells, columns.size());
  if (rows.values.empty()) refuse_line_of_units(cells, columns);
  std::size_t n = 0;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (columns[k].role == TableColumn::Role::label) read_label(cells[k], columns[k], rows);
    if (columns[k].role == TableColumn::Role::text) {
      if (!columns[k].may_name_rows && is_like_a_number(cells[k].text)) {
        refuse_unknown(columns[k].place, columns[k].name, known);
      }
      rows.cells_of_text[columns[k].name].push_back(cells[k].text);
      if (has_letter(cells[k].text)) rows.texts.insert(columns[k].name);
    }
    if (columns[k].role != TableColumn::Role::number) continue;
    rows.values.push_back(number(cells[k], columns[k]));
    if (check) check(cells[k].place, n, columns[k], rows.values.back());
    ++n;
  }
}

/// Returns true if these cells may be labels of rows: each is valid (label_problem()), and no two are equal.
bool are_labels(const std::vector<std::string_view>& cells) {
  const std::set<std::string_view> different(cells.begin(), cells.end());
  return different.size() == cells.size() &&
         std::ranges::none_of(cells, [](std::string_view cell) { return label_problem(cell).has_value(); });
}

/// The labels of the rows of a table: the column of labels, if there is one. Otherwise the first column with
/// `may_name_rows` whose cells may be labels (are_labels()). Otherwise, if the table has two rows or more, the first
/// other column of text whose cells may be labels: in a single row, the cell of any text would be unique. Empty if
/// there is no such column.
RowLabels labels_of(std::span<const TableColumn> columns, Rows rows) {
  using Role = TableColumn::Role;
  const auto label = std::ranges::find(columns, Role::label, &TableColumn::role);
  if (label != columns.end()) return {std::string(label->name), std::move(rows.labels)};
  for (const bool by_title : {true, false}) {
    for (const TableColumn& column : columns) {
      if (column.role != Role::text || column.may_name_rows != by_title) continue;
      const std::vector<std::string_view>& cells = rows.cells_of_text[column.name];
      if (!by_title && cells.size() < 2) continue;
      if (are_labels(cells)) return {"part", {cells.begin(), cells.end()}};
    }
  }
  return {};
}

/// Reads all lines below the header.
Rows read_rows(CsvLines& lines, std::span<const TableColumn> columns, const KnownColumns& known,
               const CheckCell& check) {
  if (lines.done()) {
    throw InputError(lines.next_place(), "there is no data below the column names",
                     "write at least one line of numbers");
  }
  Rows rows;
  while (!lines.done()) read_row(lines, columns, known, check, rows);
  for (const TableColumn& column : columns) {
    if (column.role != TableColumn::Role::text || rows.texts.contains(column.name)) continue;
    if (!column.may_name_rows) refuse_unknown(column.place, column.name, known);
    if (are_labels(rows.cells_of_text[column.name])) continue;
    throw InputError(column.place,
                     fmt::format("column '{}' does not name the rows, because cells are equal, empty, or no names",
                                 printable(column.name)),
                     "give each row a name of its own, or delete the column");
  }
  return rows;
}

/// The columns that a table of poses or a trajectory may have. `poesy export` names the column of times "time", and
/// adds the columns "pose" and "condition".
KnownColumns pose_columns(const ModelDescription& model, Timed timed) {
  KnownColumns known{.numbers = {}, .facts = {"pose", "condition"}, .what = "pose coordinate"};
  const auto add = [&](std::string_view name, Dimension dimension, std::string_view meant) {
    if (std::ranges::find(known.numbers, name, &KnownColumn::name) != known.numbers.end()) return;
    known.numbers.push_back({name, dimension, meant});
  };
  if (timed == Timed::yes) add(kTime, Dimension::time, kTime);
  for (const PoseCoordinate& own : model.pose_coordinates) add(own.name, own.dimension, own.name);
  for (const PoseChart& chart : model.charts) {
    for (const PoseCoordinate& other : chart.coordinates) add(other.name, other.dimension, other.name);
  }
  if (timed == Timed::yes) {
    known.what = "time or pose coordinate";
    add(kExportedTime, Dimension::time, kTime);
  } else {
    known.facts.insert(known.facts.end(), {kTime, kExportedTime});
  }
  return known;
}

/// Throws InputError if the last time is more than 1e9 s from 0, or not larger than the time before it.
void check_last(const std::vector<double>& time, const std::string& path) {
  if (!time.empty() && std::abs(time.back()) > kLatestTime) {
    throw InputError({path, time.size() + 1, 1}, "t = " + shortest(time.back()) + " s is more than 1e9 s from 0",
                     "count the time from the start of the motion");
  }
  if (time.size() < 2 || time.back() > time.end()[-2]) return;
  const std::string before = shortest(time.end()[-2]);
  throw InputError(
      {path, time.size() + 1, 1},
      time.back() == time.end()[-2]
          ? fmt::format("t = {} s appears a second time, after line {}", shortest(time.back()), time.size())
          : fmt::format("t = {} s follows t = {} s of line {}", shortest(time.back()), before, time.size()),
      "sort the rows by t, each time once");
}

TimedPoints read_points(CsvLines& lines, const std::string& path, const ModelDescription& model, Timed timed) {
  const KnownColumns known = pose_columns(model, timed);
  const std::vector<TableColumn> all = read_header(lines, known);
  const Names columns = names_of_numbers(all);
  const std::vector<Names> headers = possible_headers(model, timed);
  const std::size_t kind = header_of(columns, headers, path);
  // [coordinates of the set] index of each coordinate's column among the columns of numbers
  std::vector<std::size_t> order;
  for (const std::string_view name : headers[kind]) {
    order.push_back(static_cast<std::size_t>(std::ranges::find(columns, name) - columns.begin()));
  }
  const std::vector<double> written = read_rows(lines, all, known, {}).values;
  TimedPoints points;
  std::vector<double> values;
  for (std::size_t row = 0; row < written.size(); row += columns.size()) {
    for (const std::size_t column : order) values.push_back(written[row + column]);
    if (timed == Timed::no) continue;
    const auto time = values.end() - std::ptrdiff_t(order.size());
    points.time.push_back(*time);
    values.erase(time);
    check_last(points.time, path);
  }
  if (kind > 0) points.table.chart = kind - 1;
  for (const std::string_view name : headers[kind]) {
    const auto column = std::ranges::find(all, name, &TableColumn::name);
    if (column->bare && name != kTime) points.table.bare.emplace_back(name);
  }
  points.table.points = PoseSet(coordinates(model, points.table.chart).size(), std::move(values));
  return points;
}

}  // namespace

PoseTable read_poses(const std::string& path, const ModelDescription& model) {
  CsvLines lines(path, "table of poses");
  return read_points(lines, path, model, Timed::no).table;
}

TimedPoints read_trajectory(const std::string& path, const ModelDescription& model) {
  CsvLines lines(path, "trajectory");
  TimedPoints points = read_points(lines, path, model, Timed::yes);
  if (points.time.size() < 2) {
    throw InputError(lines.next_place(), "the trajectory has only one row", "write at least two rows, or use a pose");
  }
  return points;
}

std::vector<double> ErrorTable::column(FactorIndex factor) const {
  const auto place = std::ranges::find(factors, factor);
  POESY_EXPECTS(place != factors.end());
  std::vector<double> found;
  for (auto at = static_cast<std::size_t>(place - factors.begin()); at < values.size(); at += factors.size()) {
    found.push_back(values[at]);
  }
  return found;
}

ErrorTable read_errors(const std::string& path, const Model& model) {
  const ModelDescription& description = model.description();
  CsvLines lines(path, "table of errors");
  KnownColumns known{.numbers = {},
                     .facts = {"sample", "pose", "case"},
                     .labels = {"part", "name"},
                     .has_texts = true,
                     .what = "factor"};
  for (const Factor& factor : description.factors)
    known.numbers.push_back({factor.name, factor.dimension, factor.name});
  std::vector<TableColumn> columns = read_header(lines, known);
  take_likely_labels(columns);
  ErrorTable table;
  for (const std::string_view name : names_of_numbers(columns)) table.factors.push_back(*description.find_factor(name));
  if (table.factors.empty()) {
    const auto other = std::ranges::find(columns, TableColumn::Role::text, &TableColumn::role);
    if (other != columns.end()) refuse_unknown(other->place, other->name, known);
    throw InputError({path, 1, 1}, "the table has no column of errors", "name at least one factor of the model");
  }
  const auto check = [&](const Place& place, std::size_t n, const TableColumn& column, double value) {
    if (const auto problem = beyond_bound(model, table.factors[n], value, "an error")) {
      throw InputError(
          place, "this cell " + *problem,
          "write a smaller one, a deviation from the nominal size in SI units (m, rad) unless the first line "
          "names another: '" +
              column.with_unit() + "'");
    }
  };
  Rows rows = read_rows(lines, columns, known, check);
  table.values = std::move(rows.values);
  table.labels = labels_of(columns, std::move(rows));
  table.rows = table.values.size() / table.factors.size();
  for (const TableColumn& column : columns) {
    if (column.role == TableColumn::Role::number) table.bare.push_back(column.bare);
  }
  return table;
}

MeasuredColumn read_column(const std::string& path, std::string_view column, Dimension dimension) {
  CsvLines lines(path, "table of measured values");
  const Place header = lines.next_place();
  std::vector<TableColumn> columns;
  Names known;
  bool found = false;
  MeasuredColumn read;
  for (const CsvCell& cell : lines.next()) {
    const CsvTitle title(cell.text);
    known.push_back(title.name);
    if (cell.text != column && title.name != column) {
      columns.push_back({.role = TableColumn::Role::fact, .name = title.name, .title = cell.text});
      continue;
    }
    if (found) {
      throw InputError(cell.place, "column '" + printable(column) + "' appears a second time", "remove it");
    }
    found = true;
    read.name = title.name;
    read.bare = !title.unit;
    columns.push_back({.role = TableColumn::Role::number,
                       .name = title.name,
                       .title = cell.text,
                       .dimension = dimension,
                       .si = size_of_unit(cell, title, dimension)});
  }
  if (!found) throw InputError(header, "no column is '" + printable(column) + "'", suggestion(column, known));
  read.values = read_rows(lines, columns, {}, {}).values;
  return read;
}

std::optional<std::string> label_problem(std::string_view label) {
  constexpr std::size_t kMostBytes = 60;
  if (label.empty()) return "is empty";
  if (label.size() > kMostBytes) return "is longer than " + std::to_string(kMostBytes) + " bytes";
  if (printable(label, kMostBytes) != label) return "has characters that cannot be printed";
  if (const std::size_t at = label.find_first_of(",;\"'`"); at != std::string_view::npos) {
    return "has a " + std::string(label[at] == ',' ? "comma" : label[at] == ';' ? "semicolon" : "quote");
  }
  if (const std::string_view sign = formula_sign(label); !sign.empty()) {
    return "begins with '" + std::string(sign) + "'";
  }
  return std::nullopt;
}

}  // namespace poesy
