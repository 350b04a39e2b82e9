#include "engine/kinds/monte_carlo/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/kinds/monte_carlo/drivers.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/report/display.h"
#include "engine/report/drawing_table.h"
#include "engine/report/limb_names.h"
#include "engine/report/tables.h"

namespace poesy::monte_carlo {
namespace {

/// Advice such as "Make smaller first the errors that alone have the largest shares of the variance of gap: delta_1
/// (12 %), ...". Empty if the first-order indices of the errors are unknown, or if their sum is small, as for norms.
std::string drivers_text(const StoredResult& result, std::size_t r) {
  constexpr std::size_t kMost = 3;
  constexpr double kLittle = 0.1;
  const Result& found = monte_carlo_of(result);
  const MainEffects& effects = found.effects.effects;
  const auto share = [&](std::size_t p) { return effects.s1(r, p); };
  std::vector<std::size_t> order;  // errors with an effect that differs significantly from zero
  std::vector<std::string> unranked;
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    if (effects.s1_ci_low(r, p) > 0.0) order.push_back(p);
    if (std::isnan(share(p))) unranked.push_back(result.factors[p].name);
  }
  std::ranges::stable_sort(order, std::ranges::greater(), share);
  order.resize(std::min(kMost, order.size()));
  std::string text;
  double sum = 0.0;
  for (const std::size_t p : order) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", result.factors[p].name, percent_text(share(p)));
    sum += share(p);
  }
  if (!(sum >= kLittle)) return {};
  text = fmt::format("Make smaller first the errors that alone have the largest shares of the variance of {}: {}.",
                     result.responses[r].name, text);
  if (!unranked.empty()) text += fmt::format(" Not ranked, because they are correlated: {}.", some_names(unranked));
  return text;
}

/// The correlated errors as one source of scatter: "the correlated errors leg_1, leg_2 and 4 more together".
std::string correlated_text(const StoredResult& result, const ResponseShares& shares) {
  constexpr std::size_t kNamed = 2;
  return "the correlated errors " + some_names(names_of(result.factors, shares.correlated), kNamed) + " together";
}

/// A source of scatter, such as a feature, and its share.
struct Source {
  std::string name;
  double share = 0.0;
  std::string_view remark = {};  ///< text that follows the share
};

/// The source to which all correlated errors belong; none if they belong to several. sources: [errors] source of each
/// error.
std::optional<std::string> only_correlated_source(const std::vector<std::string>& sources,
                                                  const ResponseShares& shares) {
  if (shares.correlated.empty()) return std::nullopt;
  const std::string& first = sources[shares.correlated.front()];
  const bool is_only = std::ranges::all_of(shares.correlated, [&](std::size_t p) { return sources[p] == first; });
  return is_only ? std::optional(first) : std::nullopt;
}

/// The share of each feature, which is the sum over its errors, and of each error that belongs to no feature. If some
/// errors are correlated, sources that differ only in the limb are joined, because the correlated errors of all limbs
/// have only a joint share. This share is added to the share of a feature if all correlated errors belong to this
/// feature and it has other errors too. Otherwise the correlated errors are a source of their own.
std::vector<Source> sources_of_scatter(const StoredResult& result, const ResponseShares& shares) {
  std::vector<std::string> names = feature_of_each_error(result);
  if (!shares.correlated.empty()) join_limbs(names);
  std::map<std::string, double> sums;
  for (std::size_t p = 0; p < names.size(); ++p) {
    if (!std::isnan(shares.each[p])) sums[names[p]] += shares.each[p];
  }
  const std::optional<std::string> only = only_correlated_source(names, shares);
  const bool belong_to_one = only && sums.contains(*only);
  std::vector<Source> sources;
  if (!belong_to_one && !shares.correlated.empty()) {
    sources.push_back({correlated_text(result, shares), shares.together});
    for (const std::size_t p : shares.correlated) {
      if (auto rest = sums.extract(names[p])) sources.push_back({"the rest of " + names[p], rest.mapped()});
    }
  }
  for (const auto& [name, share] : sums) {
    const bool has_correlated = belong_to_one && name == *only;
    sources.push_back(
        {name, share + (has_correlated ? shares.together : 0.0), has_correlated ? ", correlated errors included" : ""});
  }
  return sources;
}

/// Advice to remove the mean of the response over the machines. Empty unless the mean accounts for more than a tenth of
/// the mean square, or for more than any source of scatter. A tenth is enough, because a mean can be removed as a
/// whole, but an error can only be made smaller.
std::string offset_text(const StoredResult& result, std::size_t r, double largest_share) {
  constexpr double kNotable = 0.1;
  const YieldResult& yield = *monte_carlo_of(result).machines->yield;
  if (!yield.has_offset()) return {};
  const double largest_source = (1.0 - yield.offset_share(r)) * largest_share;  // of the mean square
  if (!(yield.offset_share(r) > std::min(kNotable, largest_source))) return {};
  return fmt::format(
      "Remove first the mean of {} over the machines, {} as a root mean square: it makes {} of the mean square, and "
      "tighter tolerances leave it as it is (background and means of errors make it). ",
      result.responses[r].name, response_text(result.responses[r], yield.offset(r)),
      percent_text(yield.offset_share(r)));
}

/// Advice such as "Make smaller first what adds most to the scatter of tip_z: flange (36 %), ...". It names features,
/// errors that belong to no feature, and correlated errors together. Empty if their shares are not known.
std::string limit_drivers_text(const StoredResult& result) {
  constexpr std::size_t kMost = 3;
  const auto shares = response_shares(result);
  if (!shares) return {};
  std::vector<Source> order = sources_of_scatter(result, *shares);
  std::erase_if(order, [](const Source& source) { return !(source.share > 0.0); });
  std::ranges::stable_sort(order, std::ranges::greater(), &Source::share);
  order.resize(std::min(kMost, order.size()));
  std::string text;
  for (const Source& source : order) {
    text +=
        fmt::format("{}{} ({}{})", text.empty() ? "" : ", ", source.name, percent_text(source.share), source.remark);
  }
  if (text.empty()) return {};
  const std::string offset = offset_text(result, shares->response, order.front().share);
  return fmt::format("{}Make smaller {} what adds most to the scatter of {}: {}.", offset,
                     offset.empty() ? "first" : "then", result.responses[shares->response].name, text);
}

}  // namespace

std::string advice(const StoredResult& result, std::size_t r, const std::string& predicted) {
  using Decision = YieldVerdict::Decision;
  const std::optional<LimitVerdicts>& verdicts = result.verdicts;
  const bool has_yield = verdicts && verdicts->yield;
  const bool undecided = has_yield && verdicts->yield->decision == Decision::undecided;
  const bool judged = verdicts && !undecided && !(has_yield && verdicts->yield->decision == Decision::not_asked);
  if (judged && verdicts->passed() && has_yield) {
    std::string open = open_parts_text(*verdicts->yield);
    if (open.empty()) return "Nothing has to be done: as far as it shows, the limits are kept.";
    open.front() = 'T';
    return open + ".";
  }
  if (judged && verdicts->passed()) {
    const bool has_machines = monte_carlo_of(result).machines.has_value();
    return fmt::format(
        "As far as it shows, the limits are kept{}. If machines have to be within them, ask for a yield ({}).",
        judged_text(*verdicts), has_machines ? "judge = \"yield\"" : "draws = \"per machine\"");
  }
  std::string drivers = predicted.empty() ? limit_drivers_text(result) : predicted;
  if (drivers.empty()) drivers = drivers_text(result, r);
  const std::string which = drivers.empty() ? "A sensitivity study says which errors to make smaller." : drivers;
  const std::string_view first =
      !verdicts   ? "State limits under [analysis.limits], and the report judges them. "
      : judged    ? ""
      : undecided ? "More machines (samples) decide whether the yield is high enough. "
                  : "State the yield that you need (yield, under [analysis]), and the report judges it. ";
  return std::string(first) + which;
}

}  // namespace poesy::monte_carlo
