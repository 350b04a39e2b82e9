#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/report/display.h"
#include "engine/report/html/comparison.h"
#include "engine/report/html/parts.h"
#include "engine/report/ranking.h"
#include "engine/run/sensitivity.h"
#include "engine/stats/tolerance.h"

namespace poesy {
namespace {

/// Two results of one kind, and which responses both have, in the order of response_order of A.
struct Pair {
  const StoredResult& a;
  const StoredResult& b;
  Common responses;
};

[[noreturn]] void refuse(const ReportedResult& b, const ReportedResult& a, std::string_view what) {
  throw InputError({.file = b.path}, fmt::format("has no {} in common with {}", what, a.path),
                   "compare two results that share some");
}

Pair pair_of(const ReportedResult& a, const ReportedResult& b) {
  Pair pair{a.stored, b.stored, common(names_of(a.stored.responses), names_of(b.stored.responses))};
  if (pair.responses.empty()) refuse(b, a, "response");
  const std::vector<std::size_t> order = response_order(a.stored);
  std::ranges::sort(pair.responses, {},
                    [&](const auto& both) { return std::ranges::find(order, both.first) - order.begin(); });
  return pair;
}

Comparison start(std::string option_word, std::string item_word, const std::vector<std::string>& items_a,
                 const std::vector<std::string>& items_b) {
  Comparison compared;
  compared.option_word = std::move(option_word);
  compared.item_word = std::move(item_word);
  for (const auto& both : common(items_a, items_b)) compared.items.push_back(items_a[both.first]);
  compared.only_a = only_in(items_a, items_b);
  compared.only_b = only_in(items_b, items_a);
  return compared;
}

/// Gathers value(a's response, a's item) for all responses and items that both have.
template <class Value>
std::vector<double> gather(const Common& responses, const Common& items, bool of_a, const Value& value) {
  std::vector<double> list;
  for (const auto& [ra, rb] : responses) {
    for (const auto& [pa, pb] : items) list.push_back(of_a ? value(ra, pa) : value(rb, pb));
  }
  return list;
}

/// The positions in A.
std::vector<std::size_t> of_a(const Common& both) {
  std::vector<std::size_t> list;
  for (const auto& one : both) list.push_back(one.first);
  return list;
}

std::vector<std::vector<std::string>> response_units(const Pair& pair) {
  return response_units(pair.a, of_a(pair.responses));
}

/// By the estimator that both results have.
ComparedValues indices(const StoredResult& result, const Pair& pair, const Common& factors, bool as_effect) {
  const bool corrected = has_corrected_indices(pair.a) && has_corrected_indices(pair.b);
  const GlobalIndices indices = corrected ? shown_indices(result) : published_indices(result);
  const auto shown = [&](const std::vector<double>& of) {
    return gather(pair.responses, factors, &result == &pair.a, [&](std::size_t r, std::size_t p) {
      const double index = without_rounding(result, of[r * result.factors.size() + p], r, p);
      const double scale = as_effect ? result.factor_sigma[p] : display(result.factors[p]).si;
      return index * scale / display(result.responses[r]).si;
    });
  };
  return {shown(indices.value), shown(indices.low), shown(indices.high)};
}

/// Predicted from the errors one by one (stats/tolerance.h), in the unit shown.
double total_rms(const StoredResult& result, std::size_t response) {
  const MeanSquare squares = mean_square(response_study(result.sensitivity, result.factor_sigma, response));
  return std::sqrt(squares.at(result.factor_sigma)) / display(result.responses[response]).si;
}

Comparison sensitivity(const Pair& pair) {
  const std::vector<std::string> names_a = names_of(pair.a.factors);
  const std::vector<std::string> names_b = names_of(pair.b.factors);
  const Common factors = common(names_a, names_b);
  Comparison compared = start("response", "error", names_a, names_b);
  for (const auto& both : pair.responses) compared.options.push_back(pair.a.responses[both.first].name);
  compared.quantities = {{"effect at the size each study sets (index x sigma)", "effect", response_units(pair),
                          indices(pair.a, pair, factors, true), indices(pair.b, pair, factors, true)},
                         {"global index", "index", index_units(pair.a, of_a(pair.responses), of_a(factors)),
                          indices(pair.a, pair, factors, false), indices(pair.b, pair, factors, false)}};
  if (pair.a.sensitivity.background.empty() || pair.b.sensitivity.background.empty()) return compared;
  compared.total_label = "All errors together, predicted from each alone: root mean square over samples and poses";
  for (const auto& [ra, rb] : pair.responses) {
    compared.total_a.push_back(total_rms(pair.a, ra));
    compared.total_b.push_back(total_rms(pair.b, rb));
  }
  return compared;
}

/// The numbers of a Monte Carlo result over the samples of all poses, by name; in the order of the levels.
std::vector<std::pair<std::string, std::vector<double>>> overall(const StoredResult& result) {
  const MonteCarloResult& found = result.monte_carlo;
  std::vector<std::pair<std::string, std::vector<double>>> list{
      {"mean", found.overall_mean}, {"standard deviation", found.overall_std}, {"smallest", found.overall_min}};
  for (std::size_t q = 0; q < found.levels.size(); ++q) {
    std::vector<double> values;
    for (std::size_t r = 0; r < found.responses; ++r) {
      values.push_back(found.overall_quantiles[r * found.levels.size() + q]);
    }
    list.emplace_back(shortest(100.0 * found.levels[q]) + " % quantile", std::move(values));
  }
  list.emplace_back("largest", found.overall_max);
  return list;
}

Comparison monte_carlo(const Pair& pair) {
  const auto a = overall(pair.a);
  const auto b = overall(pair.b);
  const auto names = [](const auto& numbers) {
    std::vector<std::string> list;
    for (const auto& number : numbers) list.push_back(number.first);
    return list;
  };
  const Common numbers = common(names(a), names(b));
  Comparison compared = start("response", "number", names(a), names(b));
  compared.ranked = false;
  for (const auto& both : pair.responses) compared.options.push_back(pair.a.responses[both.first].name);
  const auto values = [&](const auto& of, const StoredResult& result) {
    return ComparedValues{gather(pair.responses, numbers, &result == &pair.a, [&](std::size_t r, std::size_t n) {
      return of[n].second[r] / display(result.responses[r]).si;
    })};
  };
  compared.quantities = {
      {"over the samples of all poses", "overall", response_units(pair), values(a, pair.a), values(b, pair.b)}};
  return compared;
}

Comparison identification(const Pair& pair, const ReportedResult& second, const ReportedResult& first) {
  const std::vector<std::string> names_a = names_of(pair.a.factors);
  const std::vector<std::string> names_b = names_of(pair.b.factors);
  const auto group_names = [](const StoredResult& result) {
    std::vector<std::string> list;
    for (const ErrorSize& group : result.groups) list.push_back(group.name);
    return list;
  };
  const Common groups = common(group_names(pair.a), group_names(pair.b));
  if (groups.empty()) refuse(second, first, "size of the errors");
  const Common factors = common(names_a, names_b);
  Comparison compared = start("size of the errors", "error", names_a, names_b);
  compared.ranked = false;  // most errors share a number of poses
  for (const auto& both : groups) compared.options.push_back(pair.a.groups[both.first].name);
  const auto values = [&](const StoredResult& result) {
    const IdentificationResult& found = result.identification;
    return ComparedValues{gather(groups, factors, &result == &pair.a, [&](std::size_t g, std::size_t p) {
      return 100.0 -
             100.0 * static_cast<double>(found.single_below[g * found.factors + p]) / static_cast<double>(found.poses);
    })};
  };
  compared.quantities = {{"poses where the error deforms alone", "deforms",
                          std::vector<std::vector<std::string>>(groups.size(), {"%"}), values(pair.a), values(pair.b)}};
  return compared;
}

Comparison cases(const Pair& pair) {
  const Common both_cases = common(pair.a.cases, pair.b.cases);
  Comparison compared = start("response", "case", pair.a.cases, pair.b.cases);
  compared.ranked = false;
  for (const auto& both : pair.responses) compared.options.push_back(pair.a.responses[both.first].name);
  const auto values = [&](const StoredResult& result, bool mean) {
    const std::vector<double>& of = mean ? result.case_result.mean : result.case_result.max;
    return ComparedValues{gather(pair.responses, both_cases, &result == &pair.a, [&](std::size_t r, std::size_t c) {
      return of[r * result.cases.size() + c] / display(result.responses[r]).si;
    })};
  };
  compared.quantities = {
      {"mean over the poses", "case_mean", response_units(pair), values(pair.a, true), values(pair.b, true)},
      {"largest over the poses", "case_max", response_units(pair), values(pair.a, false), values(pair.b, false)}};
  return compared;
}

/// Items are subsets at a size.
std::vector<std::string> sized_subsets(const StoredCoupling& coupling) {
  std::vector<std::string> list;
  for (const std::string& size : coupling.size_names) {
    for (const std::string& subset : coupling.subsets) list.push_back(fmt::format("{} at {}", subset, size));
  }
  return list;
}

Comparison coupling(const Pair& pair) {
  const std::vector<std::string> names_a = sized_subsets(pair.a.coupling);
  const std::vector<std::string> names_b = sized_subsets(pair.b.coupling);
  const Common subsets = common(names_a, names_b);
  Comparison compared = start("response", "subset", names_a, names_b);
  compared.ranked = false;
  for (const auto& both : pair.responses) compared.options.push_back(pair.a.responses[both.first].name);
  const auto values = [&](const StoredResult& result) {
    return ComparedValues{gather(pair.responses, subsets, &result == &pair.a, [&](std::size_t r, std::size_t n) {
      const CouplingResult& found = result.coupling.found;
      return found.effect_max[r * found.sizes * found.subsets + n] / display(result.responses[r]).si;
    })};
  };
  compared.quantities = {
      {"largest effect over the poses", "effect_max", response_units(pair), values(pair.a), values(pair.b)}};
  return compared;
}

Comparison rows(const Pair& pair) {
  constexpr double kLevels[] = {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0};
  const std::vector<std::string> names{"smallest",      "5 % quantile",  "25 % quantile", "median",
                                       "75 % quantile", "95 % quantile", "largest"};
  Comparison compared = start("response", "number", names, names);
  compared.ranked = false;
  for (const auto& both : pair.responses) compared.options.push_back(pair.a.responses[both.first].name);
  const auto values = [&](const StoredResult& result) {
    ComparedValues list;
    for (const auto& both : pair.responses) {
      const std::size_t r = &result == &pair.a ? both.first : both.second;
      const EvaluationResult& found = result.evaluation;
      for (const double value : order_statistics(found, r, 0, found.poses * found.samples, kLevels)) {
        list.value.push_back(value / display(result.responses[r]).si);
      }
    }
    return list;
  };
  compared.quantities = {{"over all poses and rows", "rows", response_units(pair), values(pair.a), values(pair.b)}};
  return compared;
}

}  // namespace

Comparison comparison(const ReportedResult& a, const ReportedResult& b) {
  const Pair pair = pair_of(a, b);
  Comparison compared;
  if (pair.a.kind == "sensitivity") compared = sensitivity(pair);
  if (pair.a.kind == "monte-carlo") compared = monte_carlo(pair);
  if (pair.a.kind == "identification") compared = identification(pair, b, a);
  if (pair.a.kind == "coupling") compared = coupling(pair);
  if (pair.a.kind == "evaluate") {
    if (pair.a.cases.empty() != pair.b.cases.empty()) refuse(b, a, "case");
    compared = pair.a.cases.empty() ? rows(pair) : cases(pair);
  }
  if (compared.items.empty()) refuse(b, a, compared.item_word);
  return compared;
}

}  // namespace poesy
