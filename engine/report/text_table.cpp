#include "engine/report/text_table.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "engine/base/text.h"

namespace poesy {
namespace {

constexpr std::size_t kReadableWidth = 100;
constexpr std::size_t kGap = 2;
constexpr std::size_t kHeadingLines = 2;

void add_line(std::string& text, std::string_view line) {
  const std::size_t last = line.find_last_not_of(' ');
  text.append(line.substr(0, last == std::string_view::npos ? 0 : last + 1)).append("\n");
}

/// A text that may come from a stranger's file, without what a terminal would obey.
std::string harmless(std::string_view text) { return printable(text, std::string_view::npos); }

/// A column as it will be printed.
struct TextColumn {
  std::vector<std::string> heading;
  std::string unit;                ///< "[mm]"
  std::vector<std::string> cells;  ///< numbers with blanks behind them, so that their points meet at the right edge
  std::size_t width = 0;
  Column::Kind kind = Column::Kind::text;

  std::string aligned(const std::string& text) const {
    const std::string blanks(width - text_width(text), ' ');
    return kind == Column::Kind::number ? blanks + text : text + blanks;
  }
};

/// Broken where it is wider than the cells, into no more lines than a heading may have; the column grows as it must.
void set_heading(const std::string& heading, TextColumn& column) {
  column.heading = wrapped(heading, column.width);
  while (column.heading.size() > kHeadingLines) column.heading = wrapped(heading, ++column.width);
  for (const std::string& line : column.heading) column.width = std::max(column.width, text_width(line));
}

TextColumn column_text(const Table& table, std::size_t c) {
  const Column& column = table.columns[c];
  TextColumn made{{}, column.unit.empty() ? "" : "[" + column.unit + "]", {}, 0, column.kind};
  std::size_t tail = 0;
  for (const std::vector<Cell>& row : table.rows) tail = std::max(tail, tail_of(row[c]));
  made.width = text_width(made.unit);
  for (const std::vector<Cell>& row : table.rows) {
    const std::size_t blanks = row[c].value ? tail - tail_of(row[c]) : 0;
    made.cells.push_back(harmless(row[c].text) + std::string(blanks, ' '));
    made.width = std::max(made.width, text_width(made.cells.back()));
  }
  set_heading(harmless(column.heading), made);
  return made;
}

std::size_t total_width(const std::vector<TextColumn>& columns, const std::vector<std::size_t>& shown) {
  std::size_t width = shown.empty() ? 0 : kGap * (shown.size() - 1);
  for (const std::size_t c : shown) width += columns[c].width;
  return width;
}

/// Positions of the columns for which there is room; the headings of the others go to left_out.
std::vector<std::size_t> fitting(const Table& table, const std::vector<TextColumn>& columns, std::size_t width,
                                 std::vector<std::string>& left_out) {
  std::vector<std::size_t> shown;
  for (std::size_t c = 0; c < columns.size(); ++c) shown.push_back(c);
  const auto dispensable = [&](std::size_t c) { return table.columns[c].dispensable; };
  while (total_width(columns, shown) > width) {
    const std::size_t first = *std::ranges::max_element(shown, {}, dispensable);
    const int most = dispensable(first);
    if (most == 0) break;
    left_out.push_back(table.columns[first].heading);
    std::erase_if(shown, [&](std::size_t c) { return dispensable(c) == most; });
  }
  std::ranges::reverse(left_out);
  return shown;
}

template <class CellOf>
void add_row(std::string& text, const std::vector<TextColumn>& columns, const std::vector<std::size_t>& shown,
             const CellOf& cell_of) {
  std::string line;
  for (const std::size_t c : shown) {
    line.append(line.empty() ? 0 : kGap, ' ').append(columns[c].aligned(cell_of(columns[c])));
  }
  add_line(text, line);
}

void add_headings(std::string& text, const std::vector<TextColumn>& columns, const std::vector<std::size_t>& shown) {
  std::size_t lines = 0;
  bool units = false;
  for (const std::size_t c : shown) {
    lines = std::max(lines, columns[c].heading.size());
    units = units || !columns[c].unit.empty();
  }
  for (std::size_t left = lines; left > 0; --left) {
    add_row(text, columns, shown, [&](const TextColumn& column) {
      const std::size_t size = column.heading.size();
      return left > size ? std::string() : column.heading[size - left];
    });
  }
  if (units) add_row(text, columns, shown, [](const TextColumn& column) { return column.unit; });
}

std::string left_out_text(const std::vector<std::string>& headings, std::string_view remedy) {
  std::string list;
  for (const std::string& heading : headings) list += (list.empty() ? "" : ", ") + heading;
  return "(no room for " + list + ": " + std::string(remedy) + " shows more)";
}

}  // namespace

std::size_t tail_of(const Cell& cell) {
  return cell.value ? cell.text.size() - std::min(cell.text.find_first_of(".e"), cell.text.size()) : 0;
}

std::string prose_of(std::string_view prose, std::size_t width) {
  std::string text;
  for (const std::string& line : wrapped(harmless(prose), std::min(width, kReadableWidth))) add_line(text, line);
  return text;
}

std::string text_of(const Table& table, std::size_t width, std::string_view remedy) {
  std::string text = prose_of(table.caption, width);
  std::vector<std::string> left_out;
  if (!table.rows.empty()) {
    std::vector<TextColumn> columns;
    for (std::size_t c = 0; c < table.columns.size(); ++c) columns.push_back(column_text(table, c));
    const std::vector<std::size_t> shown = fitting(table, columns, width, left_out);
    add_headings(text, columns, shown);
    for (std::size_t n = 0; n < table.rows.size(); ++n) {
      add_row(text, columns, shown, [&](const TextColumn& column) { return column.cells[n]; });
    }
  }
  for (const std::string& note : table.notes) text += prose_of(note, width);
  if (!left_out.empty()) text += prose_of(left_out_text(left_out, remedy), width);
  return text;
}

std::string text_of(std::span<const Table> tables, std::size_t width, std::string_view remedy) {
  std::string text;
  for (const Table& table : tables) text += (text.empty() ? "" : "\n") + text_of(table, width, remedy);
  return text;
}

}  // namespace poesy
