#include "engine/report/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

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

/// A column as text for a terminal.
struct TextColumn {
  const Column& column;
  std::string unit;                       ///< unit in brackets: "[mm]"
  std::vector<std::string> heading = {};  ///< lines of the heading
  std::vector<std::string> cells = {};  ///< texts of the cells; numbers have trailing blanks that align decimal points
  std::size_t width = 0;

  std::string aligned(const std::string& text) const {
    const std::string blanks(width - text_width(text), ' ');
    return column.kind == Column::Kind::number ? blanks + text : text + blanks;
  }
};

TextColumn column_text(const Table& table, std::size_t c) {
  const Column& column = table.columns[c];
  TextColumn made{column, column.unit.empty() ? "" : "[" + column.unit + "]"};
  std::size_t tail = 0;
  for (const std::vector<Cell>& row : table.rows) tail = std::max(tail, tail_of(row[c]));
  made.width = text_width(made.unit);
  for (const std::vector<Cell>& row : table.rows) {
    const std::size_t blanks = row[c].value ? tail - tail_of(row[c]) : 0;
    made.cells.push_back(printable_line(row[c].text) + std::string(blanks, ' '));
    made.width = std::max(made.width, text_width(made.cells.back()));
  }
  // A heading that is wider than the cells is wrapped into at most kHeadingLines lines. If more lines would be needed,
  // the column becomes wider.
  const std::string heading = printable_line(column.heading);
  made.heading = wrapped(heading, made.width);
  while (made.heading.size() > kHeadingLines) made.heading = wrapped(heading, ++made.width);
  for (const std::string& line : made.heading) made.width = std::max(made.width, text_width(line));
  return made;
}

std::size_t total_width(const std::vector<const TextColumn*>& columns) {
  std::size_t width = columns.empty() ? 0 : kGap * (columns.size() - 1);
  for (const TextColumn* one : columns) width += one->width;
  return width;
}

/// Removes dispensable columns until the remaining ones fit into `width`. Returns the headings that name the removed
/// groups of columns (Column::dispensable), the group that was removed last first.
std::vector<std::string> make_room(std::vector<const TextColumn*>& columns, std::size_t width) {
  const auto dispensable = [](const TextColumn* one) { return one->column.dispensable; };
  std::vector<std::string> left_out;
  while (total_width(columns) > width) {
    const TextColumn* first = *std::ranges::max_element(columns, {}, dispensable);
    const int most = dispensable(first);
    if (most == 0) break;
    left_out.insert(left_out.begin(), first->column.heading);
    std::erase_if(columns, [&](const TextColumn* one) { return dispensable(one) == most; });
  }
  return left_out;
}

template <class CellOf>
void add_row(std::string& text, const std::vector<const TextColumn*>& columns, const CellOf& cell_of) {
  std::string line;
  for (const TextColumn* one : columns) line.append(line.empty() ? 0 : kGap, ' ').append(one->aligned(cell_of(*one)));
  add_line(text, line);
}

void add_headings(std::string& text, const std::vector<const TextColumn*>& columns) {
  std::size_t lines = 0;
  for (const TextColumn* one : columns) lines = std::max(lines, one->heading.size());
  for (std::size_t left = lines; left > 0; --left) {
    add_row(text, columns, [&](const TextColumn& one) {
      const std::size_t size = one.heading.size();
      return left > size ? std::string() : one.heading[size - left];
    });
  }
  if (std::ranges::any_of(columns, [](const TextColumn* one) { return !one->unit.empty(); })) {
    add_row(text, columns, [](const TextColumn& one) { return one.unit; });
  }
}

}  // namespace

std::size_t tail_of(const Cell& cell) {
  return cell.value ? cell.text.size() - std::min(cell.text.find_first_of(".e"), cell.text.size()) : 0;
}

std::string prose_of(std::string_view prose, std::size_t width) {
  std::string text;
  for (const std::string& line : wrapped(printable_line(prose), std::min(width, kReadableWidth))) add_line(text, line);
  return text;
}

std::string text_of(const Table& table, std::size_t width, std::string_view remedy) {
  std::string text = prose_of(table.caption, width);
  std::vector<std::string> left_out;
  if (!table.rows.empty()) {
    std::vector<TextColumn> all;
    for (std::size_t c = 0; c < table.columns.size(); ++c) all.push_back(column_text(table, c));
    std::vector<const TextColumn*> shown;
    for (const TextColumn& one : all) shown.push_back(&one);
    left_out = make_room(shown, width);
    add_headings(text, shown);
    for (std::size_t n = 0; n < table.rows.size(); ++n) {
      add_row(text, shown, [&](const TextColumn& one) { return one.cells[n]; });
    }
  }
  for (const std::string& note : table.notes) text += prose_of(note, width);
  if (!left_out.empty()) {
    text += prose_of(fmt::format("(no room for {}: {} shows more)", fmt::join(left_out, ", "), remedy), width);
  }
  return text;
}

std::string text_of(std::span<const Table> tables, std::size_t width, std::string_view remedy) {
  std::string text;
  for (const Table& table : tables) text += (text.empty() ? "" : "\n") + text_of(table, width, remedy);
  return text;
}

}  // namespace poesy
