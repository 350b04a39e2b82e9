#include "engine/report/in_common.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/error.h"

namespace poesy {

Common common(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  Common both;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const auto at = std::ranges::find(b, a[n]);
    if (at != b.end()) both.emplace_back(n, static_cast<std::size_t>(at - b.begin()));
  }
  return both;
}

std::vector<std::string> only_in(const std::vector<std::string>& these, const std::vector<std::string>& others) {
  std::vector<std::string> list;
  for (const std::string& name : these) {
    if (std::ranges::find(others, name) == others.end()) list.push_back(name);
  }
  return list;
}

void check_comparable(const StoredResult& a, const std::string& path_a, const StoredResult& b,
                      const std::string& path_b) {
  const auto check = [&](std::string_view what, const std::string& of_a, const std::string& of_b) {
    if (of_a == of_b) return;
    throw InputError({.file = path_b},
                     fmt::format("cannot be compared with {}: its {} is '{}', not '{}'", path_a, what, of_b, of_a),
                     "compare two results of one kind and mechanism, or look at each alone");
  };
  check("kind", a.kind, b.kind);
  check("mechanism", a.model, b.model);
}

}  // namespace poesy
