#include "engine/report/far_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/report/display.h"

namespace poesy {
namespace {

constexpr double kFar = 30.0;
constexpr double kLargestRatio = 1e9;  // a larger ratio is due to a response that is zero up to rounding

/// The magnitude of the end of a limit that is farther from zero, or of the other end if that one is infinite.
double size_of(const ValueLimit& limit) {
  const double from = std::abs(limit.from());
  const double to = std::abs(limit.to());
  return std::isinf(from) ? to : std::isinf(to) ? from : std::max(from, to);
}

}  // namespace

std::vector<std::string> far_limit_notes(const StoredResult& result,
                                         const std::function<double(std::size_t limit)>& typical,
                                         std::string_view name) {
  if (!result.verdicts || !result.verdicts->yield) return {};
  const YieldVerdict& yield = *result.verdicts->yield;
  const bool all_good = yield.rejects == 0;
  if (yield.machines == 0 || (!all_good && yield.rejects < yield.machines)) return {};
  std::vector<std::string> notes;
  for (std::size_t k = 0; k < result.verdicts->limits.size(); ++k) {
    const LimitVerdict& one = result.verdicts->limits[k];
    const double limit = size_of(one.limit);
    const double ratio = all_good ? limit / typical(k) : typical(k) / limit;
    if (one.limit.is_spread() || !(ratio > kFar && ratio < kLargestRatio)) continue;
    const std::string& response = result.responses[one.response].name;
    const std::string times = number_text(ratio, 2);
    notes.push_back((all_good ? fmt::format("The limit of {} is {} times its {}", response, times, name)
                              : fmt::format("The {} of {} is {} times its limit", name, response, times)) +
                    ": look at the units of limits and sigmas");
  }
  return notes;
}

}  // namespace poesy
