#include "engine/report/html/html_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/report/html/markup.h"

namespace poesy {
namespace {

std::string heading(const Column& column) {
  const std::string text =
      column.unit.empty() || column.unit == "1" ? column.heading : fmt::format("{} [{}]", column.heading, column.unit);
  return element("th", text, column.kind == Column::Kind::number ? "scope=\"col\" class=\"n\"" : "scope=\"col\"");
}

/// The column that names its row: the first one of texts.
std::size_t naming_column(const Table& table) {
  const auto text = std::ranges::find(table.columns, Column::Kind::text, &Column::kind);
  return text == table.columns.end() ? 0 : static_cast<std::size_t>(text - table.columns.begin());
}

std::string row(const Table& table, const std::vector<Cell>& cells, std::size_t naming) {
  std::string html = "<tr>";
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const bool number = table.columns[c].kind == Column::Kind::number;
    html += c == naming ? element("th", cells[c].text, "scope=\"row\"")
                        : element("td", cells[c].text, number ? "class=\"n\"" : "");
  }
  return html + "</tr>\n";
}

}  // namespace

std::string html_table(const Table& table) {
  const std::string name = escaped(table.name);
  const std::string caption = escaped(table.caption);
  std::string html = fmt::format(
      "<div class=\"table-wrap\" tabindex=\"0\" role=\"group\" aria-label=\"{1}\" data-table=\"{0}\"><table>"
      "<caption>{1}</caption>\n<thead><tr>",
      name, caption);
  for (const Column& column : table.columns) html += heading(column);
  html += "</tr></thead>\n<tbody>\n";
  const std::size_t naming = naming_column(table);
  for (const std::vector<Cell>& cells : table.rows) html += row(table, cells, naming);
  html += "</tbody></table></div>\n";
  for (const std::string& note : table.notes) html += element("p", note, "class=\"note\"") + "\n";
  return html;
}

}  // namespace poesy
