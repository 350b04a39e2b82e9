#include "engine/report/one_study.h"

#include <fmt/format.h>

#include <vector>

#include "engine/report/display.h"
#include "engine/report/merits.h"
#include "engine/report/requirements.h"

namespace poesy {
namespace {

bool has_yield(const StoredResult& result) { return result.verdicts && result.verdicts->yield; }

/// The keys that have different values in two studies, without those of [run]. Empty if a key is in only one of the
/// studies, or if one of the keys is a requirement, so that the yields cannot be compared.
std::vector<std::string> keys_that_differ(const StoredResult& a, const StoredResult& b) {
  std::vector<std::string> keys;
  for (const std::vector<Cell>& row : settings_table(a, b, 1, false).rows) {
    if (row[1].text == "-" || row[2].text == "-" || !required_by(row[0].text, kYieldMerit).empty()) return {};
    if (!row[0].text.starts_with("run.")) keys.push_back(row[0].text);
  }
  return keys;
}

}  // namespace

std::string sweep_text(const StoredResult& a, const StoredResult& b, char letter) {
  if (!has_yield(a) || !has_yield(b) || a.model != b.model || a.mechanism_text != b.mechanism_text) return {};
  const std::vector<std::string> keys = keys_that_differ(a, b);
  if (keys.empty()) return {};
  return fmt::format(
      "A and {} differ in keys of one study ({}): 'poesy sweep' judges the same machines in both, which makes the "
      "interval of the difference narrower.",
      letter, some_names(keys));
}

}  // namespace poesy
