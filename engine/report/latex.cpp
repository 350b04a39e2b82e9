#include "engine/report/latex.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/model/feature.h"
#include "engine/report/display.h"
#include "engine/storage/file_writer.h"
#include "engine/storage/output_folder.h"

namespace poesy {
namespace {

constexpr std::size_t kMostRowsOfAPage = 40;
/// The largest number of columns that fit on a page. Tables with more columns leave out those that are dispensable.
constexpr std::size_t kMostColumns = 9;
constexpr std::size_t kColumnWidth = 56;  ///< characters of \footnotesize in a line of a column of a journal (85 mm)
constexpr std::size_t kColumnGap = 1;     ///< characters between two columns of a table
constexpr std::size_t kFewColumns = 6;    ///< tables with at most this many columns are printed in the size of the text

std::string_view escaped(char c) {
  switch (c) {
    case '\\':
      return "\\textbackslash{}";
    case '~':
      return "\\textasciitilde{}";
    case '^':
      return "\\textasciicircum{}";
    case '<':
      return "\\textless{}";
    case '>':
      return "\\textgreater{}";
    case '|':
      return "\\textbar{}";
    case '"':
      return "\\char34{}";  // \textquotedbl needs another font encoding
    case '&':
      return "\\&";
    case '%':
      return "\\%";
    case '$':
      return "\\$";
    case '#':
      return "\\#";
    case '_':
      return "\\_";
    case '{':
      return "\\{";
    case '}':
      return "\\}";
    default:
      return {};
  }
}

/// A sign beyond ASCII, and its code in LaTeX.
struct Sign {
  std::string_view sign;   ///< UTF-8
  std::string_view latex;  ///< LaTeX code of the sign, for pdflatex without further packages
};

constexpr std::array kSigns{Sign{"\u00b1", "$\\pm$"},     Sign{"\u2300", "\\O{}"},       Sign{"\u00b0", "$^\\circ$"},
                            Sign{"\u00b5", "$\\mu$"},     Sign{"\u00d7", "$\\times$"},   Sign{"\u00b7", "$\\cdot$"},
                            Sign{"\u00b2", "$^2$"},       Sign{"\u00b3", "$^3$"},        Sign{"\u2212", "$-$"},
                            Sign{"\u2013", "--"},         Sign{"\u2014", "---"},         Sign{"\u2018", "`"},
                            Sign{"\u2019", "'"},          Sign{"\u201c", "``"},          Sign{"\u201d", "''"},
                            Sign{"\u2026", "\\ldots{}"},  Sign{"\u00a0", "~"},           Sign{"\u202f", "\\,"},
                            Sign{"\u2264", "$\\leq$"},    Sign{"\u2265", "$\\geq$"},     Sign{"\u221e", "$\\infty$"},
                            Sign{"\u03b1", "$\\alpha$"},  Sign{"\u03b2", "$\\beta$"},    Sign{"\u03b3", "$\\gamma$"},
                            Sign{"\u03b4", "$\\delta$"},  Sign{"\u03b5", "$\\epsilon$"}, Sign{"\u03b8", "$\\theta$"},
                            Sign{"\u03bb", "$\\lambda$"}, Sign{"\u03bc", "$\\mu$"},      Sign{"\u03c0", "$\\pi$"},
                            Sign{"\u03c3", "$\\sigma$"},  Sign{"\u03c6", "$\\phi$"},     Sign{"\u03c8", "$\\psi$"},
                            Sign{"\u03c9", "$\\omega$"},  Sign{"\u0394", "$\\Delta$"}};

/// A character beyond ASCII. A letter of Latin alphabets stays unchanged, because LaTeX reads UTF-8. A sign becomes its
/// command, and a sign of a drawing becomes its word. All others become "?", because pdflatex refuses them.
std::string beyond_ascii(std::string_view character) {
  const auto known = std::ranges::find(kSigns, character, &Sign::sign);
  if (known != kSigns.end()) return std::string(known->latex);
  const auto zone = std::ranges::find(zone_traits(), character, &ZoneTraits::sign);
  if (zone != zone_traits().end()) return latex_text(zone->key);
  const bool is_latin = character >= std::string_view("\u00c0") && character <= std::string_view("\u017f");
  return is_latin ? std::string(character) : "?";
}

/// A unit in upright letters: "N\,m", "$\mu$m".
std::string latex_unit(const std::string& unit) {
  std::string text;
  for (const char c : unit) text += c == ' ' ? "\\," : escaped(c).empty() ? std::string(1, c) : std::string(escaped(c));
  const bool is_micro = text.size() > 1 && text[0] == 'u' && (text[1] == 'm' || text[1] == 'J');
  return is_micro ? "$\\mu$" + text.substr(1) : text;
}

/// A number such as "-1.2e-05" in LaTeX's mathematics mode; none if the text is not a number. Groups of digits may be
/// separated by blanks.
std::optional<std::string> latex_number(const std::string& text) {
  std::string digits = text;
  std::erase(digits, ' ');
  const std::string bare = digits.starts_with('+') ? digits.substr(1) : digits;
  if (!parse_number(bare)) return std::nullopt;
  const std::size_t e = digits.find_first_of("eE");
  if (e != std::string::npos) {
    const std::string power = std::to_string(std::stoi(digits.substr(e + 1)));
    return "$" + digits.substr(0, e) + "\\times10^{" + power + "}$";
  }
  std::string grouped;
  for (const char c : text) grouped += c == ' ' ? "\\," : std::string(1, c);
  return "$" + grouped + "$";
}

std::string latex_cell(const Cell& cell, Column::Kind kind) {
  if (cell.text == "-") return "--";
  if (kind == Column::Kind::text) return latex_text(cell.text);
  if (cell.text == "inf" || cell.text == "-inf") return cell.text.front() == '-' ? "$-\\infty$" : "$\\infty$";
  return latex_number(cell.text).value_or(latex_text(cell.text));
}

std::string_view heading_of(const Column& column) { return column.heading.empty() ? column.name : column.heading; }

/// The characters in the widest line of a table.
std::size_t width_of(const Table& table) {
  std::size_t width = 0;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Column& column = table.columns[c];
    std::size_t widest = text_width(heading_of(column)) + (column.unit.empty() ? 0 : text_width(column.unit) + 3);
    for (const std::vector<Cell>& row : table.rows) widest = std::max(widest, text_width(row[c].text));
    width += widest + (c == 0 ? 0 : kColumnGap);
  }
  return width;
}

template <class Keep>
Table with_columns(const Table& table, const Keep& keep) {
  Table made = table;
  for (std::size_t c = table.columns.size(); c-- > 0;) {
    if (keep(c)) continue;
    const auto at = static_cast<std::ptrdiff_t>(c);
    made.columns.erase(made.columns.begin() + at);
    for (std::vector<Cell>& row : made.rows) row.erase(row.begin() + at);
  }
  return made;
}

/// The table without its most dispensable group of columns. Precondition: it has dispensable columns.
Table without_a_group(const Table& table) {
  const int last = std::ranges::max(table.columns, {}, &Column::dispensable).dispensable;
  return with_columns(table, [&](std::size_t c) { return table.columns[c].dispensable < last; });
}

bool has_dispensable(const Table& table) {
  return std::ranges::any_of(table.columns, [](const Column& column) { return column.dispensable > 0; });
}

/// The table without dispensable columns, the most dispensable first, until it fits in a column of a journal. If it
/// does not fit even without all of them, it has all columns that fit on a page.
Table fitted(const Table& table) {
  Table narrow = table;
  while (width_of(narrow) > kColumnWidth && has_dispensable(narrow)) narrow = without_a_group(narrow);
  if (width_of(narrow) <= kColumnWidth || table.columns.size() > kMostColumns) return narrow;
  return table;
}

/// Returns true if all names of a list "low, high" are among these.
bool are_all_among(std::string_view list, std::span<const std::string> these) {
  for (std::size_t from = 0; from < list.size();) {
    const std::size_t end = std::min(list.find(", ", from), list.size());
    if (std::ranges::find(these, list.substr(from, end - from)) == these.end()) return false;
    from = end + 2;
  }
  return true;
}

/// The clauses of a note that speak of columns which are printed: "index: ...; low, high: ..." without columns low and
/// high is "index: ...". A clause without names of columns goes with the clause before it.
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

/// The digits of a number from the first that is not zero: 3 in "-0.0204". Zeros before an exponent or at the end
/// count.
std::size_t significant_digits(std::string_view number) {
  std::string digits(number.substr(0, number.find_first_of("eE")));
  std::erase_if(digits, [](char c) { return c < '0' || c > '9'; });
  const std::size_t first = digits.find_first_not_of('0');
  return first == std::string::npos ? 0 : digits.size() - first;
}

/// Gives the numbers of a column equally many digits: as many as the number with a decimal point that has most. So
/// "2.63" beside "2.683" becomes "2.630". Only zeros are added, which rounding had removed.
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

/// The table as a paper prints it: its columns, notes on these, and even digits.
Table printed(const Table& table) {
  Table made = fitted(table);
  if (table.columns.size() > kMostColumns) {
    made = with_columns(made, [&, with_all = made](std::size_t c) {
      return std::ranges::any_of(with_all.rows, [c](const std::vector<Cell>& row) { return row[c].text != "-"; });
    });
  }
  std::vector<std::string> left_out;
  for (const Column& column : table.columns) {
    if (std::ranges::find(made.columns, heading_of(column), heading_of) == made.columns.end()) {
      left_out.emplace_back(heading_of(column));
    }
  }
  for (std::string& note : made.notes) note = note_of(note, left_out);
  std::erase(made.notes, "");
  for (std::size_t c = 0; c < made.columns.size(); ++c) {
    if (made.columns[c].kind == Column::Kind::number) even_digits(made, c);
  }
  return made;
}

template <class Things, class Text>
std::string line_of(const Things& things, const Text& text) {
  std::string line;
  for (std::size_t c = 0; c < things.size(); ++c) line += (c == 0 ? "" : " & ") + text(c);
  return line + " \\\\\n";
}

std::string headings(const Table& table) {
  return line_of(table.columns, [&](std::size_t c) {
    const Column& column = table.columns[c];
    return latex_text(heading_of(column)) + (column.unit.empty() ? "" : " [" + latex_unit(column.unit) + "]");
  });
}

std::string alignment(const Table& table) {
  std::string letters;
  for (const Column& column : table.columns) letters += column.kind == Column::Kind::number ? 'r' : 'l';
  return letters;
}

Table named_table(const char* name, const char* word, const char* caption, const std::vector<NamedUnit>& things) {
  Table table{
      .name = name,
      .caption = caption,
      .columns = {text_column("name", word), text_column("unit", "unit"), text_column("description", "what it is")}};
  for (const NamedUnit& thing : things) {
    table.rows.push_back({text_cell(thing.name), text_cell(unit_text(thing)), text_cell(thing.description)});
  }
  return table;
}

}  // namespace

std::string latex_text(std::string_view text) {
  std::string all;
  const std::string line = printable_line(text);
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t length = std::max<std::size_t>(character_length(std::string_view(line).substr(at)), 1);
    const std::string_view character = std::string_view(line).substr(at, length);
    const std::string_view instead = length == 1 ? escaped(character.front()) : std::string_view();
    all += length > 1 ? beyond_ascii(character) : std::string(instead.empty() ? character : instead);
    at += length;
  }
  return all;
}

std::string latex_of(const Table& whole) {
  const Table table = printed(whole);
  const bool is_long = table.rows.size() > kMostRowsOfAPage;
  const std::string caption = fmt::format("\\caption{{{}.}}\\label{{tab:{}}}", latex_text(table.caption), table.name);
  std::string rows;
  for (const std::vector<Cell>& row : table.rows) {
    rows += line_of(row, [&](std::size_t c) { return latex_cell(row[c], table.columns[c].kind); });
  }
  std::string notes;
  for (const std::string& note : table.notes) notes += "\\par\\footnotesize " + latex_text(note) + ".\n";
  const std::string head = headings(table);
  const bool is_wide = table.columns.size() > kFewColumns;
  const std::string narrow = "\\footnotesize\\setlength{\\tabcolsep}{3pt}\n";
  if (is_long) {
    return fmt::format(
        "% needs \\usepackage{{booktabs,longtable}}\n"
        "{}\\begin{{longtable}}{{{}}}\n{}\\\\\n\\toprule\n{}\\midrule\n\\endhead\n\\bottomrule\n\\endfoot\n{}"
        "\\end{{longtable}}\n{}{}",
        is_wide ? "\\begingroup" + narrow : "", alignment(table), caption, head, rows, notes,
        is_wide ? "\\endgroup\n" : "");
  }
  return fmt::format(
      "% needs \\usepackage{{booktabs}}\n"
      "\\begin{{table}}\n\\centering\n{}\n{}\\begin{{tabular}}{{{}}}\n\\toprule\n{}\\midrule\n{}\\bottomrule\n"
      "\\end{{tabular}}\n{}\\end{{table}}\n",
      caption, is_wide ? narrow : "", alignment(table), head, rows, notes);
}

std::vector<Table> name_tables(const StoredResult& result) {
  return {named_table("coordinates", "coordinate", "Coordinates of a pose", result.pose_coordinates),
          named_table("errors", "error", "Errors", result.factors),
          named_table("responses", "response", "Responses", result.responses)};
}

std::vector<std::string> write_latex(const StoredResult& result, std::span<const Table> tables,
                                     const std::string& folder) {
  OutputFolder output(folder, valid_hash(result));
  for (const Table& table : tables) output.claim(table.name + ".tex");
  std::vector<std::string> paths;
  output.fill([&] {
    for (const Table& table : tables) {
      paths.push_back(output.file(table.name + ".tex"));
      write_text(paths.back(), latex_of(table));
    }
  });
  return paths;
}

}  // namespace poesy
