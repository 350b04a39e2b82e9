#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

/// The response where a measure [R x P] of an error has its largest magnitude; none where it has no value.
std::optional<std::size_t> largest(const std::vector<double>& measure, std::size_t factor, std::size_t factors) {
  std::optional<std::size_t> found;
  for (std::size_t r = 0; r * factors < measure.size(); ++r) {
    const double value = std::abs(measure[r * factors + factor]);
    if (!std::isnan(value) && (!found || value > std::abs(measure[*found * factors + factor]))) found = r;
  }
  return found;
}

/// The largest value in percent and its response, two columns.
std::string cells(const StoredResult& result, const std::vector<double>& measure, std::size_t factor) {
  const std::size_t factors = result.sensitivity.factors;
  const auto at = largest(measure, factor, factors);
  if (!at) return fmt::format("{:>12}  {:<20}", "-", "");
  const double value = measure[*at * factors + factor];
  const std::string text = std::isinf(value) ? "no effect" : fmt::format("{:.3g} %", 100.0 * value);
  return fmt::format("{:>12}  {:<20}", text, std::isinf(value) ? "by the first" : result.responses[*at].name);
}

std::string verdict(const FidelityResult& found, std::size_t factor) {
  const std::size_t factors = found.linear.size();
  if (found.linear[factor] == 0) return "not linear";
  return largest(found.nonlinearity, factor, factors) ? "linear" : "no effect";
}

}  // namespace

std::string fidelity_table(const StoredResult& result, std::string_view ranked_by) {
  if (!result.sensitivity.fidelity) return "";
  const FidelityResult& found = *result.sensitivity.fidelity;
  std::string text = fmt::format(
      "\nFidelity \"{}\" against \"{}\" on the same draws, in percent of each error's largest index\n"
      "{:>4}  {:<16}  {:>12}  {:<20}  {:>12}  {:<20}  {}\n",
      result.fidelities[1], result.fidelities[0], "rank", "error", "discrepancy", "of", "nonlinearity", "of",
      "verdict");
  std::size_t rank = 0;
  for (const std::size_t p : ranking(result, response_named(result, ranked_by))) {
    text += fmt::format("{:>4}  {:<16}  {}  {}  {}\n", ++rank, result.factors[p].name,
                        cells(result, found.relative_discrepancy, p), cells(result, found.nonlinearity, p),
                        verdict(found, p));
  }
  const auto not_linear = std::ranges::count(found.linear, std::uint8_t{0});
  text += fmt::format("{} of {} errors are not linear: they differ by more than {:.3g} %, at the size the study sets\n",
                      not_linear, found.linear.size(), 100.0 * found.linearity);
  const auto failed = std::accumulate(found.not_converged.begin(), found.not_converged.end(), std::uint64_t{0});
  if (failed > 0) {
    text += fmt::format("{} solves at fidelity \"{}\" did not converge\n", count_text(failed), result.fidelities[1]);
  }
  return text;
}

}  // namespace poesy
