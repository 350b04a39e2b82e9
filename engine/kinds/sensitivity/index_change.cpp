#include "engine/kinds/sensitivity/index_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/display.h"
#include "engine/stats/indices.h"

namespace poesy {
namespace {

/// Names in one sentence, at most.
constexpr std::size_t kMostNames = 10;

std::span<const double> changes_of(const StoredResult& result, std::size_t response) {
  const SensitivityResult& found = sensitivity_of(result);
  return std::span(found.index_change).subspan(response * found.factors, found.factors);
}

/// Of a change that is known: "-99.1 %".
std::string change_text(double change) { return fmt::format("{:+.1f} %", 100.0 * change); }

/// The size to study, as a multiple of the size studied. At this size the tolerance counted from the index is the size
/// itself, if the index grows with a power of the size. ratio: tolerance over size studied; change: of the index at a
/// tenth of the size.
double corrected_ratio(double ratio, double change) {
  constexpr double kFallsTooFast = -0.9;
  const double power = -std::log10(1.0 + change);
  return std::isfinite(power) && power > kFallsTooFast ? std::pow(ratio, 1.0 / (1.0 + power)) : ratio;
}

/// A size that is about that of the first of the error's tolerances that is of another size than was studied; none
/// where all are of that size.
std::optional<double> size_to_study(const ResponseTolerances& tolerances, std::size_t factor, double studied,
                                    double change) {
  for (const std::span<const double> proposed : proposed_tolerances(tolerances)) {
    const double ratio = proposed[factor] / studied;
    if (std::isfinite(ratio) && (ratio > kSameSize || ratio < 1.0 / kSameSize)) {
      return studied * corrected_ratio(ratio, change);
    }
  }
  return std::nullopt;
}

}  // namespace

bool has_index_changes(const StoredResult& result) { return !sensitivity_of(result).index_change.empty(); }

Cell change_cell(double change) {
  if (std::isnan(change)) return text_cell("");
  // Rounding has either sign.
  const double percent = std::abs(change) < 5e-4 ? 0.0 : 100.0 * change;
  return {fmt::format("{:.1f}", percent), std::isfinite(change) ? std::optional(100.0 * change) : std::nullopt};
}

std::vector<std::size_t> changing_errors(const StoredResult& result, std::size_t response) {
  const std::span<const double> changes = changes_of(result, response);
  std::vector<std::size_t> list;
  for (std::size_t p = 0; p < changes.size(); ++p) {
    if (has_effect(result, response, p) && changes_with_size(changes[p])) list.push_back(p);
  }
  std::ranges::stable_sort(list, std::ranges::greater(), [&](std::size_t p) { return std::abs(changes[p]); });
  return list;
}

std::string index_change_text(const StoredResult& result, std::size_t response) {
  const std::span<const double> changes = changes_of(result, response);
  const std::vector<std::size_t> changing = changing_errors(result, response);
  std::size_t effects = 0;
  std::size_t unknown = 0;
  for (std::size_t p = 0; p < changes.size(); ++p) {
    if (!has_effect(result, response, p)) continue;
    ++effects;
    if (std::isnan(changes[p])) ++unknown;
  }
  std::string text =
      fmt::format("the index on {} holds at a tenth of the size, within {:.3g} %: {} of {}",
                  result.responses[response].name, 100.0 * kIndexHolds, effects - unknown - changing.size(),
                  counted(effects, "error with an effect", "errors with an effect"));
  if (unknown > 0) text += fmt::format("; not known for {}", unknown);
  std::vector<std::string> list;
  for (const std::size_t p : changing) {
    list.push_back(fmt::format("{} ({})", result.factors[p].name, change_text(changes[p])));
  }
  return list.empty() ? text : text + "; not for " + some_names(list, kMostNames);
}

std::string wrong_sizes_text(const StoredResult& result, const ResponseTolerances& tolerances) {
  if (!has_index_changes(result)) return {};
  const std::span<const double> changes = changes_of(result, tolerances.response);
  std::vector<std::string> list;
  for (const std::size_t p : changing_errors(result, tolerances.response)) {
    const auto size = size_to_study(tolerances, p, result.factor_sigma[p], changes[p]);
    if (!size) continue;
    const NamedUnit& factor = result.factors[p];
    list.push_back(fmt::format("{} ({}; study it at {:.3g} {})", factor.name, change_text(changes[p]),
                               *size / display(factor).si, unit_text(factor)));
  }
  if (list.empty()) return {};
  return fmt::format(
      "{} on {} that changes with size, by so much at a tenth of it, and a tolerance of another size than was studied: "
      "{}",
      counted(list.size(), "error has an index", "errors have an index"), result.responses[tolerances.response].name,
      some_names(list, kMostNames));
}

}  // namespace poesy
