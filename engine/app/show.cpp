#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/results.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/study_file.h"
#include "engine/report/display.h"
#include "engine/report/signs.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"
#include "engine/study/study.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

constexpr std::string_view kRemedy = "a wider terminal, --response NAME or --json";

constexpr std::size_t kMostNumber = 1'000'000;

struct ShowOptions {
  std::vector<std::string> results;  ///< one result, or two to compare
  std::string response;
  std::optional<std::string> sort;
  std::optional<std::size_t> top;
  std::optional<std::size_t> width;
  bool json = false;
};

/// The name of the response. wanted: empty for the one that ranks by default.
std::string response_of(const std::string& wanted, const std::string& path, const StoredResult& result) {
  if (wanted.empty()) return default_ranking(result);
  const std::vector<std::string> known = names_of(result.responses);
  if (std::ranges::find(known, wanted) != known.end()) return wanted;
  throw InputError({path}, fmt::format("--response: no response '{}' in this result", printable(wanted)),
                   fmt::format("it has {}", fmt::join(known, ", ")));
}

RowOrder order_of(const ShowOptions& options) {
  if (!options.sort) return RowOrder::effect;
  const auto at = std::ranges::find(kRowOrders, *options.sort);
  if (at != kRowOrders.end()) return static_cast<RowOrder>(at - kRowOrders.begin());
  throw InputError({}, fmt::format("--sort: '{}' is no order of errors", printable(*options.sort)),
                   suggestion(*options.sort, kRowOrders));
}

bool ranks_errors(const StoredResult& result) { return kind_of(result).report.two_rankings != nullptr; }

/// Throws if --sort is given for a kind whose errors have a fixed order, or --top for one without a ranking of errors.
void check_ranks(const ShowOptions& options, const std::string& path, const StoredResult& result,
                 const std::vector<Table>& tables) {
  const auto refuse = [&](std::string_view option, std::string_view what) {
    throw InputError({path}, fmt::format("{}: this result of kind '{}' {}", option, result.kind, what),
                     fmt::format("leave out {}", option));
  };
  if (options.sort && !kind_of(result).report.sorts) refuse("--sort", "has no errors that come in any order");
  if (options.top && std::ranges::none_of(tables, &Table::ranked)) refuse("--top", "ranks no errors");
}

/// Restricts the tables to this response.
void show_alone(const std::string& response, StoredResult& result) {
  const auto at = std::ranges::find(result.responses, response, &NamedUnit::name) - result.responses.begin();
  result.headline = result.signed_headline = {static_cast<std::size_t>(at)};
}

/// Notes on the mechanism's numbers, whether the study was calibrated, and what was constant. The last two only if a
/// study was solved rather than a table of errors. Empty if this program cannot read the study.
std::string study_lines(const StoredResult& result, std::size_t width) {
  const std::optional<Study> study = study_in(result, registry());
  if (!study) return {};
  std::vector<std::string> lines = build_model(study->mechanism)->remarks();
  if (!kind_of(result).report.words(result).from_tables) {
    lines.push_back(calibration_text(*study));
    lines.push_back(held_errors_text(*study));
  }
  std::string text;
  for (const std::string& line : lines) {
    if (!line.empty()) text += prose_of(line, width);
  }
  return text;
}

std::size_t width_of(const ShowOptions& options) { return options.width.value_or(output_width()); }

int show_one(const ShowOptions& options) {
  const std::string& path = options.results.front();
  const RowOrder order = order_of(options);
  StoredResult result = read_result_with_warning(path);
  const std::string response = response_of(options.response, path, result);
  if (!options.response.empty() && !ranks_errors(result)) show_alone(response, result);
  const ReportKind& kind = kind_of(result).report;
  std::vector<Table> tables = result_tables(kind, result, {response, order});
  check_ranks(options, path, result, tables);
  const SolveTally tally = kind.tally(result);
  if (options.top) keep_first(*options.top, tables);
  const std::size_t width = width_of(options);
  if (!options.json && !shows_signs()) use_words(tables);
  print(options.json ? json_of(result, tally.total(), tables)
                     : summary_text(result, tally, width) + study_lines(result, width) +
                           failures_text(result, tally, path, width) + "\n" + text_of(tables, width, kRemedy));
  return kDone;
}

void check_ranked(const std::string& path, const StoredResult& result) {
  if (ranks_errors(result)) return;
  throw InputError(
      {path},
      fmt::format("is a result of kind '{}', and only those of kind {} rank errors", result.kind, kinds_that_rank()),
      "show each result alone, or compare both with poesy report");
}

/// Shows the rankings of two results side by side.
int show_both(const ShowOptions& options) {
  const RowOrder order = order_of(options);
  const std::string& path_a = options.results.front();
  const std::string& path_b = options.results.back();
  const StoredResult a = read_result_with_warning(path_a);
  const StoredResult b = read_result_with_warning(path_b);
  check_ranked(path_a, a);
  check_ranked(path_b, b);
  const std::size_t comma = options.response.find(',');
  const std::string of_a = options.response.substr(0, comma);
  const std::string of_b = comma == std::string::npos ? of_a : options.response.substr(comma + 1);
  const ReportKind& kind = kind_of(a).report;
  const RankedResult ranked_a{a, path_a, response_of(of_a, path_a, a), kind.tally(a).total()};
  const RankedResult ranked_b{b, path_b, response_of(of_b, path_b, b), kind_of(b).report.tally(b).total()};
  TwoRankings rankings = kind.two_rankings(ranked_a, ranked_b, order);
  if (options.top) keep_first(*options.top, {&rankings.table, 1});
  if (options.json) {
    print(json_of(ranked_a, ranked_b, rankings));
    return kDone;
  }
  const std::size_t width = width_of(options);
  std::string text = prose_of(ranked_text('A', ranked_a), width) + prose_of(ranked_text('B', ranked_b), width) + "\n" +
                     text_of(rankings.table, width, kRemedy);
  for (const std::string& remark : rankings.remarks) text += prose_of(remark, width);
  print(text);
  return kDone;
}

int show(const ShowOptions& options) { return options.results.size() == 1 ? show_one(options) : show_both(options); }

}  // namespace

Command& add_show(Command& program) {
  const auto [command, options] =
      program.add_command("show", "print a result as tables, or the rankings of two beside each other", show);
  command
      .add_value("results", options.results, "RESULT.h5",
                 "result file, or two sensitivity results whose rankings are shown beside each other")
      ->required()
      ->expected(1, 2);
  command.add_value(
      "--response", options.response, "RESPONSE",
      "response to rank by, or to show alone where nothing is ranked; A,B for one of each of two results");
  command.add_value("--sort", options.sort, "KEY",
                    fmt::format("order of the errors of a sensitivity result: {}; order is that of the study; default: "
                                "effect",
                                fmt::join(kRowOrders, ", ")));
  command.add_whole_number("--top", options.top, "N", "only the first N errors of a sensitivity result", 1,
                           kMostNumber);
  command.add_whole_number("--width", options.width, "N",
                           "characters of a line; default: the terminal's, and where there is none, no limit", 1,
                           kMostNumber);
  command.add_flag("--json", options.json, "the tables as JSON with all digits, and nothing else");
  command.examples = {{"the tables of a result", "poesy show result.h5"},
                      {"the ten errors that matter most to another response",
                       "poesy show result.h5 --response angular_deformation --top 10"},
                      {"the rankings of two studies beside each other", "poesy show platform.h5 published.h5"}};
  return command;
}

}  // namespace poesy::app
