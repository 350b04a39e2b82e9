#include <fmt/format.h>

#include <numeric>

#include "engine/base/text.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"
#include "engine/report/text_table.h"

namespace poesy {
namespace {

std::string count_line(std::uint64_t failed, std::uint64_t solves) {
  const double share = solves == 0 ? 0.0 : static_cast<double>(failed) / static_cast<double>(solves);
  return fmt::format("{} of {} ({}) did not converge", count_text(failed), counted(solves, "solve", "solves"),
                     percent_text(share));
}

/// Both fidelities make as many solves; what is known one by one are the failures of the first.
std::string line_of_both(const StoredResult& result, const SolveCounts& first) {
  const std::vector<std::uint64_t>& second = result.sensitivity.fidelity->not_converged;
  const auto failed = std::accumulate(second.begin(), second.end(), std::uint64_t{0});
  return fmt::format("{}: {} at fidelity \"{}\", {} at \"{}\"",
                     count_line(first.not_converged() + failed, 2 * first.total()), count_text(first.not_converged()),
                     result.fidelities[0], count_text(failed), result.fidelities[1]);
}

/// Which of the failures the result lists.
std::string listed_text(const StoredResult& result, std::uint64_t failed) {
  const std::size_t listed = listed_failures(result).size();
  const std::string of = result.sensitivity.fidelity ? fmt::format(" at \"{}\"", result.fidelities[0]) : "";
  if (listed == failed) return fmt::format("lists {}{}", failed == 1 ? "it" : "all " + count_text(failed), of);
  return fmt::format("lists {} of the {}{} (at most {} of each {}, and {} in all)", count_text(listed),
                     count_text(failed), of, FailedSamples::kMost,
                     result.kind == "sensitivity" ? "error and pose" : "pose", count_text(kMostFailuresListed));
}

}  // namespace

std::string failures_text(const StoredResult& result, const std::string& path, std::size_t width) {
  const SolveCounts solves = solves_of(result);
  std::string text = prose_of(
      result.sensitivity.fidelity ? line_of_both(result, solves) : count_line(solves.not_converged(), solves.total()),
      width);
  if (listed_failures(result).empty()) return text;
  const Failure& first = listed_failures(result).front();
  const std::string name = printable(varied_name(result, first.slot), std::string::npos);
  const std::string pose = std::to_string(first.pose.value);
  const std::string sample = std::to_string(first.failed.sample.value);
  text +=
      prose_of(fmt::format("the first of them (error, pose, sample): {} {} {}, {}; failures.csv of 'poesy export' {}",
                           name, pose, sample, kStatusNames[static_cast<std::size_t>(first.failed.status)],
                           listed_text(result, solves.not_converged())),
               width);
  return text + "replay it: " + shell_command({"poesy", "replay", path, name, pose, sample}) + "\n";
}

}  // namespace poesy
