#include "engine/report/far_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

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

/// True if all of the judged draws, machines or rows are good, false if none is. None if only some are good, or if
/// nothing was judged.
std::optional<bool> all_or_none(std::uint64_t good, std::uint64_t judged) {
  if (judged == 0 || (good > 0 && good < judged)) return std::nullopt;
  return good == judged;
}

}  // namespace

bool is_far(double times) { return times > kFar && times < kLargestRatio; }

std::vector<std::string> far_limit_notes(const StoredResult& result,
                                         const std::function<double(std::size_t limit)>& typical,
                                         std::string_view name) {
  if (!result.verdicts) return {};
  std::vector<std::string> notes;
  for (std::size_t k = 0; k < result.verdicts->limits.size(); ++k) {
    const LimitVerdict& one = result.verdicts->limits[k];
    const std::optional<bool> all_good = all_or_none(one.within, one.tried);
    if (!all_good || one.limit.is_spread()) continue;
    const double limit = size_of(one.limit);
    const double ratio = *all_good ? limit / typical(k) : typical(k) / limit;
    if (!is_far(ratio)) continue;
    const std::string& response = result.responses[one.response].name;
    const std::string times = number_text(ratio, 2);
    notes.push_back((*all_good ? fmt::format("The limit of {} is {} times its {}", response, times, name)
                               : fmt::format("The {} of {} is {} times its limit", name, response, times)) +
                    std::string(kLookAtUnits));
  }
  return notes;
}

}  // namespace poesy
