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

}  // namespace

std::string response_of(const std::string& wanted, const std::string& path, const StoredResult& result) {
  if (wanted.empty()) return default_ranking(result);
  const std::vector<std::string> known = names_of(result.responses);
  if (std::ranges::find(known, wanted) != known.end()) return wanted;
  throw InputError({path}, fmt::format("--response: no response '{}' in this result", printable(wanted)),
                   fmt::format("it has {}", fmt::join(known, ", ")));
}

std::string choose_response(const std::string& wanted, const std::string& path, StoredResult& result) {
  std::string response = response_of(wanted, path, result);
  if (!wanted.empty() && !ranks_errors(result)) {
    result.headline = result.signed_headline = {response_named(result, response)};
  }
  return response;
}

}  // namespace poesy::app
