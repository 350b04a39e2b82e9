#include "engine/kinds/sensitivity/tolerance_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "engine/kinds/sensitivity/index_change.h"
#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/display.h"

namespace poesy {
namespace {

Cell tolerance_cell(double tolerance, const Unit& unit) {
  return std::isinf(tolerance) ? text_cell("no effect") : number_cell(tolerance / unit.si);
}

void add_reference_notes(std::vector<std::string>& notes, const StoredResult& result,
                         const ResponseTolerances& tolerances) {
  const NamedUnit& response = result.responses[tolerances.response];
  const std::optional<ReferenceError>& reference = tolerances.all.reference;
  if (!reference) {
    notes.push_back(fmt::format("no error has an effect on {}", response.name));
    return;
  }
  const NamedUnit& factor = result.factors[reference->factor];
  const double rms = std::sqrt(tolerances.all.mean_square.at(tolerances.all.equal_effect));
  notes.push_back(fmt::format("equal effect: as much as {} = {}; with these, predicted root mean square of {}: {}",
                              factor.name, readable_text({reference->tolerance, dimension_of(factor.unit)}),
                              response.name, std::isnan(rms) ? "unknown" : response_text(response, rms)));
}

void add_limit_notes(std::vector<std::string>& notes, const StoredResult& result,
                     const ResponseTolerances& tolerances) {
  if (!tolerances.limit) return;
  const NamedUnit& response = result.responses[tolerances.response];
  notes.push_back(
      fmt::format("limit: predicted root mean square of {} over samples and poses = {}; the background alone gives {}",
                  response.name, response_text(response, tolerances.limit->limit),
                  response_text(response, std::sqrt(tolerances.all.mean_square.background))));
  notes.emplace_back(
      "equal tolerance: one number for all lengths and one for all angles, in the proportion of the median "
      "sigma that the study sets to lengths and to angles");
  notes.emplace_back(
      "an error without effect on its own has its equal tolerance, because it may act together with others");
}

/// How much the limit may be exceeded although the study was made at small errors.
void add_bound_note(std::vector<std::string>& notes, const StoredResult& result, const ResponseTolerances& tolerances) {
  if (!tolerances.limit || sensitivity_of(result).mean_square_bound.empty()) return;
  const double bound = std::sqrt(sensitivity_of(result).mean_square_bound[tolerances.response]);
  if (bound == 1.0) return;
  const NamedUnit& response = result.responses[tolerances.response];
  notes.push_back(
      fmt::format("the root mean square may come out up to {:.3g} times as large, {}, even where every effect is "
                  "linear: {} is made of several norms, and their mean squares do not add exactly. To be safe, give "
                  "--limit \"{}\"",
                  bound, response_text(response, tolerances.limit->limit * bound), response.name,
                  response_text(response, tolerances.limit->limit / bound)));
}

/// That a tolerance speaks of a normal error, where the study's errors are something else.
void add_distribution_note(std::vector<std::string>& notes, const StoredResult& result) {
  std::vector<std::string> shapes;
  std::size_t count = 0;
  for (const std::string& shape : result.factor_distribution) {
    if (shape == "normal") continue;
    ++count;
    if (std::ranges::find(shapes, shape) == shapes.end()) shapes.push_back(shape);
  }
  if (count == 0) return;
  notes.push_back(
      fmt::format("{} of {} not normal in the study ({}): the tolerance is still the standard deviation of a normal "
                  "error, the same as of an error of another distribution where effects are linear",
                  count, counted(result.factors.size(), "error is", count == 1 ? "errors is" : "errors are"),
                  fmt::join(shapes, ", ")));
}

/// Errors with a tolerance larger than the size at which they were studied: of a limit, by either way to share it.
std::size_t extrapolated(const StoredResult& result, const ResponseTolerances& tolerances) {
  const std::vector<std::span<const double>> lists = proposed_tolerances(tolerances);
  std::size_t count = 0;
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    const double studied = result.factor_sigma[p] * (1.0 + 1e-9);
    const auto larger = [&](std::span<const double> list) { return std::isfinite(list[p]) && list[p] > studied; };
    count += std::ranges::any_of(lists, larger) ? 1U : 0U;
  }
  return count;
}

void add_extrapolation_note(std::vector<std::string>& notes, const StoredResult& result,
                            const ResponseTolerances& tolerances) {
  const std::size_t count = extrapolated(result, tolerances);
  if (count == 0) return;
  notes.push_back(
      fmt::format("{} of {} a tolerance larger than the sigma of the study: it extrapolates beyond the size "
                  "studied. Confirm it by a Monte Carlo study: errors that act with the square of their "
                  "size make it too loose",
                  count, counted(result.factors.size(), "error has", count == 1 ? "errors has" : "errors have")));
}

std::vector<std::string> notes(const StoredResult& result, const ResponseTolerances& tolerances) {
  std::vector<std::string> list;
  add_reference_notes(list, result, tolerances);
  add_limit_notes(list, result, tolerances);
  add_bound_note(list, result, tolerances);
  add_distribution_note(list, result);
  add_extrapolation_note(list, result, tolerances);
  if (!has_index_changes(result)) {
    list.push_back(
        fmt::format("whether indices hold at other sizes is not known, because an older poesy ({}) wrote "
                    "this result",
                    result.poesy_version));
  }
  if (!tolerances.caveat.empty()) list.push_back(tolerances.caveat);
  list.push_back(fmt::format(
      "index: scatter of the response per scatter of the error; low, high: its {:.3g} % interval; "
      "tolerances are counted from it as published; share: of what the errors add to the mean square of the "
      "response over samples and poses, the quantity that a limit limits, at the size the study sets",
      100.0 * sensitivity_of(result).conf_level));
  return list;
}

/// Refers to both.
std::vector<FilledColumn> columns(const StoredResult& result, const ResponseTolerances& tolerances) {
  const std::size_t r = tolerances.response;
  const SensitivityResult& found = sensitivity_of(result);
  const auto tolerance = [&result](std::string name, std::string heading, const std::vector<double>& values) {
    return FilledColumn{number_column(std::move(name), std::move(heading)), [&result, &values](std::size_t p) {
                          return tolerance_cell(values[p], display(result.factors[p]));
                        }};
  };
  std::vector<FilledColumn> list{
      name_column(result.factors, "error"),
      {text_column("kind", "kind", 4),
       [&](std::size_t p) { return text_cell(error_kind(dimension_of(result.factors[p].unit))); }},
      {number_column("limb", "limb", "", 3),
       [&](std::size_t p) { return count_cell(sensitivity_of(result).factor_limb[p]); }},
      tolerance("equal_effect", "equal effect", tolerances.all.equal_effect)};
  if (tolerances.limit) {
    list.push_back(tolerance("limit_equal_effect", "limit, equal effect", tolerances.limit->equal_effect));
    list.push_back(tolerance("limit_equal_tolerance", "limit, equal tolerance", tolerances.limit->equal_tolerance));
  }
  list.push_back(unit_column(result.factors));
  list.push_back(index_column(result, found.global, r, "index", "index"));
  list.push_back(index_column(result, found.global_ci_low, r, "index_low", "low", 2));
  list.push_back(index_column(result, found.global_ci_high, r, "index_high", "high", 2));
  list.push_back({percent_column("mean_square_share", "share", 1),
                  [&](std::size_t p) { return percent_cell(tolerances.all.mean_square_share[p]); }});
  return list;
}

}  // namespace

Table tolerance_table(const StoredResult& result, const ResponseTolerances& tolerances) {
  Table table{.name = "tolerances",
              .caption = fmt::format("Tolerances for {}: standard deviations of normal errors",
                                     result.responses[tolerances.response].name),
              .columns = {},
              .notes = notes(result, tolerances)};
  fill(table, positions(result.factors.size()), columns(result, tolerances));
  return table;
}

}  // namespace poesy
