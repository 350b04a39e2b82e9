#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/results.h"
#include "engine/app/shown_response.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/study_file.h"
#include "engine/report/display.h"
#include "engine/report/latex_text.h"
#include "engine/report/merits.h"
#include "engine/report/method.h"
#include "engine/report/one_study.h"
#include "engine/report/report_kind.h"
#include "engine/report/signs.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"
#include "engine/study/mechanism_doubts.h"
#include "engine/study/study.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

constexpr std::string_view kRemedy = "a wider terminal, --response NAME or --json";

constexpr std::size_t kMostNumber = 1'000'000;

struct ShowOptions {
  std::vector<std::string> results;  ///< paths of one result, or of several to compare
  std::string response;
  std::optional<std::string> sort;
  std::optional<std::size_t> top;
  std::optional<std::size_t> width;
  bool json = false;
  bool method = false;  ///< true to show the method in words instead of tables
  bool latex = false;   ///< true to print the method as LaTeX
};

RowOrder order_of(const ShowOptions& options) {
  if (!options.sort) return RowOrder::effect;
  const auto at = std::ranges::find(kRowOrders, *options.sort);
  if (at != kRowOrders.end()) return static_cast<RowOrder>(at - kRowOrders.begin());
  throw InputError({}, fmt::format("--sort: '{}' is not an order of errors", printable(*options.sort)),
                   suggestion(*options.sort, kRowOrders));
}

/// Throws InputError if --sort is given although the errors of this kind of result have a fixed order, or --top is
/// given although the result ranks no errors.
void check_ranks(const ShowOptions& options, const std::string& path, const StoredResult& result,
                 const std::vector<Table>& tables) {
  const auto refuse = [&](std::string_view option, std::string_view what) {
    throw InputError({path}, fmt::format("{}: this result of kind '{}' {}", option, result.kind, what),
                     fmt::format("leave out {}", option));
  };
  if (options.sort && !kind_of(result).report.sorts) refuse("--sort", "has no errors that come in any order");
  if (options.top && std::ranges::none_of(tables, &Table::ranked)) refuse("--top", "ranks no errors");
}

/// Remarks and warnings on the mechanism and the poses and, unless a table of errors was solved, notes on calibration,
/// constant errors and errors left out. Empty if this program cannot read the result's study.
std::string study_lines(const StoredResult& result, std::size_t width) {
  const std::optional<Study> study = study_in(result, registry());
  if (!study) return {};
  const std::unique_ptr<Model> model = build_model(study->mechanism);
  std::vector<std::string> lines = model->remarks();
  std::vector<std::string> doubts = mechanism_doubts(study->mechanism, *model);
  if (std::string doubt = zones_doubt(*study); !doubt.empty()) doubts.push_back(std::move(doubt));
  for (const std::string& doubt : doubts) lines.push_back("warning: " + doubt);
  const StudyWords words = kind_of(result).report.words(result);
  if (words.own_poses) {
    for (const std::string& doubt : workspace_doubts(*study, result.poses)) lines.push_back("warning: " + doubt);
  }
  if (!words.from_tables) {
    lines.push_back(calibration_text(*study));
    lines.push_back(held_errors_text(*study));
    lines.push_back(left_out_text(*study));
  }
  std::string text;
  for (const std::string& line : lines) {
    if (!line.empty()) text += prose_of(line, width);
  }
  return text;
}

/// Shortens the tables of single errors. Used for a result with features of a drawing, because these have a table of
/// their own.
void shorten_tables_of_errors(std::vector<Table>& tables) {
  constexpr std::size_t kShown = 20;
  for (Table& table : tables) {
    const bool of_errors = table.name == "first_order" || table.name == "mean_square_shares";
    if (!of_errors || !table.ranked || table.rows.size() <= kShown) continue;
    keep_first(kShown, std::span(&table, 1));
    table.notes.back() += "; --top N shows more, --json all";
  }
}

std::size_t width_of(const ShowOptions& options) { return options.width.value_or(output_width()); }

int show_one(const ShowOptions& options) {
  const std::string& path = options.results.front();
  const RowOrder order = order_of(options);
  StoredResult result = read_result_with_warning(path);
  const std::string response = choose_response(options.response, path, result);
  const ReportKind& kind = kind_of(result).report;
  std::vector<Table> tables = result_tables(kind, result, {response, order});
  check_ranks(options, path, result, tables);
  const SolveTally tally = kind.tally(result);
  if (options.top) {
    keep_first(*options.top, tables);
  } else if (result.drawing && !options.json) {
    shorten_tables_of_errors(tables);
  }
  const std::size_t width = width_of(options);
  if (!options.json && !shows_signs()) use_words(tables);
  print(options.json ? json_of(result, tally.total(), tables)
                     : summary_text(result, tally, width) + study_lines(result, width) +
                           failures_text(result, tally, path, width) + "\n" + text_of(tables, width, kRemedy));
  return kDone;
}

/// The response for each of several results. The option --response names one for all results, or one for each result,
/// separated by commas. Without the option, each result has its default response.
std::vector<std::string> responses_of(const ShowOptions& options, std::span<const ReportedResult> results) {
  std::vector<std::string> names;
  for (std::size_t from = 0; from <= options.response.size();) {
    const std::size_t comma = std::min(options.response.find(',', from), options.response.size());
    names.push_back(options.response.substr(from, comma - from));
    from = comma + 1;
  }
  if (names.size() > 1 && names.size() != results.size()) {
    throw InputError({}, fmt::format("--response: {} names for {} results", names.size(), results.size()),
                     "name one response, or one for each result");
  }
  names.resize(results.size(), names.front());
  for (std::size_t n = 0; n < results.size(); ++n) {
    names[n] = response_of(names[n], results[n].path, results[n].stored);
  }
  return names;
}

/// Adds to `compared` the comparison of two results: the two rankings of errors, or, if the kind of study ranks no
/// errors, the kind's own table of comparison for the first result's response.
void compare_two(const ReportKind& kind, std::span<const ReportedResult> results, std::span<const RankedResult> ranked,
                 RowOrder order, ComparedResults& compared) {
  if (kind.two_rankings == nullptr) {
    const Comparison both = comparison(kind, results[0], results[1]);
    const auto shown = std::ranges::find(both.a.options, ranked[0].response);
    std::vector<Table> tables = comparison_tables(both);
    const auto first = shown == both.a.options.end() ? 0 : shown - both.a.options.begin();
    compared.tables.push_back(std::move(tables[static_cast<std::size_t>(first)]));
    return;
  }
  TwoRankings rankings = kind.two_rankings(ranked[0], ranked[1], order);
  compared.tables.push_back(std::move(rankings.table));
  compared.tau = rankings.tau;
  compared.remarks = std::move(rankings.remarks);
}

/// The comparison of results: figures of merit, settings that differ, and, for two results, errors or other items.
/// wanted: the response that the user named for all results; may be empty.
ComparedResults compare(const ReportKind& kind, std::span<const ReportedResult> results,
                        std::span<const RankedResult> ranked, RowOrder order, const std::string& wanted) {
  ComparedResults compared;
  std::vector<const StoredResult*> stored;
  for (const ReportedResult& one : results) stored.push_back(&one.stored);
  if (std::optional<Table> table = merits_table(compared_merits(kind, stored, wanted)))
    compared.tables.push_back(std::move(*table));
  for (std::size_t n = 1; n < results.size(); ++n) {
    Table settings = settings_table(*stored[0], *stored[n], n, false);
    if (!settings.rows.empty()) compared.tables.push_back(std::move(settings));
  }
  if (results.size() == 2) compare_two(kind, results, ranked, order, compared);
  for (std::size_t n = 1; n < results.size(); ++n) {
    std::string sweep = sweep_text(*stored[0], *stored[n], letter_of(n));
    if (!sweep.empty()) compared.remarks.push_back(std::move(sweep));
  }
  return compared;
}

/// Shows which of several results is better, and how they differ.
int show_several(const ShowOptions& options) {
  const RowOrder order = order_of(options);
  std::vector<ReportedResult> results;
  for (const std::string& path : options.results) {
    results.push_back({read_result_with_warning(path), path});
    check_comparable(results.front().stored, results.front().path, results.back().stored, path);
  }
  const ReportKind& kind = kind_of(results.front().stored).report;
  const std::vector<std::string> responses = responses_of(options, results);
  std::vector<RankedResult> ranked;
  for (std::size_t n = 0; n < results.size(); ++n) {
    const StoredResult& stored = results[n].stored;
    ranked.push_back({stored, results[n].path, responses[n], kind.tally(stored).total()});
  }
  const bool names_one = options.response.find(',') == std::string::npos;
  ComparedResults compared = compare(kind, results, ranked, order, names_one ? options.response : std::string());
  if (options.top) keep_first(*options.top, compared.tables);
  if (options.json) {
    print(json_of(ranked, compared));
    return kDone;
  }
  const std::size_t width = width_of(options);
  const std::string_view role = kind.two_rankings == nullptr ? "response" : "ranked by";
  std::string text;
  for (std::size_t n = 0; n < ranked.size(); ++n) text += prose_of(ranked_text(letter_of(n), ranked[n], role), width);
  text += "\n" + text_of(compared.tables, width, kRemedy);
  for (const std::string& remark : compared.remarks) text += prose_of(remark, width);
  print(text);
  return kDone;
}

/// Prints a description of the method of one result, and what a paper should cite.
int show_method(const ShowOptions& options) {
  if (options.results.size() > 1) {
    throw InputError({}, "--method describes one result, but several are given", "give one");
  }
  const StoredResult result = read_result_with_warning(options.results.front());
  const ReportKind& kind = kind_of(result).report;
  const std::optional<Study> study = study_in(result, registry());
  const std::string text = method_text(kind, result, study ? &*study : nullptr);
  print(prose_of(options.latex ? latex_text(text) : text, width_of(options)) + "\n" + method_references(kind, result));
  return kDone;
}

int show(const ShowOptions& options) {
  if (options.method) return show_method(options);
  return options.results.size() == 1 ? show_one(options) : show_several(options);
}

}  // namespace

Command& add_show(Command& program) {
  const auto [command, options] =
      program.add_command("show", "print a result as tables, or which of several is better", show);
  command
      .add_value("results", options.results, "RESULT.h5",
                 "result file, or several of one kind, A, B, ..., which are compared with A")
      ->required()
      ->expected(1, kMostResults);
  command.add_value("--response", options.response, "RESPONSE",
                    "response to rank by, or to show alone where nothing is ranked; A,B,... for one of each result");
  command.add_value("--sort", options.sort, "KEY",
                    fmt::format("order of the errors of a sensitivity result: {}; order is that of the study; default: "
                                "effect",
                                fmt::join(kRowOrders, ", ")));
  command.add_whole_number("--top", options.top, "N", "only the first N errors of a sensitivity result", 1,
                           kMostNumber);
  command.add_whole_number("--width", options.width, "N",
                           "characters of a line; default: the terminal's, and where there is none, no limit", 1,
                           kMostNumber);
  auto* const json = command.add_flag("--json", options.json, "the tables as JSON with all digits, and nothing else");
  auto* const method =
      command.add_flag("--method", options.method, "the method in words with this study's numbers, and what to cite")
          ->excludes(json);
  command.add_flag("--latex", options.latex, "with --method: the words as LaTeX")->needs(method);
  command.examples = {{"the tables of a result", "poesy show result.h5"},
                      {"the ten errors that matter most to another response",
                       "poesy show result.h5 --response angular_deformation --top 10"},
                      {"which of two designs is better, and why", "poesy show before.h5 after.h5"}};
  return command;
}

}  // namespace poesy::app
