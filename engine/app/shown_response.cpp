#include "engine/app/shown_response.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/registry.h"
#include "engine/report/display.h"
#include "engine/report/report_kind.h"
#include "engine/report/tables.h"

namespace poesy::app {
namespace {

bool ranks_errors(const StoredResult& result) { return kind_of(result).report.two_rankings != nullptr; }

/// The response that a user may mean by a word: WORD_position (the displacement of a point, "tip_position" for "tip"),
/// otherwise a similar name, otherwise the first name that begins with the word. Empty if there is none.
std::string meant_response(const std::string& wanted, const std::vector<std::string>& known) {
  const std::string displacement = wanted + "_position";
  if (std::ranges::find(known, displacement) != known.end()) return displacement;
  const std::string similar(nearest(wanted, std::vector<std::string_view>(known.begin(), known.end())));
  if (!similar.empty()) return similar;
  const auto longer = std::ranges::find_if(known, [&](const std::string& name) { return name.starts_with(wanted); });
  return longer == known.end() ? "" : *longer;
}

}  // namespace

std::string response_of(const std::string& wanted, const std::string& path, const StoredResult& result) {
  if (wanted.empty()) return default_ranking(result);
  const std::vector<std::string> known = names_of(result.responses);
  if (std::ranges::find(known, wanted) != known.end()) return wanted;
  const std::string meant = meant_response(wanted, known);
  throw InputError({path}, fmt::format("--response: no response '{}' in this result", printable(wanted)),
                   fmt::format("{}it has {}", meant.empty() ? "" : fmt::format("did you mean '{}'? ", meant),
                               fmt::join(known, ", ")));
}

std::string choose_response(const std::string& wanted, const std::string& path, StoredResult& result) {
  std::string response = response_of(wanted, path, result);
  if (!wanted.empty() && !ranks_errors(result)) {
    result.headline = result.signed_headline = {response_named(result, response)};
  }
  return response;
}

}  // namespace poesy::app
