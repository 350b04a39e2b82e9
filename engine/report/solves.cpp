#include "engine/report/solves.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/base/text.h"
#include "engine/report/display.h"
#include "engine/report/table.h"

namespace poesy {
namespace {

/// The value of solver.max_not_converged in the result's study; 1 if the study's text does not state it.
double max_not_converged(const StoredResult& result) {
  const std::string text = study_setting(result.study_text, "solver", "max_not_converged");
  double share = 1.0;
  std::from_chars(text.data(), text.data() + text.size(), share);
  return share;
}

/// The warning if more than kManyNotConverged of all solves did not converge, in all cases in which kMissing does not
/// apply.
constexpr std::string_view kDoubt =
    " That is more than 1 %: all numbers come from the solved samples, and both ways of treating such solves are wrong "
    "where they are many. Left out, they make numbers too small, because they are mostly the large errors; included, "
    "they fill them with unfinished iterates.";

/// The warning if more than kManyNotConverged of all solves did not converge, and most of these cannot be assembled.
constexpr std::string_view kMissing =
    " That is more than 1 %: means, spreads and quantiles are those of the machines that can be assembled.";

/// A sentence on the row (see SolveTally) and the pose with the largest shares of unsolved samples: " The largest
/// shares: ...". Empty if there is only one row and one pose.
std::string largest_shares_text(const StoredResult& result, const SolveTally& tally) {
  std::vector<std::string> places;
  const auto add = [&](const std::vector<double>& shares, const auto& name) {
    const auto at = std::ranges::max_element(shares, {}, [](double share) { return std::isnan(share) ? -1.0 : share; });
    places.push_back(fmt::format("{} {}", name(static_cast<std::size_t>(at - shares.begin())), percent_text(*at)));
  };
  if (tally.names.size() > 1) add(tally.shares_by_row(), [&](std::size_t row) { return tally.names[row]; });
  if (tally.poses > 1) add(tally.shares_by_pose(), [&](std::size_t m) { return place_text(result, m); });
  return places.empty() ? std::string() : fmt::format(" The largest shares: {}.", fmt::join(places, "; "));
}

std::string count_line(std::uint64_t failed, std::uint64_t samples, const SolveCounts& first) {
  const double share = samples == 0 ? 0.0 : share_of(failed, samples);
  return fmt::format("{} of {} ({}) {}", count_text(failed), counted_samples(samples, first.by_series()),
                     percent_text(share), why_unsolved(first));
}

/// Sentences on what follows if the share of unsolved samples is above kManyNotConverged, and advice if machines cannot
/// be assembled.
std::string consequences_text(const SolveCounts& solves) {
  const bool many = share_not_converged(solves) > kManyNotConverged;
  if (solves.not_assembled() == 0) return std::string(many ? kDoubt : "");
  return fmt::format("{} A machine that cannot be assembled is a reject, and {}.",
                     !many                       ? ""
                     : mostly_impossible(solves) ? kMissing
                                                 : kDoubt,
                     kAssemblyAdvice);
}

/// The line with the numbers of solves that did not converge at each of two fidelities.
std::string line_of_both(const SolveCounts& first, const SecondFidelity& second) {
  return fmt::format("{}: {} at fidelity \"{}\", {} at \"{}\"",
                     count_line(first.not_converged() + second.not_converged, first.total() + second.total, first),
                     count_text(first.not_converged()), second.first, count_text(second.not_converged), second.second);
}

/// Says how many of the failed solves the result lists one by one.
std::string listed_text(const StoredResult& result, const SolveTally& tally, std::uint64_t failed) {
  const std::size_t listed = result.failures.size();
  const std::string of = tally.second ? fmt::format(" at \"{}\"", tally.second->first) : "";
  if (listed == failed) return fmt::format("lists {}{}", failed == 1 ? "it" : "all " + count_text(failed), of);
  return fmt::format("lists {} of the {}{} (at most {} of each {}pose, and {} in all)", count_text(listed),
                     count_text(failed), of, FailedSamples::kMost,
                     tally.row_word.empty() ? "" : fmt::format("{} and ", tally.row_word),
                     count_text(kMostFailuresListed));
}

std::vector<double> shares_of(const std::vector<SolveCounts>& sums) {
  std::vector<double> list(sums.size());
  std::ranges::transform(sums, list.begin(), share_not_converged);
  return list;
}

}  // namespace

bool many_not_converged(const StoredResult& result, std::uint64_t failed, std::uint64_t solves) {
  return static_cast<double>(failed) >
         unremarkable_failure_share(max_not_converged(result)) * static_cast<double>(solves);
}

bool mostly_impossible(const SolveCounts& solves) { return 2 * solves.not_assembled() > solves.not_converged(); }

std::string why_unsolved(const SolveCounts& solves) {
  const std::uint64_t impossible = solves.not_assembled();
  if (impossible == 0) return "did not converge";
  const std::string some = impossible == solves.not_converged() ? std::string() : count_text(impossible) + " of them ";
  return fmt::format("found no solution, {}because the machine cannot be assembled", some);
}

std::string unsolved_in_short(const SolveCounts& solves) {
  const std::uint64_t impossible = solves.not_assembled();
  std::string text = fmt::format("{} not converged", solves.not_converged() - impossible);
  if (impossible > 0) text += fmt::format(", {} cannot be assembled", impossible);
  return text;
}

std::string counted_samples(std::uint64_t count, std::uint64_t by_series) {
  return by_series > 0 ? counted(count, "sample", "samples") : counted(count, "solve", "solves");
}

SolveCounts SolveTally::total() const {
  SolveCounts sum;
  for (const SolveCounts& cell : cells) sum.merge(cell);
  return sum;
}

std::size_t SolveTally::cells_by_series() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(cells, [](const SolveCounts& cell) { return cell.by_series() > 0; }));
}

std::vector<double> SolveTally::shares() const { return shares_of(cells); }

std::vector<double> SolveTally::shares_by_row() const {
  std::vector<SolveCounts> sums(names.size());
  for (std::size_t at = 0; at < cells.size(); ++at) sums[at / poses].merge(cells[at]);
  return shares_of(sums);
}

std::vector<double> SolveTally::shares_by_pose() const {
  std::vector<SolveCounts> sums(poses);
  for (std::size_t at = 0; at < cells.size(); ++at) sums[at % poses].merge(cells[at]);
  return shares_of(sums);
}

std::string at_first_fidelity(const SolveTally& tally) {
  return tally.second ? fmt::format(" at fidelity \"{}\"", tally.second->first) : std::string();
}

std::string unsolved_text(const StoredResult& result, const SolveTally& tally) {
  const SolveCounts total = tally.total();
  return fmt::format("{} of {}{} ({}) {}.{}{}", count_text(total.not_converged()),
                     counted_samples(total.total(), total.by_series()), at_first_fidelity(tally),
                     percent_text(share_not_converged(total)), why_unsolved(total), consequences_text(total),
                     largest_shares_text(result, tally));
}

std::string failures_text(const StoredResult& result, const SolveTally& tally, const std::string& path,
                          std::size_t width) {
  const SolveCounts solves = tally.total();
  if (solves.total() == 0) return {};
  std::string text = prose_of(
      tally.second ? line_of_both(solves, *tally.second) : count_line(solves.not_converged(), solves.total(), solves),
      width);
  if (result.failures.empty()) return text;
  const Failure& first = result.failures.front();
  const std::string name = printable_line(result.varied[first.slot]);
  const std::string pose = std::to_string(first.pose.value);
  const std::string sample = std::to_string(first.failed.sample.value);
  text +=
      prose_of(fmt::format("the first of them (error, pose, sample): {} {} {}, {}; failures.csv of 'poesy export' {}",
                           name, pose, sample, kStatusNames[static_cast<std::size_t>(first.failed.status)],
                           listed_text(result, tally, solves.not_converged())),
               width);
  return text + "replay it: " + shell_command({"poesy", "replay", path, name, pose, sample}) + "\n";
}

}  // namespace poesy
