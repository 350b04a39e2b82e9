#include "engine/kinds/sensitivity/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "engine/kinds/sensitivity/fidelity.h"
#include "engine/kinds/sensitivity/figures.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/linearity.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/sensitivity/tolerances.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"
#include "engine/schema/settings.h"
#include "engine/stats/tolerance.h"

namespace poesy {
namespace {

/// The errors that cause most of the mean square of the response by which errors are ranked, and those that together
/// cause hardly any of it.
struct FewMatter {
  std::vector<std::string> names;   ///< errors that together cause the share kMost of the mean square, largest first
  double sum = 0.0;                 ///< share of the mean square that these errors cause
  std::vector<std::string> hardly;  ///< errors that together cause less than the share kHardly of the mean square
};

constexpr double kMost = 0.8;
constexpr double kHardly = 0.01;
/// The advice is to calibrate an error, instead of holding it to a tight tolerance, if calibration can remove more than
/// this share of its effect.
constexpr double kCalibrated = 0.9;

/// Finds the errors that FewMatter lists; none if an effect is not known, or if no error has an effect.
std::optional<FewMatter> few_matter(const StoredResult& result) {
  const std::size_t response = response_named(result, default_ranking(result));
  const MeanSquare found =
      mean_square(response_study(sensitivity_of(result), result.factor_sigma, result.factor_mean, response));
  const std::vector<double> shares = mean_square_shares(found, result.factor_sigma);
  if (std::ranges::any_of(shares, [](double share) { return std::isnan(share); })) return std::nullopt;
  std::vector<std::size_t> order = positions(shares.size());
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t p) { return shares[p]; });
  FewMatter few;
  while (few.sum < kMost && few.names.size() < order.size()) {
    const std::size_t p = order[few.names.size()];
    few.names.push_back(result.factors[p].name);
    few.sum += shares[p];
  }
  double tail = 0.0;
  for (std::size_t n = order.size(); n-- > 0;) {
    tail += shares[order[n]];
    if (tail >= kHardly) break;
    few.hardly.push_back(result.factors[order[n]].name);
  }
  return few;
}

/// A sentence on the error with the largest effect on the response by which errors are ranked, with the interval of the
/// effect.
std::string largest_text(const StoredResult& result, const RankedErrors& ranked) {
  const std::size_t p = ranked.rows.front();
  const std::size_t r = ranked.response;
  const NamedUnit& response = result.responses[r];
  const GlobalIndices shown = shown_indices(result);
  const double sigma = result.factor_sigma[p];
  return fmt::format("{} scatters {} most, by {} at its sigma of {} ({} interval {} to {}).", result.factors[p].name,
                     response.name, response_text(response, shown.value(r, p) * sigma),
                     response_text(result.factors[p], sigma), percent_text(sensitivity_of(result).conf_level),
                     response_text(response, shown.low(r, p) * sigma),
                     response_text(response, shown.high(r, p) * sigma));
}

/// A sentence on the width of the intervals of errors with an effect, and on whether indices hold at other sizes of the
/// errors.
std::string sure_text(const StoredResult& result, const RankedErrors& ranked) {
  const GlobalIndices shown = shown_indices(result);
  double widest = 0.0;
  for (const std::size_t p : ranked.rows) {
    if (has_effect(result, ranked.response, p)) widest = std::max(widest, relative_reach(shown, ranked.response, p));
  }
  std::string text = fmt::format("Intervals reach at most {:.2g} % away from their index.", 100.0 * widest);
  const std::size_t changing = changing_errors(result, ranked.response).size();
  if (changing > 0) {
    return text + fmt::format(" {} at other sizes.", counted(changing, "index is another", "indices are others"));
  }
  return text + (is_first_order(result) ? fmt::format(" The samples were {}.", kSizesNotTested)
                                        : " The indices hold at a tenth of the sizes as well.");
}

/// The errors with a large effect, by what can be done about it.
struct Measures {
  std::vector<std::string> calibrate;  ///< errors of which calibration can remove almost all
  std::vector<std::string> hold;       ///< errors that need tight tolerances
  double removable = 1.0;              ///< the smallest removable share among the errors to calibrate
};

/// Returns true if the indices are those of the responses that remain after a calibration.
bool is_calibrated(const StoredResult& result) {
  return study_setting(result.study_text, "analysis", "calibrated") == "true" ||
         !study_setting(result.study_text, "analysis.calibration", "fit").empty();
}

Measures measures(const StoredResult& result, const std::vector<std::string>& names) {
  const std::optional<SeparationResult> separation =
      is_calibrated(result) ? std::nullopt : sensitivity_of(result).separation;
  Measures found;
  for (const std::string& name : names) {
    const auto p =
        static_cast<std::size_t>(std::ranges::find(result.factors, name, &NamedUnit::name) - result.factors.begin());
    const double share = separation ? separation->removable(p) : 0.0;
    (share > kCalibrated ? found.calibrate : found.hold).push_back(name);
    if (share > kCalibrated) found.removable = std::min(found.removable, share);
  }
  return found;
}

/// "Calibrate zero_2, zero_1, zero_3 (100 % removable). Hold tilt_x to tight tolerances. "
std::string measures_text(const Measures& found) {
  std::string text;
  if (!found.calibrate.empty()) {
    text = fmt::format("Calibrate {} ({}{} removable). ", some_names(found.calibrate, 3),
                       found.calibrate.size() > 1 && found.removable < 1.0 ? "at least " : "",
                       percent_text(found.removable));
  }
  if (!found.hold.empty()) text += fmt::format("Hold {} to tight tolerances. ", some_names(found.hold, 3));
  return text;
}

std::string advice(const StoredResult& result, const std::optional<FewMatter>& few) {
  std::string text = few ? measures_text(measures(result, few->names)) : std::string();
  if (few && !few->hardly.empty()) {
    text += fmt::format("{} may be loose: together below 1 % ({}). ", counted(few->hardly.size(), "error", "errors"),
                        some_names(few->hardly, 3));
  }
  return text + "'poesy tolerances' gives sizes that keep a limit; a study of kind allocation, those of least cost.";
}

}  // namespace

std::string few_matter_text(const StoredResult& result) {
  const std::optional<FewMatter> few = few_matter(result);
  if (!few) return {};
  const std::size_t hardly = few->hardly.size();
  std::string text = fmt::format(
      "{} of {} {} {:.0f} % of what the study's sizes add to the mean square of {} over samples and poses: {}.",
      few->names.size(), counted(result.factors.size(), "error", "errors"), few->names.size() == 1 ? "makes" : "make",
      100.0 * few->sum, default_ranking(result), some_names(few->names));
  if (hardly > 0)
    text += fmt::format(" {} hardly {} (below 1 % together).", hardly, hardly == 1 ? "matters" : "matter");
  return text;
}

std::string worst_place_text(const StoredResult& result) {
  constexpr double kHardlyDiffers = 1.05;
  const RankedErrors ranked = ranked_errors(result, default_ranking(result));
  if (ranked.rows.empty()) return {};
  const std::size_t error = ranked.rows.front();
  const ErrorCells all = local_effects(result, ranked.response);
  const std::span<const double> effects = all.row(error);
  std::size_t worst = 0;
  double sum = 0.0;
  for (std::size_t m = 0; m < effects.size(); ++m) {
    sum += effects[m];
    if (effects[m] > effects[worst]) worst = m;
  }
  const double ratio = effects.empty() ? 0.0 : effects[worst] * static_cast<double>(effects.size()) / sum;
  // This also covers an unknown effect, because a comparison with NaN is false.
  if (!(ratio >= kHardlyDiffers)) return {};
  return fmt::format("The effect of {} on {} is largest at {}, {:.1f} times its mean over the poses.",
                     result.factors[error].name, result.responses[ranked.response].name, place_text(result, worst),
                     ratio);
}

Answer sensitivity_answer(const StoredResult& result) {
  const RankedErrors ranked = ranked_errors(result, default_ranking(result));
  if (ranked.rows.empty() || !has_effect(result, ranked.response, ranked.rows.front())) {
    return {{"Answer", fmt::format("No error has an effect on {}.", default_ranking(result))}};
  }
  const std::optional<FewMatter> few = few_matter(result);
  Answer lines{{"Answer", largest_text(result, ranked)}};
  if (few) {
    lines.emplace_back(
        "How many matter",
        fmt::format("{} of {} make {:.0f} % of the mean square: {}.", few->names.size(),
                    counted(result.factors.size(), "error", "errors"), 100.0 * few->sum, some_names(few->names)));
  }
  if (std::string where = worst_place_text(result); !where.empty()) lines.emplace_back("Where", std::move(where));
  lines.emplace_back("How sure", sure_text(result, ranked));
  lines.emplace_back("What to do", advice(result, few));
  return lines;
}

}  // namespace poesy
