#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
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
  if (least == most) return counted(least, "sample", "samples") + " at each pose";
  return fmt::format("from {} to {} samples at each pose", count_text(least), count_text(most));
}

/// The samples that would do, for half-widths fall with their root; to two digits, upwards.
Cell needed_cell(const ConvergenceResult& found, std::size_t at) {
  const double ratio = found.relative_half_width[at] / found.relative_error;
  const double needed = static_cast<double>(found.samples[at % found.samples.size()]) * ratio * ratio;
  if (!(needed < 1e15)) return text_cell("unknown");
  const double digit = std::pow(10.0, std::floor(std::log10(needed)) - 1.0);
  return count_cell(static_cast<std::uint64_t>(std::ceil(needed / digit) * digit));
}

void add_rows(Table& table, const StoredResult& result, const ConvergenceResult& found,
              const std::vector<std::size_t>& missing) {
  const std::size_t slots = found.samples.size();
  for (std::size_t n = 0; n < std::min(missing.size(), kMostShown); ++n) {
    const std::size_t at = missing[n];
    table.rows.push_back({text_cell(result.kind == "sensitivity" ? result.factors[at % slots].name : "all errors"),
                          text_cell(result.responses[at / slots].name), percent_cell(found.relative_half_width[at]),
                          needed_cell(found, at)});
  }
}

/// Sensitivity studies ask it of every response, Monte Carlo studies of the headline.
std::vector<std::size_t> responses_that_count(const StoredResult& result) {
  if (result.kind != "sensitivity") return result.headline;
  std::vector<std::size_t> all(result.responses.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

}  // namespace

std::optional<Table> convergence_table(const StoredResult& result) {
  const bool indices = result.kind == "sensitivity";
  const auto& convergence = indices ? result.sensitivity.convergence : result.monte_carlo.convergence;
  if (!convergence) return std::nullopt;
  const ConvergenceResult& found = *convergence;
  const std::vector<std::size_t> responses = responses_that_count(result);
  const std::vector<std::size_t> missing = not_reached(found, responses);
  const std::size_t all = responses.size() * found.samples.size();
  Table table{
      .name = "convergence",
      .caption = fmt::format("Convergence: {} of {} {} have a {:.3g} % interval within +-{:.3g} % of their value, {}",
                             all - missing.size(), all, indices ? "global indices" : "overall means",
                             100.0 * found.course.conf_level, 100.0 * found.relative_error, samples_text(found)),
      .columns = {text_column("error", "error"), text_column("response", "response"),
                  percent_column("half_width", "half the interval"),
                  number_column("samples_needed", "samples that would do, about")},
      .rows = {},
      .notes = {}};
  add_rows(table, result, found, missing);
  if (missing.size() > kMostShown) table.notes.push_back(fmt::format("and {} more", missing.size() - kMostShown));
  if (!missing.empty()) {
    table.notes.push_back(fmt::format("Raise max, which is {}, and go on with --resume if the checkpoint was kept",
                                      count_text(found.max)));
  }
  return table;
}

}  // namespace poesy
