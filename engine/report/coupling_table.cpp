#include "engine/report/coupling_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/report/display.h"
#include "engine/stats/tolerance.h"

namespace poesy {
namespace {

/// Values up to this are rounding at a size, see engine/run/coupling.h.
double rounding_at(const StoredCoupling& stored, std::size_t z) {
  return kIndexRounding * std::fmax(stored.linear[z], stored.angular[z]);  // passes over NaN
}

std::string number(double value, double unit, double rounding) {
  if (std::isnan(value)) return "-";
  return value <= rounding ? "0" : fmt::format("{:.5g}", value / unit);
}

/// Nothing where sources never oppose each other.
std::string opposed_cells(const CouplingResult& found, std::size_t at) {
  if (!(found.cancellation_max[at] > 0.0)) return {};
  return fmt::format("  {:>7.1f} %  {:>7.1f} % at pose {}", 100.0 * found.opposed_share[at],
                     100.0 * found.cancellation_max[at], found.cancellation_max_pose[at]);
}

std::string subset_row(const StoredResult& result, std::size_t r, std::size_t at, std::size_t width) {
  const StoredCoupling& stored = result.coupling;
  const CouplingResult& found = stored.found;
  const double rounding = rounding_at(stored, at / found.subsets % found.sizes);
  const auto cell = [&](double value) { return number(value, display(result.responses[r]).si, rounding); };
  std::string text = fmt::format("{:<{}}  {:>11}  {:>5}", stored.subsets[at % found.subsets], width,
                                 cell(found.effect_max[at]), found.effect_max_pose[at]);
  for (const double value : {found.root_sum_square_max[at], found.worst_case_max[at], found.interaction_max[at]}) {
    text += fmt::format("  {:>13}", cell(value));
  }
  return text + opposed_cells(found, at) + '\n';
}

std::string response_table(const StoredResult& result, std::size_t z, std::size_t r, std::size_t width) {
  const StoredCoupling& stored = result.coupling;
  const CouplingResult& found = stored.found;
  std::string text =
      fmt::format("\n{}: {} [{}]\n", stored.size_names[z], result.responses[r].name, display(result.responses[r]).name);
  text += fmt::format("{:<{}}  {:>11}  {:>5}  {:>13}  {:>13}  {:>13}  {:>9}  {}\n", "subset", width, "max|effect|",
                      "pose", "rss", "worst case", "interaction", "opposed", "cancellation");
  for (std::size_t k = 0; k < found.subsets; ++k) {
    text += subset_row(result, r, (r * found.sizes + z) * found.subsets + k, width);
  }
  return text;
}

/// Subsets have fewer poses where a solve that they rest on does not count.
std::string incomplete_text(const StoredResult& result) {
  const CouplingResult& found = result.coupling.found;
  const auto incomplete = std::ranges::count_if(found.count, [&](std::uint64_t count) { return count < found.poses; });
  if (incomplete == 0) return {};
  return "some subsets leave out poses that were not solved: see the export's coupling_summary.csv\n";
}

}  // namespace

std::string coupling_table(const StoredResult& result) {
  const StoredCoupling& stored = result.coupling;
  std::size_t width = 6;
  for (const std::string& subset : stored.subsets) width = std::max(width, subset.size());
  std::string text = fmt::format(
      "{} sources of errors, alone and together; largest values over {} poses. interaction: together minus the sum of "
      "each\nalone. opposed: share of the poses where the sum is less than its largest part\n",
      stored.sources.size(), stored.found.poses);
  text += incomplete_text(result);
  for (std::size_t z = 0; z < stored.found.sizes; ++z) {
    for (const std::size_t r : result.headline) text += response_table(result, z, r, width);
  }
  return text;
}

}  // namespace poesy
