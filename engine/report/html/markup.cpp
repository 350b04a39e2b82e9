#include "engine/report/html/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "engine/report/text_table.h"

namespace poesy {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

unsigned char byte_at(std::string_view text, std::size_t at) { return static_cast<unsigned char>(text[at]); }

/// How many bytes a character has that begins so; 0 where none does.
std::size_t length_from(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return 2;
  if (first >= 0xE0 && first <= 0xEF) return 3;
  return first >= 0xF0 && first <= 0xF4 ? 4 : 0;
}

/// Whether so many bytes at the start of the text are one character: no overlong form, no surrogate, no number above
/// U+10FFFF.
bool is_character(std::string_view text, std::size_t length) {
  if (length == 0 || length > text.size()) return false;
  for (std::size_t n = 1; n < length; ++n) {
    if ((byte_at(text, n) & 0xC0) != 0x80) return false;
  }
  if (length < 3) return true;
  const unsigned char first = byte_at(text, 0);
  const unsigned char second = byte_at(text, 1);
  if (first == 0xE0) return second >= 0xA0;
  if (first == 0xED) return second < 0xA0;
  if (first == 0xF0) return second >= 0x90;
  return first != 0xF4 || second < 0x90;
}

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
      return byte_at(character, 0) < 0x20 || character.front() == 0x7F ? kReplacement : character;
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
    const std::size_t length = length_from(byte_at(text, 0));
    const bool whole = is_character(text, length);
    const std::string_view character = text.substr(0, whole ? length : 1);
    if (!whole) {
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
