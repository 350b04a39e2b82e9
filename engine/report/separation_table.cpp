#include <fmt/format.h>

#include <cmath>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

std::string percent(double share) { return std::isnan(share) ? "-" : fmt::format("{:.1f} %", 100.0 * share); }

}  // namespace

std::string separation_table(const StoredResult& result, std::string_view ranked_by) {
  if (!result.sensitivity.separation) return "";
  const SeparationResult& found = *result.sensitivity.separation;
  std::string text = fmt::format(
      "\nWhat calibration can remove of each error's effect, to first order, over the poses\n"
      "effect: {}\n"
      "{:>4}  {:<16}  {:<16}  {:>11}  {:>24}\n",
      result.separation_measure, "rank", "error", "published class", "drive share", "removable by calibration");
  std::size_t rank = 0;
  for (const std::size_t p : ranking(result, response_named(result, ranked_by))) {
    const std::string& published = result.published_class[p];
    text +=
        fmt::format("{:>4}  {:<16}  {:<16}  {:>11}  {:>24}\n", ++rank, result.factors[p].name,
                    published.empty() ? "-" : published, percent(found.drive_share[p]), percent(found.removable[p]));
  }
  return text + fmt::format("all errors together, at the size the study sets: {} of the effect is removable\n",
                            percent(found.removable_together));
}

}  // namespace poesy
