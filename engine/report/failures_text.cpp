#include <fmt/format.h>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {

std::string failures_text(const StoredResult& result, std::string_view path) {
  const std::vector<Failure>& failures = listed_failures(result);
  if (failures.empty()) return {};
  const SolveCounts solves = result.kind == "monte-carlo" ? result.monte_carlo.total() : result.sensitivity.total();
  const Failure& first = failures.front();
  const std::string address =
      fmt::format("{} {} {}", varied_name(result, first.slot), first.pose.value, first.failed.sample.value);
  return fmt::format(
      "{} of {} samples failed; first (error, pose, sample): {}, {}; {} listed in failures.csv of "
      "'poesy export'\nreplay it: poesy replay {} {}\n",
      count_text(solves.not_converged()), count_text(solves.total()), address,
      kStatusNames[static_cast<std::size_t>(first.failed.status)], failures.size(), path, address);
}

}  // namespace poesy
