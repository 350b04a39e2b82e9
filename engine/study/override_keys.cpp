#include "engine/study/override_keys.h"

#include <cstddef>
#include <limits>
#include <utility>

#include "engine/base/name_pattern.h"

namespace poesy {

bool is_key_of(const std::string& key, const std::string& factor) {
  return key == factor || (is_pattern(key) && matches(key, factor));
}

/// The line and column that order the keys in [errors.override]. A key that was given on the command line or in Python
/// has the place of the table, and is later than all keys of the file.
static std::pair<std::size_t, std::size_t> rank_of(const StudySection& overrides, const std::string& key) {
  constexpr std::size_t kLast = std::numeric_limits<std::size_t>::max();
  const Place at = overrides.require(key).place();
  const bool is_given = at.line == overrides.place().line && at.column == overrides.place().column;
  return is_given ? std::pair(kLast, kLast) : std::pair<std::size_t, std::size_t>(at.line, at.column);
}

std::optional<std::string> override_key(const StudySection& overrides, const std::string& factor) {
  std::optional<std::string> last;
  for (const std::string& key : overrides.keys()) {
    if (!is_key_of(key, factor)) continue;
    if (!last || rank_of(overrides, key) > rank_of(overrides, *last)) last = key;
  }
  return last;
}

std::optional<StudyValue> override_of(const StudySection& overrides, const std::string& factor) {
  const auto key = override_key(overrides, factor);
  return key ? std::optional(overrides.require(*key)) : std::nullopt;
}

}  // namespace poesy
