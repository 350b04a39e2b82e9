#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/app/changed_result.h"
#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/exit_code.h"
#include "engine/app/output_width.h"
#include "engine/app/whole_number.h"
#include "engine/base/error.h"
#include "engine/io/held_errors.h"
#include "engine/io/result_file.h"
#include "engine/io/study_file.h"
#include "engine/io/wording.h"
#include "engine/report/json_tables.h"
#include "engine/report/tables.h"
#include "engine/report/text_table.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

constexpr std::string_view kRemedy = "a wider terminal, --response NAME or --json";

constexpr std::size_t kMostNumber = 1'000'000;

struct ShowOptions {
  std::string result;
  std::string response;
  std::optional<std::string> sort;
  std::optional<std::size_t> top;
  std::optional<std::size_t> width;
  bool json = false;
};

std::string response_of(const ShowOptions& options, const StoredResult& result) {
  if (options.response.empty()) return default_ranking(result);
  std::string known;
  for (const NamedUnit& response : result.responses) {
    if (response.name == options.response) return response.name;
    known += (known.empty() ? "" : ", ") + response.name;
  }
  throw InputError({options.result},
                   fmt::format("--response: no response '{}' in this result", printable(options.response)),
                   "it has " + known);
}

RowOrder order_of(const ShowOptions& options) {
  if (!options.sort) return RowOrder::effect;
  const auto at = std::ranges::find(kRowOrders, *options.sort);
  if (at != kRowOrders.end()) return static_cast<RowOrder>(at - kRowOrders.begin());
  throw InputError({}, fmt::format("--sort: '{}' is no order of errors", printable(*options.sort)),
                   suggestion(*options.sort, kRowOrders));
}

/// ShowOptions that speak of ranked errors need some.
void check_ranks(const ShowOptions& options, const StoredResult& result) {
  if (result.kind == "sensitivity") return;
  for (const auto& [given, option] :
       {std::pair(options.sort.has_value(), "--sort"), {options.top.has_value(), "--top"}}) {
    if (!given) continue;
    throw InputError({options.result},
                     fmt::format("{}: this is a result of kind '{}', and only those of kind 'sensitivity' rank errors",
                                 option, result.kind),
                     fmt::format("leave out {}", option));
  }
}

/// Lets the tables show this response and no other.
void show_alone(const std::string& response, StoredResult& result) {
  const auto at = std::ranges::find(result.responses, response, &NamedUnit::name) - result.responses.begin();
  result.headline = result.signed_headline = {static_cast<std::size_t>(at)};
}

/// What the study held constant; empty where it held nothing, where a table of errors was solved instead of the study,
/// and where this program cannot read the study.
std::string held_errors_line(const StoredResult& result, std::size_t width) {
  if (result.kind == "evaluate" && result.cases.empty()) return {};
  try {
    const Study study = study_of_text(result.study_text, "the study in the result", registry(), StudyUse::evaluate);
    const std::string held = held_errors_text(study);
    return held.empty() ? held : prose_of(held, width);
  } catch (const InputError&) {
    return {};
  }
}

int show(const ShowOptions& options) {
  const RowOrder order = order_of(options);
  StoredResult result = read_result_warily(options.result);
  check_ranks(options, result);
  const std::string response = response_of(options, result);
  if (!options.response.empty() && result.kind != "sensitivity") show_alone(response, result);
  std::vector<Table> tables = result_tables(result, response, order);
  if (options.top) keep_first(*options.top, tables);
  const std::size_t width = options.width.value_or(output_width());
  const std::string text = options.json ? json_of(result, tables)
                                        : summary_text(result, width) + held_errors_line(result, width) +
                                              failures_text(result, options.result, width) + "\n" +
                                              text_of(tables, width, kRemedy);
  std::fputs(text.c_str(), stdout);
  return kDone;
}

}  // namespace

void add_show(CLI::App& program, Action& action) {
  auto options = std::make_shared<ShowOptions>();
  CLI::App* command = program.add_subcommand("show", "print a result as tables");
  command->add_option("result", options->result, "result file")->required()->type_name("RESULT.h5");
  command->add_option("--response", options->response, "response to rank by, or to show alone where nothing is ranked")
      ->type_name("RESPONSE");
  command
      ->add_option("--sort", options->sort,
                   fmt::format("order of the errors of a sensitivity result: {}; order is that of the study; default: "
                               "effect",
                               fmt::join(kRowOrders, ", ")))
      ->type_name("KEY");
  add_whole_number(*command, "--top", "--top", options->top, "only the first N errors of a sensitivity result", 1,
                   kMostNumber)
      ->type_name("N");
  add_whole_number(*command, "--width", "--width", options->width,
                   "characters of a line; default: the terminal's, and where there is none, no limit", 1, kMostNumber)
      ->type_name("N");
  command->add_flag("--json", options->json, "the tables as JSON with all digits, and nothing else");
  command->footer(footer("", {{"the tables of a result", "poesy show result.h5"},
                              {"the ten errors that matter most to another response",
                               "poesy show result.h5 --response angular_deformation --top 10"}}));
  command->callback([options, &action] { action = [options] { return show(*options); }; });
}

}  // namespace poesy::app
