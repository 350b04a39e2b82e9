#include "engine/report/html/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/base/text.h"
#include "engine/report/html/printed_number.h"
#include "engine/report/signs.h"
#include "engine/storage/version.h"

namespace poesy {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

/// Escapes a character of one byte.
std::string_view escaped_ascii(std::string_view character) {
  constexpr std::pair<char, std::string_view> kEscapes[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  const char byte = character.front();
  for (const auto& [special, escape] : kEscapes) {
    if (byte == special) return escape;
  }
  const bool control = static_cast<unsigned char>(byte) < 0x20 || byte == 0x7F;
  return control && byte != '\n' && byte != '\t' ? kReplacement : character;
}

std::string column_heading(const Column& column) {
  const std::string text =
      column.unit.empty() || column.unit == "1" ? column.heading : fmt::format("{} [{}]", column.heading, column.unit);
  std::string attributes = column.kind == Column::Kind::number ? "scope=\"col\" class=\"n\"" : "scope=\"col\"";
  if (column.dispensable > 0) attributes += fmt::format(" data-spare=\"{}\"", column.dispensable);
  if (column.main) attributes += " data-main";
  return element("th", text, attributes);
}

/// A column of numbers as a page prints them (printed_numbers()).
struct NumberColumn {
  std::vector<PrintedNumber> cells;
  std::size_t longest_tail = 0;
};

NumberColumn column_of_numbers(const Table& table, std::size_t c) {
  std::vector<Cell> cells;
  for (const std::vector<Cell>& row : table.rows) cells.push_back(row[c]);
  constexpr int kShareDigits = 3;  // significant digits of a share; above 90 %, of its difference from 100 %
  const bool shares = table.columns[c].unit == "%";
  NumberColumn column{printed_numbers(cells, shares ? kShareDigits : 0)};
  for (const PrintedNumber& one : column.cells) column.longest_tail = std::max(column.longest_tail, one.tail);
  return column;
}

/// The attributes of the cell of a number. They add space after the number, so that the decimal points of a column are
/// aligned. A decimal point is half as wide as a digit.
std::string number_attributes(const PrintedNumber& cell, std::size_t longest_tail) {
  const double point = cell.tail == 0 ? 0.5 : 0.0;
  const double room = static_cast<double>(longest_tail - cell.tail) - point;
  if (!cell.is_number || !(room > 0.0)) return "class=\"n\"";
  return fmt::format("class=\"n\" style=\"--room:{}\"", room);
}

std::string number_element(const PrintedNumber& cell, std::size_t longest_tail) {
  return element("td", cell.text, number_attributes(cell, longest_tail));
}

bool is_long(const Cell& cell) {
  constexpr std::size_t kLong = 30;
  return text_width(cell.text) > kLong;
}

/// The attribute of the text cells of a column. Short texts stay on one line; a column with a long text is wide enough
/// for some words in each line.
std::string_view width_class(const Table& table, std::size_t c) {
  const bool any = std::ranges::any_of(table.rows, [&](const std::vector<Cell>& row) { return is_long(row[c]); });
  return any ? "class=\"long\"" : "";
}

/// The cell that names a row by a text.
std::string row_heading(const Cell& cell) {
  return element("th", cell.text, is_long(cell) ? "scope=\"row\" class=\"long\"" : "scope=\"row\"");
}

/// The cell that names a row by a number.
std::string row_heading(const PrintedNumber& cell, std::size_t longest_tail) {
  return element("th", cell.text, "scope=\"row\" " + number_attributes(cell, longest_tail));
}

/// Replaces the hyphen before each negative number of a text, as in "z -203 mm", by a minus sign.
std::string with_minus(std::string_view text) {
  std::string printed;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool begins = at == 0 || text[at - 1] == ' ';
    const bool before_digit = at + 1 < text.size() && text[at + 1] >= '0' && text[at + 1] <= '9';
    printed += text[at] == '-' && begins && before_digit ? std::string("\u2212") : std::string(1, text[at]);
  }
  return printed;
}

/// The text of a cell as a page prints it. In a column of places, hyphens before numbers become minus signs; in other
/// columns, "+-" at the beginning of a text, as in "+-0.1 mm", becomes the sign plus-minus.
std::string printed_text(const Column& column, std::string_view text) {
  if (column.name.ends_with("place")) return with_minus(text);
  return text.starts_with("+-") ? "\u00b1" + std::string(text.substr(2)) : std::string(text);
}

/// A tolerance frame as on a drawing. Its title and label have words in place of the signs, for screen readers and for
/// fonts without these signs.
std::string frame_element(const Cell& cell) {
  std::string boxes;
  for (const std::string& box : cell.boxes) boxes += element("span", box);
  const std::string words = escaped(with_words(fmt::format("{}", fmt::join(cell.boxes, " "))));
  return fmt::format("<td><span class=\"tolerance\" role=\"img\" aria-label=\"{0}\" title=\"{0}\">{1}</span></td>",
                     words, boxes);
}

/// The rows of a table as HTML. The heading of a row is its cell in the first column of texts, or in the first column
/// if there is no column of texts.
std::string body_html(const Table& table) {
  const std::size_t columns = table.columns.size();
  const auto texts = std::ranges::find(table.columns, Column::Kind::text, &Column::kind);
  const auto naming = texts == table.columns.end() ? 0 : static_cast<std::size_t>(texts - table.columns.begin());
  std::vector<NumberColumn> numbers(columns);
  for (std::size_t c = 0; c < columns; ++c) {
    if (table.columns[c].kind == Column::Kind::number) numbers[c] = column_of_numbers(table, c);
  }
  std::string html;
  for (std::size_t n = 0; n < table.rows.size(); ++n) {
    const std::vector<Cell>& cells = table.rows[n];
    html += "<tr>";
    for (std::size_t c = 0; c < columns; ++c) {
      if (table.columns[c].only_text) continue;
      const bool number = table.columns[c].kind == Column::Kind::number;
      html += c == naming && number     ? row_heading(numbers[c].cells[n], numbers[c].longest_tail)
              : c == naming             ? row_heading(cells[c])
              : !cells[c].boxes.empty() ? frame_element(cells[c])
              : number                  ? number_element(numbers[c].cells[n], numbers[c].longest_tail)
                       : element("td", printed_text(table.columns[c], cells[c].text), width_class(table, c));
    }
    html += "</tr>\n";
  }
  return html;
}

/// The content security policy: scripts and styles of this document are allowed, and nothing from other sources.
constexpr std::string_view kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:";

std::string head(const Page& page) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n{}\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n{}\n<style>\n{}\n</style>\n</head>\n",
      kReportMark, kPolicy, element("title", page.title), asset("report.css"));
}

/// The body of the page: a header with links to the sections, followed by the sections.
std::string sections(const Page& page) {
  std::string links;
  std::string html;
  const auto add = [&](const Section& section, std::string_view body, std::string_view attributes) {
    const std::string heading = escaped(section.heading());
    links += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id(), heading);
    html += fmt::format("<section id=\"{0}\"{1} aria-labelledby=\"{0}-h\">\n<h2 id=\"{0}-h\">{2}</h2>\n{3}</section>\n",
                        section.id(), attributes, heading, body);
  };
  if (!page.answer.empty()) {
    Section answer("answer", "In short");
    answer.definitions(page.answer);
    add(answer, answer.body(), " class=\"answer\"");
  }
  if (const std::size_t count = page.warnings.size(); count > 0) {
    std::string list;
    for (const std::string& warning : page.warnings) list += element("li", warning) + "\n";
    add({"warnings", count == 1 ? "One warning" : fmt::format("{} warnings", count)}, "<ul>\n" + list + "</ul>\n",
        " class=\"warnings\"");
  }
  for (const Section& section : page.sections) add(section, section.body(), "");
  return "<header>\n" + element("h1", page.title) + "\n" + element("p", page.subtitle, "class=\"subtitle\"") +
         "\n<nav aria-label=\"Sections\"><ul>\n" + links + "</ul></nav>\n</header>\n<main id=\"main\">\n" + html +
         "</main>\n";
}

std::string scripts(const Page& page) {
  std::string html =
      "<script type=\"application/json\" id=\"report-data\">" + figures_json(page.figures) + "</script>\n";
  for (const std::string_view name : {"d3.js", "plot.js", "report.js"}) {
    html += fmt::format("<script>{}</script>\n", asset(name));
  }
  return html;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    safe += length == 0 ? kReplacement : length == 1 ? escaped_ascii(character) : character;
    text.remove_prefix(character.size());
  }
  return safe;
}

std::string element(std::string_view tag, std::string_view text, std::string_view attributes) {
  return fmt::format("<{0}{1}{2}>{3}</{0}>", tag, attributes.empty() ? "" : " ", attributes, escaped(text));
}

std::string html_table(const Table& table) {
  std::string html = fmt::format(
      "<div class=\"table-wrap\" tabindex=\"0\" role=\"group\" aria-label=\"{1}\" data-table=\"{0}\"><table>"
      "<caption>{1}</caption>\n<thead><tr>",
      escaped(table.name), escaped(table.caption));
  for (const Column& column : table.columns) {
    if (!column.only_text) html += column_heading(column);
  }
  html += "</tr></thead>\n<tbody>\n" + body_html(table) + "</tbody></table></div>\n";
  for (const std::string& note : table.notes) html += element("p", typographic(note), "class=\"note\"") + "\n";
  return html;
}

Section& Section::paragraph(std::string_view text) {
  body_ += element("p", text) + "\n";
  return *this;
}

Section& Section::definitions(const std::vector<std::pair<std::string, std::string>>& list) {
  body_ += "<dl>\n";
  for (const auto& [name, meaning] : list) body_ += element("dt", name) + element("dd", meaning) + "\n";
  body_ += "</dl>\n";
  return *this;
}

Section& Section::figure(std::string_view key, std::string_view caption, std::string_view drawn) {
  body_ += fmt::format("<figure data-figure=\"{}\"><div class=\"plot\">{}</div>{}</figure>\n", escaped(key), drawn,
                       element("figcaption", caption));
  return *this;
}

Section& Section::picture(std::string_view caption, std::string_view drawn) {
  body_ += fmt::format("<figure><div class=\"plot\">{}</div>{}</figure>\n", drawn, element("figcaption", caption));
  return *this;
}

Section& Section::table(const Table& table) {
  body_ += html_table(table);
  return *this;
}

Section& Section::table(std::span<const Table> tables, std::string_view name) {
  const auto at = std::ranges::find(tables, name, &Table::name);
  return at == tables.end() ? *this : table(*at);
}

Section& Section::folded(std::string_view summary, std::span<const Table> tables) {
  if (tables.empty()) return *this;
  body_ += "<details>" + element("summary", summary) + "\n";
  for (const Table& one : tables) body_ += html_table(one);
  body_ += "</details>\n";
  return *this;
}

Section& Section::folded_text(std::string_view summary, std::string_view text) {
  body_ += fmt::format("<details>{}\n{}</details>\n", element("summary", summary), element("pre", text));
  return *this;
}

Section& Page::add_section(std::string id, std::string heading) {
  return sections.emplace_back(std::move(id), std::move(heading));
}

Section& Page::insert_section(std::string_view after, std::string id, std::string heading) {
  const auto at = std::ranges::find(sections, after, &Section::id);
  return *sections.emplace(at == sections.end() ? at : at + 1, std::move(id), std::move(heading));
}

std::string html_document(const Page& page) {
  return head(page) + "<body>\n<a class=\"skip\" href=\"#main\">Skip to the results</a>\n" + sections(page) +
         element("footer", fmt::format("Report by poesy {} ({})", poesy_version(), git_commit())) + "\n" +
         scripts(page) + "</body>\n</html>\n";
}

}  // namespace poesy
