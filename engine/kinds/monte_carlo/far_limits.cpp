#include "engine/kinds/monte_carlo/far_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/kinds/monte_carlo/result.h"
#include "engine/report/display.h"

namespace poesy {
namespace {

constexpr double kFar = 30.0;

/// The magnitude of the end of a limit that is farther from zero, or of the other end if that one is infinite.
double size_of(const ValueLimit& limit) {
  const double from = std::abs(limit.from());
  const double to = std::abs(limit.to());
  return std::isinf(from) ? to : std::isinf(to) ? from : std::max(from, to);
}

}  // namespace

std::vector<std::string> far_limit_notes(const StoredResult& result) {
  if (!result.verdicts || !result.verdicts->yield) return {};
  const YieldVerdict& yield = *result.verdicts->yield;
  const bool all_good = yield.rejects == 0;
  if (yield.machines == 0 || (!all_good && yield.rejects < yield.machines)) return {};
  const MonteCarloResult& found = monte_carlo_of(result);
  std::vector<std::string> notes;
  for (const LimitVerdict& one : result.verdicts->limits) {
    const double rms = found.overall_rms(one.response);
    const double limit = size_of(one.limit);
    const double ratio = all_good ? limit / rms : rms / limit;
    if (one.limit.is_spread() || !std::isfinite(ratio) || ratio <= kFar) continue;
    const std::string& name = result.responses[one.response].name;
    const std::string times = number_text(ratio, 2);
    notes.push_back((all_good ? fmt::format("The limit of {} is {} times its root mean square", name, times)
                              : fmt::format("The root mean square of {} is {} times its limit", name, times)) +
                    ": look at the units of limits and sigmas");
  }
  return notes;
}

}  // namespace poesy
