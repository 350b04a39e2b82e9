#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/results.h"
#include "engine/app/shown_response.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/result_file.h"
#include "engine/report/display.h"
#include "engine/report/latex.h"
#include "engine/report/report_kind.h"
#include "engine/report/tables.h"

namespace poesy::app {
namespace {

constexpr std::size_t kMostNumber = 1'000'000;

struct ExportOptions {
  std::string result;
  std::string folder;
  bool latex = false;
  std::string response;
  std::optional<std::size_t> top;
  std::string size = "85mm";
};

constexpr double kNarrowestTable = 40.0;  ///< smallest width of a table, mm
constexpr double kWidestTable = 400.0;    ///< largest width of a table, mm

/// Reads the width of tables, and returns it in mm.
double width_of(const std::string& size) {
  try {
    const double width = parse_quantity(size, Dimension::length).si * 1e3;
    if (width >= kNarrowestTable && width <= kWidestTable) return width;
  } catch (const QuantityError&) {  // refused below
  }
  throw InputError({}, fmt::format("the size of a table is '{}'", printable(size)),
                   fmt::format("give its width, {} to {} mm, e.g. 85mm or 170mm", kNarrowestTable, kWidestTable));
}

/// If the result was solved to first order, adds a note on this to each table that has no such note.
void add_first_order_notes(const StoredResult& result, std::vector<Table>& tables) {
  if (!is_first_order(result)) return;
  const auto says_it = [](const std::string& note) { return note.find(kFirstOrder) != std::string::npos; };
  for (Table& table : tables) {
    if (std::ranges::none_of(table.notes, says_it)) table.notes.push_back(fmt::format("fidelity: {}", kFirstOrder));
  }
}

/// Removes the errors that no table names from a table of errors, unless no error would remain. A cell may name several
/// errors, with blanks between them.
void keep_named(const std::vector<Table>& tables, Table& errors) {
  std::set<std::string> words;
  for (const Table& table : tables) {
    for (const std::vector<Cell>& row : table.rows) {
      for (const Cell& cell : row) {
        std::istringstream text(cell.text);
        words.insert(std::istream_iterator<std::string>(text), {});
      }
    }
  }
  const auto is_named = [&](const std::vector<Cell>& error) { return words.contains(error.front().text); };
  if (std::ranges::none_of(errors.rows, is_named)) return;
  std::erase_if(errors.rows, [&](const std::vector<Cell>& error) { return !is_named(error); });
}

/// The tables that `poesy show` prints, with all columns, and the tables of the names of coordinates, errors and
/// responses with their meanings. With --top, the table of errors has only those that another table names.
std::vector<Table> printed_tables(const ExportOptions& options, StoredResult& result) {
  const std::string response = choose_response(options.response, options.result, result);
  std::vector<Table> tables = result_tables(kind_of(result).report, result, {response});
  if (options.top) keep_first(*options.top, tables);
  add_first_order_notes(result, tables);
  std::vector<Table> names = name_tables(result);
  for (Table& table : names) {
    if (options.top && table.name == kErrorsTable) keep_named(tables, table);
  }
  std::ranges::copy_if(names, std::back_inserter(tables), [](const Table& table) { return !table.rows.empty(); });
  return tables;
}

/// Tables that a user should open first if there are many, the most important first. A name that ends in '_' is
/// completed by the response that ranks errors by default.
constexpr std::array<std::string_view, 8> kFirstTables{"yield",       "global", "sobol_",  "mean_square_share",
                                                       "tolerances_", "limits", "overall", "index_change"};
constexpr std::size_t kManyFiles = 20;  ///< with more files, the program names those to open first
constexpr std::size_t kFirstFiles = 3;

/// The number of files, and which to open first: "309 files; open these first: t/global.csv, t/tolerances_gap.csv,
/// t/index_change.csv"
std::string first_files_text(const StoredResult& result, const std::vector<std::string>& files) {
  std::vector<std::string> first;
  for (const std::string_view table : kFirstTables) {
    const std::string name =
        fmt::format("{}{}.csv", table, table.ends_with('_') ? default_ranking(result) : std::string());
    const auto at = std::ranges::find(
        files, name, [](const std::string& file) { return std::filesystem::path(file).filename().string(); });
    if (at != files.end() && first.size() < kFirstFiles) first.push_back(printable(*at));
  }
  return fmt::format("{} files{}{}", files.size(), first.empty() ? "" : "; open these first: ", fmt::join(first, ", "));
}

int export_result(const ExportOptions& options) {
  const double width = width_of(options.size);
  StoredResult result = read_result_with_warning(options.result);
  std::vector<std::string> files;
  if (options.latex) {
    const std::vector<Table> tables = printed_tables(options, result);
    files = write_latex(result, tables, options.folder, width);
  } else {
    files = export_tables(result, options.folder);
    if (files.size() > kManyFiles) say(Message::note, first_files_text(result, files));
  }
  for (const std::string& file : files) print(printable_line(file) + "\n");
  return kDone;
}

int verify(const std::string& path) {
  const Verification hashes = verify_result(path);
  if (!hashes.matches()) {
    throw FileError(path, "content hash " + hashes.computed + " does not match the stored " + hashes.stored,
                    "the file was changed or damaged; run the study again");
  }
  print(printable_line(path) + ": content_sha256 " + hashes.computed + " matches\n");
  return kDone;
}

}  // namespace

Command& add_export(Command& program) {
  const auto [command, options] = program.add_command("export", "write every table of a result as CSV", export_result);
  command.add_value("result", options.result, "RESULT.h5", "result file")->required();
  command.add_value("-d,--directory", options.folder, "DIR", "folder for the tables, made if missing")->required();
  auto* const latex =
      command.add_flag("--latex", options.latex, "the tables of poesy show as LaTeX (booktabs) instead");
  command
      .add_value("--response", options.response, "RESPONSE",
                 "response to rank by, or to show alone where nothing is ranked")
      ->needs(latex);
  command
      .add_whole_number("--top", options.top, "N", "only the first N errors of a table that ranks them", 1, kMostNumber)
      ->needs(latex);
  command
      .add_value("--size", options.size, "WIDTH",
                 "width of the tables; default: 85mm, one column of a journal; 170mm are two")
      ->needs(latex);
  command.examples = {{"tables/global.csv and others", "poesy export result.h5 -d tables"},
                      {"tables/ranked.tex and others", "poesy export result.h5 -d tables --latex"},
                      {"the ten errors that matter most to one response",
                       "poesy export result.h5 -d tables --latex --top 10 --response gap"},
                      {"tables as wide as a page", "poesy export result.h5 -d tables --latex --size 170mm"}};
  return command;
}

Command& add_verify(Command& program) {
  const auto [command, result] =
      program.add_command("verify", "recompute a result's content hash; exit 3 if it differs", verify);
  command.add_value("result", result, "RESULT.h5", "result file")->required();
  command.examples = {{"unchanged since it was written?", "poesy verify result.h5"}};
  return command;
}

}  // namespace poesy::app
