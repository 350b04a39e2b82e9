#include "engine/kinds/sensitivity/answer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/kinds/sensitivity/fidelity.h"
#include "engine/kinds/sensitivity/figures.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/linearity.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/sensitivity/tolerances.h"
#include "engine/report/display.h"
#include "engine/report/limb_names.h"
#include "engine/report/tables.h"
#include "engine/schema/settings.h"
#include "engine/stats/tolerance.h"

namespace poesy::sensitivity {
namespace {

/// The errors that cause most of the mean square of the response by which errors are ranked, and those that together
/// cause hardly any of it.
struct FewMatter {
  /// Errors that together cause at least the share kMost of the mean square, largest first. If the last of these errors
  /// belongs to a Family, the list contains the whole family.
  std::vector<std::string> names;
  double sum = 0.0;  ///< share of the mean square that these errors cause
  /// Errors that together cause less than the share kHardly of the mean square. An error is left out if `names` has the
  /// same error of another limb.
  std::vector<std::string> hardly;
};

constexpr double kMost = 0.8;
constexpr double kHardly = 0.01;
/// The advice is to calibrate an error, instead of holding it to a tight tolerance, if calibration can remove more than
/// this share of its effect.
constexpr double kCalibrated = 0.9;

bool has_number(std::string_view name) { return stem_of(name) != name; }

/// Whether two errors are copies of one error in different limbs.
bool are_copies(std::string_view a, std::string_view b) {
  return a != b && has_number(a) && has_number(b) && stem_of(a) == stem_of(b);
}

/// The errors that a list with the error `last` should contain as well: its copies in other limbs, the errors whose
/// effects cannot be distinguished from those of `last` and its copies, and the copies of all these errors.
class Family {
 public:
  /// among: positions of the errors that may belong to the family.
  Family(const StoredResult& result, std::size_t response, std::size_t last, std::span<const std::size_t> among)
      : result_(&result), shown_(shown_indices(result)), response_(response), among_(among), members_{last} {
    add_copies();
    add_alike();
    add_copies();
  }

  bool has(std::size_t p) const { return std::ranges::find(members_, p) != members_.end(); }

 private:
  /// Adds the errors that are copies of a member of the family in another limb.
  void add_copies() {
    add_if([&](std::size_t p, std::size_t member) {
      return stem_of(result_->factors[p].name) == stem_of(result_->factors[member].name);
    });
  }

  /// Adds the errors whose effects cannot be distinguished from that of a member, because the intervals overlap.
  void add_alike() {
    add_if([&](std::size_t p, std::size_t member) { return low(p) <= high(member) && low(member) <= high(p); });
  }

  template <class Related>
  void add_if(const Related& related) {
    const std::vector<std::size_t> before = members_;
    for (const std::size_t p : among_) {
      if (!has(p) && std::ranges::any_of(before, [&](std::size_t member) { return related(p, member); })) {
        members_.push_back(p);
      }
    }
  }

  double low(std::size_t p) const { return shown_.low(response_, p) * result_->factor_sigma[p]; }
  double high(std::size_t p) const { return shown_.high(response_, p) * result_->factor_sigma[p]; }

  const StoredResult* result_;
  GlobalIndices shown_;
  std::size_t response_;
  std::span<const std::size_t> among_;
  std::vector<std::size_t> members_;
};

/// Finds the errors that cause most of the mean square, and those that cause hardly any of it (FewMatter). None if an
/// effect is not known, or if no error has an effect.
std::optional<FewMatter> few_matter(const StoredResult& result) {
  const std::size_t response = response_named(result, default_ranking(result));
  const MeanSquare found =
      mean_square(response_study(sensitivity_of(result), result.factor_sigma, result.factor_mean, response));
  const std::vector<double> shares = mean_square_shares(found, result.factor_sigma);
  const bool known = std::ranges::none_of(shares, [](double share) { return std::isnan(share); });
  if (shares.empty() || !known) return std::nullopt;
  std::vector<std::size_t> order = positions(shares.size());
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t p) { return shares[p]; });
  std::size_t most = 0;
  for (double sum = 0.0; sum < kMost && most < order.size(); ++most) sum += shares[order[most]];
  std::size_t loose = order.size();
  for (double sum = 0.0; loose > most && sum + shares[order[loose - 1]] < kHardly; --loose) {
    sum += shares[order[loose - 1]];
  }
  FewMatter few;
  const std::span<const std::size_t> between = std::span(order).subspan(most, loose - most);
  const Family family(result, response, order[most - 1], between);
  for (std::size_t n = 0; n < loose; ++n) {
    if (n >= most && !family.has(order[n])) continue;
    few.names.push_back(result.factors[order[n]].name);
    few.sum += shares[order[n]];
  }
  const auto is_copy = [&](const std::string& name) {
    return std::ranges::any_of(few.names, [&](const std::string& held) { return are_copies(held, name); });
  };
  for (std::size_t n = order.size(); n-- > loose;) {
    const std::string& name = result.factors[order[n]].name;
    if (!is_copy(name)) few.hardly.push_back(name);
  }
  return few;
}

/// A clause that names the errors whose effects cannot be distinguished from the largest effect: "; not told apart from
/// it: delta_2, delta_3". Empty if there are none.
std::string like_largest_clause(const StoredResult& result, const RankedErrors& ranked) {
  const GlobalIndices shown = shown_indices(result);
  const std::size_t r = ranked.response;
  const double low = shown.low(r, ranked.rows.front()) * result.factor_sigma[ranked.rows.front()];
  std::vector<std::string> names;
  for (const std::size_t p : std::span(ranked.rows).subspan(1)) {
    if (shown.high(r, p) * result.factor_sigma[p] >= low) names.push_back(result.factors[p].name);
  }
  return names.empty() ? "" : "; not told apart from it: " + some_names(names);
}

/// A sentence on the error with the largest effect on the response by which errors are ranked, with the interval of the
/// effect.
std::string largest_text(const StoredResult& result, const RankedErrors& ranked) {
  const std::size_t p = ranked.rows.front();
  const std::size_t r = ranked.response;
  const NamedUnit& response = result.responses[r];
  const GlobalIndices shown = shown_indices(result);
  const double sigma = result.factor_sigma[p];
  return fmt::format("{} scatters {} most, by {} at its sigma of {} ({} interval {} to {}){}.", result.factors[p].name,
                     response.name, response_text(response, shown.value(r, p) * sigma),
                     response_text(result.factors[p], sigma), percent_text(sensitivity_of(result).conf_level),
                     response_text(response, shown.low(r, p) * sigma),
                     response_text(response, shown.high(r, p) * sigma), like_largest_clause(result, ranked));
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

/// The errors with a large effect, in two lists by what to do about them.
struct Measures {
  std::vector<std::string> calibrate;  ///< errors whose effect calibration can remove almost completely
  std::vector<std::string> hold;       ///< errors that need tight tolerances
  double removable = 1.0;  ///< smallest share of an error's effect that calibration can remove, over the errors in
                           ///< `calibrate`
};

/// Returns true if the indices describe the deviations that remain after a calibration.
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

/// The names of errors, in which the copies of an error in several limbs are joined to one item: "zero_1/2/3".
std::vector<std::string> with_copies_together(const std::vector<std::string>& names) {
  std::vector<std::string> list;
  std::vector<std::string_view> stems;
  for (const std::string& name : names) {
    if (!has_number(name)) {
      list.push_back(name);
      continue;
    }
    const std::string_view stem = stem_of(name);
    if (std::ranges::find(stems, stem) != stems.end()) continue;
    stems.push_back(stem);
    std::vector<std::string_view> numbers;
    for (const std::string& other : names) {
      if (has_number(other) && stem_of(other) == stem)
        numbers.push_back(std::string_view(other).substr(stem.size() + 1));
    }
    std::ranges::sort(numbers, {}, [](std::string_view number) { return std::pair(number.size(), number); });
    list.push_back(fmt::format("{}_{}", stem, fmt::join(numbers, "/")));
  }
  return list;
}

/// The number of errors as text, "6 errors", if with_copies_together() joins some of their names; otherwise empty.
std::string count_of_copies(const std::vector<std::string>& names) {
  if (with_copies_together(names).size() == names.size()) return {};
  return counted(names.size(), "error", "errors");
}

/// The advice as text: "Calibrate zero_1/2/3 (3 errors, 100 % removable). Hold rod_left_1/2/3, rod_right_1/2/3 (6
/// errors) to tight tolerances. "
std::string measures_text(const Measures& found) {
  constexpr std::size_t kShown = 3;
  std::string text;
  if (!found.calibrate.empty()) {
    const std::string count = count_of_copies(found.calibrate);
    text = fmt::format("Calibrate {} ({}{}{} removable). ", some_names(with_copies_together(found.calibrate), kShown),
                       count.empty() ? "" : count + ", ",
                       found.calibrate.size() > 1 && found.removable < 1.0 ? "at least " : "",
                       percent_text(found.removable));
  }
  if (!found.hold.empty()) {
    const std::string count = count_of_copies(found.hold);
    text += fmt::format("Hold {}{} to tight tolerances. ", some_names(with_copies_together(found.hold), kShown),
                        count.empty() ? "" : " (" + count + ")");
  }
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
  // The condition is also true for an unknown effect, because any comparison with NaN is false.
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
  lines.emplace_back(kWhatToDo, advice(result, few));
  return lines;
}

}  // namespace poesy::sensitivity
