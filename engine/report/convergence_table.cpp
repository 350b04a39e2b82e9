#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

constexpr std::size_t kMostShown = 5;

/// Positions among [R x P] of the quantities that count for the end and did not reach it, the widest first.
std::vector<std::size_t> not_reached(const ConvergenceResult& found, const std::vector<std::size_t>& responses) {
  const std::size_t slots = found.samples.size();
  std::vector<std::size_t> list;
  for (const std::size_t r : responses) {
    for (std::size_t at = r * slots; at < (r + 1) * slots; ++at) {
      if (found.reached[at] == 0) list.push_back(at);
    }
  }
  const auto width = [&](std::size_t at) {
    const double relative = found.relative_half_width[at];
    return std::isnan(relative) ? HUGE_VAL : relative;
  };
  std::ranges::stable_sort(list, std::ranges::greater(), width);
  return list;
}

std::string samples_text(const ConvergenceResult& found) {
  const auto [least, most] = std::ranges::minmax(found.samples);
  if (least == most) return fmt::format("{} samples at each pose", count_text(least));
  return fmt::format("from {} to {} samples at each pose", count_text(least), count_text(most));
}

/// The samples that would do, for half-widths fall with their root; to two digits, upwards.
std::string needed_text(const ConvergenceResult& found, std::size_t at) {
  const double ratio = found.relative_half_width[at] / found.relative_error;
  const double needed = static_cast<double>(found.samples[at % found.samples.size()]) * ratio * ratio;
  if (!(needed < 1e15)) return "more samples cannot be told";
  const double digit = std::pow(10.0, std::floor(std::log10(needed)) - 1.0);
  return fmt::format("about {} samples would do",
                     count_text(static_cast<std::uint64_t>(std::ceil(needed / digit) * digit)));
}

std::string not_reached_rows(const StoredResult& result, const ConvergenceResult& found,
                             const std::vector<std::size_t>& missing) {
  const std::size_t slots = found.samples.size();
  std::string text;
  for (std::size_t n = 0; n < std::min(missing.size(), kMostShown); ++n) {
    const std::size_t at = missing[n];
    const std::string error = result.kind == "sensitivity" ? result.factors[at % slots].name : "all errors";
    text += fmt::format("  {:<16}  {:<22}  {:>8.3g} %  {}\n", error, result.responses[at / slots].name,
                        100.0 * found.relative_half_width[at], needed_text(found, at));
  }
  if (missing.size() > kMostShown) text += fmt::format("  and {} more\n", missing.size() - kMostShown);
  return text;
}

}  // namespace

std::string convergence_table(const StoredResult& result) {
  const bool indices = result.kind == "sensitivity";
  const auto& convergence = indices ? result.sensitivity.convergence : result.monte_carlo.convergence;
  if (!convergence) return "";
  const ConvergenceResult& found = *convergence;
  std::vector<std::size_t> responses = result.headline;
  if (indices) {
    responses.clear();
    for (std::size_t r = 0; r < result.responses.size(); ++r) responses.push_back(r);
  }
  const std::vector<std::size_t> missing = not_reached(found, responses);
  const std::size_t all = responses.size() * found.samples.size();
  std::string text =
      fmt::format("\nConvergence: {} of {} {} have a {:.3g} % interval within +-{:.3g} % of their value, {}\n",
                  all - missing.size(), all, indices ? "global indices" : "overall means", 100.0 * found.conf_level,
                  100.0 * found.relative_error, samples_text(found));
  if (missing.empty()) return text;
  return text + not_reached_rows(result, found, missing) +
         fmt::format("Raise max, which is {}, and go on with --resume if the checkpoint was kept\n",
                     count_text(found.max));
}

}  // namespace poesy
