#include "engine/study/csv_title.h"

#include <fmt/format.h>

#include "engine/base/error.h"
#include "engine/base/ratio.h"
#include "engine/base/text.h"

namespace poesy {
namespace {

/// The title with its unit in brackets, "z [mm]", if it has a known unit in parentheses, "z (mm)"; otherwise empty.
std::string with_brackets(std::string_view title) {
  const std::size_t open = title.rfind('(');
  if (open == std::string_view::npos || !title.ends_with(')')) return {};
  const std::string_view unit = title.substr(open + 1, title.size() - open - 2);
  return find_unit(unit) == nullptr ? "" : fmt::format("{} [{}]", trimmed(title.substr(0, open)), unit);
}

}  // namespace

CsvTitle::CsvTitle(std::string_view text) : name(text) {
  const std::size_t bracket = text.find('[');
  if (bracket == std::string_view::npos || !text.ends_with(']')) return;
  unit = text.substr(bracket + 1, text.size() - bracket - 2);
  name = trimmed(text.substr(0, bracket));
}

double size_of_unit(const CsvCell& cell, const CsvTitle& title, Dimension dimension) {
  if (!title.unit || *title.unit == si_unit(dimension)) return 1.0;
  const Unit* unit = find_unit(*title.unit);
  if (unit != nullptr && unit->dimension == dimension) return unit->si;
  if (const auto share = ratio_unit(*title.unit); share && dimension == Dimension::number) return *share;
  const std::string problem = unit == nullptr
                                  ? "an unknown unit"
                                  : fmt::format("a unit of {}, but this column is {} {}", name(unit->dimension),
                                                dimension == Dimension::angle ? "an" : "a", name(dimension));
  throw InputError(cell.place, fmt::format("column '{}' has {}", printable(cell.text), problem),
                   fmt::format("write one of: {}, or leave it out for SI", unit_names(dimension)));
}

void refuse_other_tables(const CsvCell& cell) {
  if (cell.text.starts_with('#')) {
    throw InputError(cell.place, "the column names begin with '#', but tables have no comments",
                     "remove the sign (with numpy.savetxt: comments=\"\")");
  }
  if (const std::string right = with_brackets(cell.text); !right.empty()) {
    throw InputError(cell.place, "the unit of column '" + printable(cell.text) + "' is in parentheses",
                     "write '" + printable(right) + "'");
  }
}

void check_cell_count(const std::vector<CsvCell>& cells, std::size_t columns) {
  if (cells.size() == columns) return;
  const CsvCell& first = cells.front();
  if (cells.size() == 1 && first.text.empty()) {
    throw InputError(first.place, "this line is blank", "remove it; blank lines may only be at the end");
  }
  if (first.text.starts_with('#')) {
    throw InputError(first.place, "this line begins with '#', but tables have no comments",
                     fmt::format("remove it, or write {} cells", columns));
  }
  const Place line{first.place.file, first.place.line, 1};
  throw InputError(cells.size() > columns ? cells[columns].place : line,
                   fmt::format("this line should have {} cells, but has {}", columns, cells.size()),
                   "write one number a column, with commas between them and decimal points (0.5, not 0,5)");
}

}  // namespace poesy
