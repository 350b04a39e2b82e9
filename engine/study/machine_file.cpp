#include "engine/study/machine_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/study/csv_title.h"
#include "engine/study/table_file.h"
#include "engine/study/text_file.h"

namespace poesy {
namespace {

constexpr std::array<std::string_view, 9> kDisplacements{"theta_x", "theta_y", "theta_z", "x",    "y",
                                                         "z",       "tip_x",   "tip_y",   "tip_z"};
constexpr std::string_view kDeviation = "deviation_";
constexpr std::string_view kActual = "actual_";
constexpr std::string_view kSd = "sd_";
constexpr std::string_view kDistance = "distance";
constexpr std::string_view kNoValue = "no column is measured: deviation_*, actual_*, or distance";

/// A column of a table of measurements.
struct FileColumn {
  enum class Role { pose, deviation, actual, distance, sd, name, to };
  Role role;
  std::string quantity;  ///< name of the quantity: the title without a prefix such as "deviation_"
  std::string title;     ///< title without the unit
  double si = 1.0;       ///< factor that converts the column's numbers to SI
  bool is_bare = false;  ///< true if the column states no unit
  Place place;           ///< place of the title

  bool is_measured() const { return role == Role::deviation || role == Role::actual || role == Role::distance; }
};

/// One of the sets of coordinates in which a file may state poses: the model's pose coordinates, or those of a chart
/// (PoseChart).
struct PoseHeader {
  std::optional<std::size_t> chart;
  const std::vector<PoseCoordinate>* coordinates;
};

std::vector<PoseHeader> pose_headers(const ModelDescription& model) {
  std::vector<PoseHeader> list{{std::nullopt, &model.pose_coordinates}};
  for (std::size_t k = 0; k < model.charts.size(); ++k) list.push_back({k, &model.charts[k].coordinates});
  return list;
}

/// The titles that columns of a table of measurements may have.
class KnownTitles {
 public:
  explicit KnownTitles(const ModelDescription& model) {
    using Role = FileColumn::Role;
    for (const PoseHeader& header : pose_headers(model)) {
      for (const PoseCoordinate& coordinate : *header.coordinates) {
        add(coordinate.name, Role::pose, coordinate.name, coordinate.dimension);
      }
    }
    for (const std::string_view response : measurable(model)) {
      const bool is_angle = response.starts_with("theta");
      const Dimension dimension = is_angle ? Dimension::angle : Dimension::length;
      add(kDeviation, response, Role::deviation, dimension);
      if (!is_angle) add(kActual, response, Role::actual, dimension);
      add(kSd, response, Role::sd, dimension);
    }
    add(std::string(kDistance), Role::distance, std::string(kDistance), Dimension::length);
    add(kSd, kDistance, Role::sd, Dimension::length);
    for (const auto& [text, role] : {std::pair{"name", Role::name}, std::pair{"to", Role::to}}) {
      add(text, role, text, Dimension::number);
    }
  }

  FileColumn column_of(const CsvCell& cell, const ModelDescription& model) const {
    refuse_other_tables(cell);
    const CsvTitle title(cell.text);
    const auto found = std::ranges::find(titles_, title.name);
    if (found == titles_.end()) refuse(cell, title, model);
    const auto& [column, dimension] = columns_[static_cast<std::size_t>(found - titles_.begin())];
    FileColumn made = column;
    made.place = cell.place;
    made.is_bare = !title.unit;
    const bool is_text = made.role == FileColumn::Role::name || made.role == FileColumn::Role::to;
    if (is_text && title.unit) {
      throw InputError(cell.place, "column '" + printable(cell.text) + "' has a unit, but it holds names",
                       "leave the unit out");
    }
    if (!is_text) made.si = size_of_unit(cell, title, dimension);
    return made;
  }

 private:
  void add(std::string title, FileColumn::Role role, std::string quantity, Dimension dimension) {
    if (std::ranges::find(titles_, title) != titles_.end()) return;
    columns_.emplace_back(FileColumn{.role = role, .quantity = std::move(quantity), .title = title, .place = {}},
                          dimension);
    titles_.push_back(std::move(title));
  }
  void add(std::string_view prefix, std::string_view quantity, FileColumn::Role role, Dimension dimension) {
    add(std::string(prefix) + std::string(quantity), role, std::string(quantity), dimension);
  }

  [[noreturn]] void refuse(const CsvCell& cell, const CsvTitle& title, const ModelDescription& model) const {
    if (title.name.starts_with(kDeviation)) {
      const std::string response(title.name.substr(kDeviation.size()));
      const auto known = std::ranges::find(model.responses, response, &Response::name);
      if (known != model.responses.end()) {
        throw InputError(
            cell.place,
            fmt::format("column '{}': '{}' {}", printable(title.name), response,
                        known->is_magnitude() ? "has no sign" : "is not a component of the platform's displacement"),
            fmt::format("measure {}", fmt::join(measurable(model), ", ")));
      }
    }
    std::vector<std::string_view> known(titles_.begin(), titles_.end());
    throw InputError(cell.place, "column '" + printable(title.name) + "' is unknown", suggestion(title.name, known));
  }

  std::vector<std::string> titles_;
  std::vector<std::pair<FileColumn, Dimension>> columns_;
};

std::vector<FileColumn> read_titles(CsvLines& lines, const ModelDescription& model) {
  const KnownTitles known(model);
  std::vector<FileColumn> columns;
  for (const CsvCell& cell : lines.next()) {
    FileColumn column = known.column_of(cell, model);
    if (std::ranges::find(columns, column.title, &FileColumn::title) != columns.end()) {
      throw InputError(cell.place, "column '" + column.title + "' appears a second time", "remove it");
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

bool has(const std::vector<FileColumn>& columns, FileColumn::Role role) {
  return std::ranges::find(columns, role, &FileColumn::role) != columns.end();
}

/// Throws InputError if no column has measured values, if a column of standard deviations has no measured column, if
/// only one of the columns `distance` and `to` is present, or if `to` is present without `name`.
void check_columns(const std::vector<FileColumn>& columns, const Place& header) {
  using Role = FileColumn::Role;
  if (std::ranges::none_of(columns, &FileColumn::is_measured)) {
    throw InputError(header, kNoValue, "add a column with what was measured");
  }
  for (const FileColumn& column : columns) {
    if (column.role == Role::sd && std::ranges::none_of(columns, [&](const FileColumn& other) {
          return other.is_measured() && other.quantity == column.quantity;
        })) {
      throw InputError(column.place, fmt::format("column '{}' belongs to no measured column", column.title),
                       fmt::format("add what was measured of {}, or remove it", column.quantity));
    }
    if (column.role == Role::to && !has(columns, Role::distance)) {
      throw InputError(column.place, "column 'to' needs a column 'distance'", "add it, or remove 'to'");
    }
    if (column.role == Role::distance && !has(columns, Role::to)) {
      throw InputError(column.place, "column 'distance' needs a column 'to'", "add it: the name of another row");
    }
    if (column.role == Role::to && !has(columns, Role::name)) {
      throw InputError(column.place, "column 'to' needs a column 'name'", "add it: a name for each row");
    }
  }
}

/// The set of coordinates in which the file states poses. Throws InputError if coordinates of the set are missing, or
/// if the file mixes sets.
PoseHeader header_of(const std::vector<FileColumn>& columns, const ModelDescription& model, const Place& place) {
  std::vector<std::string_view> given;
  for (const FileColumn& column : columns) {
    if (column.role == FileColumn::Role::pose) given.push_back(column.title);
  }
  const auto is_given = [&](const PoseCoordinate& coordinate) {
    return std::ranges::find(given, coordinate.name) != given.end();
  };
  std::vector<std::string> possible;
  for (const PoseHeader& header : pose_headers(model)) {
    const auto all = names(*header.coordinates);
    possible.push_back(fmt::format("{}", fmt::join(all, ",")));
    if (given.size() == all.size() && std::ranges::all_of(*header.coordinates, is_given)) return header;
  }
  for (const PoseHeader& header : pose_headers(model)) {
    const auto missing = std::ranges::find_if_not(*header.coordinates, is_given);
    const auto count = std::ranges::count_if(*header.coordinates, is_given);
    if (static_cast<std::size_t>(count) != given.size() || missing == header.coordinates->end()) continue;
    throw InputError(place, fmt::format("column '{}' is missing", missing->name),
                     fmt::format("name every coordinate of one kind: {}", fmt::join(possible, " | ")));
  }
  throw InputError(place, "the columns mix coordinates that do not belong together",
                   fmt::format("name the columns of one kind only: {}", fmt::join(possible, " | ")));
}

bool is_missing(const CsvCell& cell) { return cell.text.empty() || lower_case(cell.text) == "nan"; }

double number_in(const CsvCell& cell, const FileColumn& column) {
  if (const auto number = parse_number(cell.text)) return *number * column.si;
  throw InputError(cell.place,
                   fmt::format("'{}' in column '{}' {}", printable(cell.text), column.title, number_problem(cell.text)),
                   "write a plain number, or leave the cell empty if it was not measured");
}

/// A line of a table of measurements. The cell `to` still has the name of another row, not its index.
struct FileRow {
  Place place;
  std::map<std::string, double> pose;
  std::map<std::string, double> sd;
  std::vector<MachineValue> values;
  std::string name;
  std::optional<CsvCell> to;
};

void read_cell(const CsvCell& cell, const FileColumn& column, bool row_has_to, FileRow& row) {
  using Role = FileColumn::Role;
  if (column.role == Role::name) {
    if (const auto problem = cell.text.empty() ? std::nullopt : label_problem(cell.text)) {
      throw InputError(cell.place, "name '" + printable(cell.text) + "' " + *problem, std::string(kLabelRule));
    }
    row.name = cell.text;
    return;
  }
  if (column.role == Role::to) {
    if (!cell.text.empty()) row.to = cell;
    return;
  }
  if (is_missing(cell)) {
    if (column.role != Role::pose) return;
    throw InputError(cell.place, column.title + " is missing" + (row_has_to ? ", and 'to' needs a pose" : ""),
                     "write the whole pose of this row");
  }
  const double value = number_in(cell, column);
  if (column.role == Role::pose) row.pose[column.title] = value;
  if (column.role == Role::sd) {
    if (value < 0.0)
      throw InputError(cell.place, "a standard deviation is below zero", "write a positive number, or 0");
    row.sd[column.quantity] = value;
  }
  if (column.is_measured()) {
    const auto kind = static_cast<MachineColumn>(static_cast<int>(column.role) - static_cast<int>(Role::deviation));
    row.values.push_back({kind, column.quantity, 0, 0, value});
  }
}

FileRow read_row(CsvLines& lines, const std::vector<FileColumn>& columns) {
  FileRow row{.place = lines.next_place(), .pose = {}, .sd = {}, .values = {}, .name = {}, .to = {}};
  const std::vector<CsvCell> cells = lines.next();
  check_cell_count(cells, columns.size());
  const auto to = std::ranges::find(columns, FileColumn::Role::to, &FileColumn::role);
  const bool row_has_to = to != columns.end() && !cells[static_cast<std::size_t>(to - columns.begin())].text.empty();
  for (std::size_t k = 0; k < cells.size(); ++k) read_cell(cells[k], columns[k], row_has_to, row);
  return row;
}

/// Reads the rows. Throws InputError if two rows have the same name.
std::vector<FileRow> read_rows_of_machine(CsvLines& lines, const std::vector<FileColumn>& columns) {
  if (lines.done()) {
    throw InputError(lines.next_place(), "there is no data below the column names", "write a row for each pose");
  }
  std::vector<FileRow> rows;
  std::map<std::string, std::size_t> line_of;
  while (!lines.done()) {
    rows.push_back(read_row(lines, columns));
    FileRow& row = rows.back();
    if (row.name.empty()) continue;
    const auto [first, is_new] = line_of.try_emplace(row.name, row.place.line);
    if (is_new) continue;
    throw InputError(row.place, fmt::format("name '{}' appears a second time, after line {}", row.name, first->second),
                     "give each row a name of its own");
  }
  return rows;
}

/// The index of the row that the cell `to` of `row` names. Throws InputError if no row has this name, or if the cell
/// names its own row.
std::size_t other_row(const FileRow& row, const std::vector<FileRow>& rows) {
  const std::string wanted(row.to->text);
  const auto found = std::ranges::find(rows, wanted, &FileRow::name);
  if (found == rows.end()) {
    std::vector<std::string_view> known = names(rows);
    std::erase(known, "");
    throw InputError(row.to->place, "'" + printable(wanted) + "' is the name of no row", suggestion(wanted, known));
  }
  if (&*found == &row) throw InputError(row.to->place, "'to' names its own row", "name another row");
  return static_cast<std::size_t>(found - rows.begin());
}

/// Adds the measured values of row `at` to `file`, but a distance to `distances`.
void add_values(const std::vector<FileRow>& rows, std::size_t at, MachineFile& file,
                std::vector<MachineValue>& distances) {
  const FileRow& row = rows[at];
  for (MachineValue value : row.values) {
    value.row = at;
    if (const auto sd = row.sd.find(value.quantity); sd != row.sd.end()) value.sd = sd->second;
    if (value.column != MachineColumn::distance) {
      file.values.push_back(std::move(value));
      continue;
    }
    if (!row.to) throw InputError(row.place, "a distance is measured, but 'to' names no row", "name the other row");
    if (!(value.value > 0.0)) throw InputError(row.place, "a distance is not above zero", "write a positive number");
    value.other = other_row(row, rows);
    distances.push_back(std::move(value));
  }
  if (row.to) static_cast<void>(other_row(row, rows));
}

}  // namespace

std::string MachineValue::column_name() const {
  if (column == MachineColumn::distance) return std::string(kDistance);
  return std::string(column == MachineColumn::deviation ? kDeviation : kActual) + quantity;
}

std::string MachineFile::name_of(const MachineValue& value) const {
  if (value.column != MachineColumn::distance) return value.column_name() + " of " + names[value.row];
  return fmt::format("distance {} {}", names[value.row], names[value.other]);
}

std::vector<std::string_view> measurable(const ModelDescription& model) {
  std::vector<std::string_view> list;
  for (const std::string_view name : kDisplacements) {
    if (std::ranges::find(model.responses, name, &Response::name) != model.responses.end()) list.push_back(name);
  }
  return list;
}

MachineFile read_machine_file(const std::string& path, const ModelDescription& model) {
  CsvLines lines(path, "table of measurements");
  const Place header_place = lines.next_place();
  const std::vector<FileColumn> columns = read_titles(lines, model);
  check_columns(columns, header_place);
  const PoseHeader header = header_of(columns, model, header_place);
  const std::vector<FileRow> rows = read_rows_of_machine(lines, columns);
  MachineFile file;
  std::vector<MachineValue> distances;
  std::vector<double> points;
  for (std::size_t at = 0; at < rows.size(); ++at) {
    for (const PoseCoordinate& coordinate : *header.coordinates) points.push_back(rows[at].pose.at(coordinate.name));
    file.names.push_back(rows[at].name.empty() ? fmt::format("row {}", at + 1) : rows[at].name);
    add_values(rows, at, file, distances);
  }
  file.values.insert(file.values.end(), distances.begin(), distances.end());
  if (file.values.empty()) {
    throw InputError({path, 2, 1}, "no value is measured: all cells are empty", "write what was measured");
  }
  file.poses = {header.chart, PoseSet(header.coordinates->size(), std::move(points))};
  for (const FileColumn& column : columns) {
    if (!column.is_bare) continue;
    if (column.role == FileColumn::Role::pose) file.poses.bare.push_back(column.title);
    if (column.is_measured() || column.role == FileColumn::Role::sd) file.bare.push_back(column.title);
  }
  return file;
}

}  // namespace poesy
