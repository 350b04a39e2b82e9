#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "engine/app/changed_result.h"
#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/exit_code.h"
#include "engine/base/error.h"
#include "engine/io/result_file.h"
#include "engine/report/tables.h"

namespace poesy::app {
namespace {

struct Options {
  std::string result;
  std::string response;
};

std::string response_of(const Options& options, const StoredResult& result) {
  if (options.response.empty()) return default_ranking(result);
  std::string known;
  for (const NamedUnit& response : result.responses) {
    if (response.name == options.response) return response.name;
    known += (known.empty() ? "" : ", ") + response.name;
  }
  throw InputError({options.result}, fmt::format("--response: no response '{}' in this result", options.response),
                   "it has " + known);
}

/// Lets the tables show this response and no other.
void show_alone(const std::string& response, StoredResult& result) {
  const auto at = std::ranges::find(result.responses, response, &NamedUnit::name) - result.responses.begin();
  result.headline = result.signed_headline = {static_cast<std::size_t>(at)};
}

int show(const Options& options) {
  StoredResult result = read_result_warily(options.result);
  const std::string response = response_of(options, result);
  if (!options.response.empty() && result.kind != "sensitivity") show_alone(response, result);
  std::fputs(summary_text(result).c_str(), stdout);
  std::fputs(failures_text(result, options.result).c_str(), stdout);
  std::fputs("\n", stdout);
  std::fputs(result_tables(result, response).c_str(), stdout);
  return kDone;
}

}  // namespace

void add_show(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("show", "print a result as tables");
  command->add_option("result", options->result, "result file")->required()->type_name("RESULT.h5");
  command->add_option("--response", options->response, "response to rank by, or to show alone where nothing is ranked")
      ->type_name("NAME");
  command->footer(footer("", {{"the tables of a result", "poesy show result.h5"},
                              {"ranked by another response", "poesy show result.h5 --response angular_deformation"}}));
  command->callback([options, &action] { action = [options] { return show(*options); }; });
}

}  // namespace poesy::app
