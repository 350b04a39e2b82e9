#include "engine/study/csv_title.h"

#include <fmt/format.h>

#include "engine/base/error.h"
#include "engine/base/ratio.h"
#include "engine/base/text.h"

namespace poesy {

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
  const std::string problem =
      unit == nullptr ? "an unknown unit"
                      : fmt::format("a unit of {}, but this column is a {}", name(unit->dimension), name(dimension));
  throw InputError(cell.place, fmt::format("column '{}' has {}", printable(cell.text), problem),
                   fmt::format("write one of: {}, or leave it out for SI", unit_names(dimension)));
}

void refuse_other_tables(const CsvCell& cell) {
  if (cell.text.find('"') != std::string_view::npos) {
    throw InputError(cell.place, "column " + printable(cell.text) + " is in quotes, which poesy does not read",
                     "save the table without quotes");
  }
  if (cell.text.find('\t') != std::string_view::npos) {
    throw InputError(cell.place, "columns are separated by tabs, but poesy reads commas",
                     "save the table with commas between columns");
  }
}

}  // namespace poesy
