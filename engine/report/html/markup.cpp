#include "engine/report/html/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "engine/base/text.h"
#include "engine/report/text_table.h"

namespace poesy {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

/// One character of one byte.
std::string_view escaped_ascii(std::string_view character) {
  switch (character.front()) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    case '\n':
    case '\t':
      return character;
    default:
      return static_cast<unsigned char>(character.front()) < 0x20 || character.front() == 0x7F ? kReplacement
                                                                                               : character;
  }
}

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

/// The longest tail of each column's numbers.
std::vector<std::size_t> tails_of(const Table& table) {
  std::vector<std::size_t> tails(table.columns.size(), 0);
  for (const std::vector<Cell>& cells : table.rows) {
    for (std::size_t c = 0; c < cells.size(); ++c) tails[c] = std::max(tails[c], tail_of(cells[c]));
  }
  return tails;
}

/// A number with as much room behind it as brings its decimal point below the others; a point is half as wide as a
/// digit.
std::string number_element(const Cell& cell, std::size_t longest_tail) {
  const std::size_t tail = tail_of(cell);
  const double point = tail == 0 ? 0.5 : 0.0;
  const double room = static_cast<double>(longest_tail - tail) - point;
  if (!cell.value || !(room > 0.0)) return element("td", cell.text, "class=\"n\"");
  return element("td", cell.text, fmt::format("class=\"n\" style=\"--room:{}\"", room));
}

std::string row(const Table& table, const std::vector<Cell>& cells, const std::vector<std::size_t>& tails,
                std::size_t naming) {
  std::string html = "<tr>";
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const bool number = table.columns[c].kind == Column::Kind::number;
    html += c == naming ? element("th", cells[c].text, "scope=\"row\"")
            : number    ? number_element(cells[c], tails[c])
                        : element("td", cells[c].text);
  }
  return html + "</tr>\n";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const std::string_view character = text.substr(0, length == 0 ? 1 : length);
    if (length == 0) {
      safe += kReplacement;
    } else {
      safe += length == 1 ? escaped_ascii(character) : character;
    }
    text.remove_prefix(character.size());
  }
  return safe;
}

std::string element(std::string_view tag, std::string_view text, std::string_view attributes) {
  return fmt::format("<{0}{1}{2}>{3}</{0}>", tag, attributes.empty() ? "" : " ", attributes, escaped(text));
}

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
  const std::vector<std::size_t> tails = tails_of(table);
  for (const std::vector<Cell>& cells : table.rows) html += row(table, cells, tails, naming);
  html += "</tbody></table></div>\n";
  for (const std::string& note : table.notes) html += element("p", note, "class=\"note\"") + "\n";
  return html;
}

}  // namespace poesy
