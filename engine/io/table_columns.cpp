#include "engine/io/table_columns.h"

#include <algorithm>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace poesy {
namespace {

/// "z [mm]" taken apart: "z" and "mm". Without brackets there is no unit.
struct Title {
  explicit Title(std::string_view text) : name(text) {
    const std::size_t bracket = text.find('[');
    if (bracket == std::string_view::npos || !text.ends_with(']')) return;
    unit = text.substr(bracket + 1, text.size() - bracket - 2);
    name = text.substr(0, text.find_last_not_of(" \t", bracket - 1) + 1);
    if (bracket == 0) name = {};
  }

  std::string_view name;
  std::optional<std::string_view> unit;
};

bool contains(std::span<const std::string_view> list, std::string_view name) {
  return std::ranges::find(list, name) != list.end();
}

/// The size in SI of a column's unit.
double size_of(const CsvCell& cell, const Title& title, Dimension dimension) {
  if (!title.unit || *title.unit == si_unit(dimension)) return 1.0;
  const std::string remedy = "write one of: " + unit_names(dimension) + ", or leave it out for SI";
  const std::string column = "column '" + printable(cell.text) + "'";
  const Unit* unit = find_unit(*title.unit);
  if (unit == nullptr) throw InputError(cell.place, column + " has an unknown unit", remedy);
  if (unit->dimension == dimension) return unit->si;
  throw InputError(cell.place,
                   column + " has a unit of " + std::string(name(unit->dimension)) + ", but this column is a " +
                       std::string(name(dimension)),
                   remedy);
}

[[noreturn]] void refuse_unknown(const CsvCell& cell, const Title& title, const KnownColumns& known) {
  if (cell.text.find('"') != std::string_view::npos) {
    throw InputError(cell.place, "column " + printable(cell.text) + " is in quotes, which poesy does not read",
                     "save the table without quotes");
  }
  if (cell.text.find('\t') != std::string_view::npos) {
    throw InputError(cell.place, "columns are separated by tabs, but poesy reads commas",
                     "save the table with commas between columns");
  }
  throw InputError(cell.place,
                   "column '" + printable(title.name) + "' is no " + std::string(known.what) + " of the model",
                   suggestion(title.name, names(known.numbers)));
}

TableColumn column_of(const CsvCell& cell, const KnownColumns& known) {
  using enum TableColumn::Role;
  const Title title(cell.text);
  const auto found = std::ranges::find(known.numbers, title.name, &KnownColumn::name);
  if (found != known.numbers.end()) {
    return {number, found->meant, cell.text, found->dimension, size_of(cell, title, found->dimension)};
  }
  if (contains(known.facts, title.name)) return {.role = fact, .name = title.name, .title = cell.text};
  if (contains(known.labels, title.name)) return {.role = label, .name = title.name, .title = cell.text};
  refuse_unknown(cell, title, known);
}

}  // namespace

std::string TableColumn::with_unit() const {
  return std::string(name) + " [" + std::string(display_unit(dimension).name) + "]";
}

std::vector<TableColumn> read_header(CsvLines& lines, const KnownColumns& known) {
  std::vector<TableColumn> columns;
  for (const CsvCell& cell : lines.next()) {
    const TableColumn column = column_of(cell, known);
    if (std::ranges::find(columns, column.name, &TableColumn::name) != columns.end()) {
      throw InputError(cell.place, "column '" + std::string(column.name) + "' stands here a second time", "remove it");
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

}  // namespace poesy
