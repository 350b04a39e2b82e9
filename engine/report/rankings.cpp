#include "engine/report/rankings.h"

#include <fmt/format.h>

#include "engine/base/error.h"
#include "engine/report/display.h"

namespace poesy {

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

bool differ_in_metric(const StoredResult& a, const StoredResult& b) {
  return !a.metric.empty() && !b.metric.empty() && a.metric != b.metric;
}

std::string ranked_text(char letter, const RankedResult& ranked) {
  const StoredResult& result = ranked.result;
  std::string text = result.title.empty() ? fmt::format("{}: {}", letter, ranked.path)
                                          : fmt::format("{}: {} ({})", letter, result.title, ranked.path);
  if (!result.metric.empty()) text += "; metric: " + metric_text(result);
  return text + fmt::format("; ranked by {}; {} of {} did not converge", ranked.response,
                            count_text(ranked.solves.not_converged()),
                            counted(ranked.solves.total(), "solve", "solves"));
}

}  // namespace poesy
