#include <fmt/format.h>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {

std::string failures_text(const StoredResult& result, std::string_view path) {
  const SolveCounts solves = solves_of(result);
  const double share =
      solves.total() == 0 ? 0.0 : static_cast<double>(solves.not_converged()) / static_cast<double>(solves.total());
  std::string text = fmt::format("{} of {} solves ({}) did not converge\n", count_text(solves.not_converged()),
                                 count_text(solves.total()), percent_text(share));
  const std::vector<Failure>& failures = listed_failures(result);
  if (failures.empty()) return text;
  const Failure& first = failures.front();
  const std::string address =
      fmt::format("{} {} {}", varied_name(result, first.slot), first.pose.value, first.failed.sample.value);
  return text + fmt::format(
                    "the first of them (error, pose, sample): {}, {}; {} are listed in failures.csv of 'poesy export'\n"
                    "replay it: poesy replay {} {}\n",
                    address, kStatusNames[static_cast<std::size_t>(first.failed.status)], failures.size(), path,
                    address);
}

}  // namespace poesy
