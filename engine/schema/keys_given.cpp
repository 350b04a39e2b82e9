#include "engine/schema/keys_given.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/schema/toml_text.h"

namespace poesy {
namespace {

/// The names in the full name of a key: the names of the tables around it, followed by the name of the key itself.
std::vector<std::string_view> parts_of(std::string_view key) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= key.size();) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    parts.push_back(key.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// Writes a value into a table. If the value is not TOML, it is written as a text.
void assign(toml::table& table, std::string_view key, const std::string& value) {
  const bool is_line = std::ranges::none_of(value, [](char c) { return c == '\n' || c == '\r' || c == '#'; });
  if (is_line) {
    try {
      const toml::table parsed = parse_toml("value = " + value, {}, {});
      if (parsed.size() == 1) return static_cast<void>(table.insert_or_assign(key, *parsed.get("value")));
    } catch (const InputError&) {
      // The value is a text without quotes.
    }
  }
  table.insert_or_assign(key, value);
}

}  // namespace

void set_key(toml::table& file, const GivenKey& given) {
  constexpr std::size_t kMostParts = 8;
  const std::vector<std::string_view> parts = parts_of(given.key);
  if (std::ranges::any_of(parts, &std::string_view::empty) || parts.size() > kMostParts) {
    throw InputError({}, "'" + printable(given.key) + "' is not the name of a key",
                     "write tables and key with points between them, e.g. mechanism.geometry.R");
  }
  toml::table* table = &file;
  for (const std::string_view part : std::vector(parts.begin(), parts.end() - 1)) {
    if (table->get(part) == nullptr) table->insert(part, toml::table{});
    toml::table* const inner = table->get(part)->as_table();
    if (inner == nullptr) {
      throw InputError(
          {},
          "'" + printable(part) + "' is not a table in this study, so it has no key for '" + printable(given.key) + "'",
          "name a key that stands in tables alone");
    }
    table = inner;
  }
  assign(*table, parts.back(), given.value);
}

}  // namespace poesy
