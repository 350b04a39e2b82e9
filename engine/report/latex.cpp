#include "engine/report/latex.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "engine/base/text.h"
#include "engine/report/display.h"
#include "engine/report/latex_columns.h"
#include "engine/report/latex_text.h"
#include "engine/storage/file_writer.h"
#include "engine/storage/output_folder.h"

namespace poesy {
namespace {

constexpr std::size_t kMostRowsOfAPage = 40;
constexpr double kJournalColumn = 85.0;  ///< width in mm above which a table spans two columns of a journal

/// Returns true if all names of a list, such as "low, high", are in `these`.
bool are_all_among(std::string_view list, std::span<const std::string> these) {
  for (std::size_t from = 0; from < list.size();) {
    const std::size_t end = std::min(list.find(", ", from), list.size());
    if (std::ranges::find(these, list.substr(from, end - from)) == these.end()) return false;
    from = end + 2;
  }
  return true;
}

/// The clauses of a note about columns that are printed: without the columns low and high, "index: ...; low, high: ..."
/// becomes "index: ...". A clause that names no column is kept or left out with the clause before it. left_out:
/// headings of the columns that are not printed.
std::string note_of(const std::string& note, std::span<const std::string> left_out) {
  std::string text;
  bool speaks = true;
  for (std::size_t from = 0; from < note.size();) {
    const std::size_t end = std::min(note.find("; ", from), note.size());
    const std::string clause = note.substr(from, end - from);
    from = std::min(end + 2, note.size());
    const std::size_t colon = clause.find(": ");
    if (colon != std::string::npos) speaks = !are_all_among(std::string_view(clause).substr(0, colon), left_out);
    if (speaks) text += (text.empty() ? "" : "; ") + clause;
  }
  return text;
}

/// The number of digits of a number, counted from the first that is not zero: 3 in "-0.0204". Zeros at the end of the
/// number, or before its exponent, count.
std::size_t significant_digits(std::string_view number) {
  std::string digits(number.substr(0, number.find_first_of("eE")));
  std::erase_if(digits, [](char c) { return c < '0' || c > '9'; });
  const std::size_t first = digits.find_first_not_of('0');
  return first == std::string::npos ? 0 : digits.size() - first;
}

/// Appends zeros to the numbers of a column until they have as many digits as the longest number with a decimal point.
/// So "2.63" beside "2.683" becomes "2.630". A number gets zeros only if its value, rounded to that many digits, ends
/// in these zeros. c: index of the column.
void even_digits(Table& table, std::size_t c) {
  std::size_t most = 0;
  for (const std::vector<Cell>& row : table.rows) {
    if (row[c].text.find('.') != std::string::npos) most = std::max(most, significant_digits(row[c].text));
  }
  for (std::vector<Cell>& row : table.rows) {
    std::string& text = row[c].text;
    const std::size_t digits = significant_digits(text);
    if (!row[c].value || row[c].whole || digits == 0 || digits >= most) continue;
    const std::string same = number_text(*row[c].value, static_cast<int>(most));
    if (same != (text.starts_with('+') ? text.substr(1) : text)) continue;
    const std::size_t end = std::min(text.find_first_of("eE"), text.size());
    const std::string zeros(most - digits, '0');
    text.insert(end, (text.find('.') == std::string::npos ? "." : "") + zeros);
  }
}

/// The headings of the columns of the table `whole` that the table `part` does not have.
std::vector<std::string> missing_headings(const Table& whole, const Table& part) {
  std::vector<std::string> missing;
  for (const Column& column : whole.columns) {
    if (std::ranges::find(part.columns, column.name, &Column::name) == part.columns.end()) {
      missing.emplace_back(heading_of(column));
    }
  }
  return missing;
}

/// The table as a paper prints it: equally many digits in each column of numbers, only the columns that fit, and no
/// notes on the other columns.
Table printed(Table table, double millimetres) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.columns[c].kind == Column::Kind::number) even_digits(table, c);
  }
  Table made = fitted(table, millimetres);
  std::vector<std::string> missing = missing_headings(table, made);
  std::erase_if(missing, [&](const std::string& heading) {
    return std::ranges::find(made.columns, heading, heading_of) != made.columns.end();
  });
  for (std::string& note : made.notes) note = note_of(note, missing);
  std::erase(made.notes, "");
  return made;
}

template <class Things, class Text>
std::string line_of(const Things& things, const Text& text) {
  std::string line;
  for (std::size_t c = 0; c < things.size(); ++c) line += (c == 0 ? "" : " & ") + text(c);
  // LaTeX would read a bracket or an asterisk at the start of a row as an argument of the line break before it.
  if (line.starts_with('[') || line.starts_with('*')) line.insert(0, "{}");
  return line + " \\\\\n";
}

/// The headings in one line, or in two lines if one of them needs two.
std::string heading_lines(const std::vector<ColumnLayout>& layout) {
  const bool two = std::ranges::any_of(layout, [](const ColumnLayout& one) { return !one.upper.empty(); });
  return (two ? line_of(layout, [&](std::size_t c) { return layout[c].upper; }) : "") +
         line_of(layout, [&](std::size_t c) { return layout[c].lower; });
}

/// The columns in the preamble of a tabular: "@{}lr>{\raggedright\arraybackslash}p{80pt}@{}".
std::string preamble(const Table& table, const std::vector<ColumnLayout>& layout) {
  std::string letters;
  for (std::size_t c = 0; c < layout.size(); ++c) {
    if (layout[c].is_paragraph) {
      letters += fmt::format(">{{\\raggedright\\arraybackslash}}p{{{:.0f}pt}}", layout[c].width);
    } else {
      letters += table.columns[c].kind == Column::Kind::number ? 'r' : 'l';
    }
  }
  return "@{}" + letters + "@{}";
}

/// The first lines of a file, which are comments: the packages that are needed, and the columns that do not fit.
std::string comments(bool is_long, bool has_paragraphs, const std::vector<std::string>& missing, double millimetres) {
  std::string text = fmt::format("% needs \\usepackage{{{}booktabs{}}}\n", has_paragraphs ? "array," : "",
                                 is_long ? ",longtable" : "");
  if (is_long) text += "% not for pages of two columns; --top N gives a table with fewer rows\n";
  if (missing.empty()) return text;
  return text + fmt::format("% {:g} mm have no room for: {}\n", millimetres,
                            latex_text(fmt::format("{}", fmt::join(missing, ", "))));
}

Table named_table(std::string_view name, const char* word, const char* caption, const std::vector<NamedUnit>& things) {
  Table table{
      .name = std::string(name),
      .caption = caption,
      .columns = {text_column("name", word), text_column("unit", "unit"), text_column("description", "what it is")}};
  for (const NamedUnit& thing : things) {
    table.rows.push_back({text_cell(thing.name), text_cell(unit_text(thing)), text_cell(thing.description)});
  }
  return table;
}

}  // namespace

std::string latex_of(const Table& whole, double millimetres) {
  const Table table = printed(whole, millimetres);
  const std::vector<ColumnLayout> layout = layout_of(table, millimetres);
  const bool is_long = table.rows.size() > kMostRowsOfAPage;
  const bool has_paragraphs = std::ranges::any_of(layout, &ColumnLayout::is_paragraph);
  const std::string caption = fmt::format("\\caption{{{}.}}\\label{{tab:{}}}", latex_text(table.caption), table.name);
  std::string rows;
  for (const std::vector<Cell>& row : table.rows) {
    rows += line_of(row, [&](std::size_t c) { return latex_cell(row[c], table.columns[c].kind); });
  }
  std::string notes;
  for (const std::string& note : table.notes) notes += "\\par " + latex_text(note) + ".\n";
  if (!notes.empty()) notes = "\\raggedright\n" + notes;
  const std::string start = comments(is_long, has_paragraphs, missing_headings(whole, table), millimetres);
  const std::string type =
      fmt::format("\\fontsize{{8}}{{9.5}}\\selectfont\\setlength{{\\tabcolsep}}{{{:g}pt}}\n", kColumnGap / 2);
  const std::string columns = preamble(table, layout);
  const std::string head = heading_lines(layout);
  if (is_long) {
    return fmt::format(
        "{}\\begingroup{}\\setlength{{\\LTcapwidth}}{{\\linewidth}}\n"
        "\\begin{{longtable}}{{{}}}\n{}\\\\\n\\toprule\n{}\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n{}"
        "\\end{{longtable}}\n{}\\par\\endgroup\n",
        start, type, columns, caption, head, rows, notes);
  }
  const std::string_view environment = millimetres > kJournalColumn ? "table*" : "table";
  return fmt::format(
      "{}\\begin{{{}}}\n\\centering{}{}\n\\begin{{tabular}}{{{}}}\n\\toprule\n{}\\midrule\n{}\\bottomrule\n"
      "\\end{{tabular}}\n{}\\end{{{}}}\n",
      start, environment, type, caption, columns, head, rows, notes, environment);
}

std::vector<Table> name_tables(const StoredResult& result) {
  return {named_table("coordinates", "coordinate", "Coordinates of a pose", result.pose_coordinates),
          named_table(kErrorsTable, "error", "Errors", result.factors),
          named_table("responses", "response", "Responses", result.responses)};
}

std::vector<std::string> write_latex(const StoredResult& result, std::span<const Table> tables,
                                     const std::string& folder, double millimetres) {
  OutputFolder output(folder, valid_hash(result));
  for (const Table& table : tables) output.claim(table.name + ".tex");
  std::vector<std::string> paths;
  output.fill([&] {
    for (const Table& table : tables) {
      paths.push_back(output.file(table.name + ".tex"));
      write_text(paths.back(), latex_of(table, millimetres));
    }
  });
  return paths;
}

}  // namespace poesy
