#include "engine/kinds/monte_carlo/machine_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/kinds/monte_carlo/drivers.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/monte_carlo/yield.h"
#include "engine/report/display.h"
#include "engine/report/drawing_table.h"
#include "engine/report/drawn_errors.h"
#include "engine/stats/first_order.h"
#include "engine/stats/main_effects.h"

namespace poesy::monte_carlo {
namespace {

const MachineResult& machines_of(const StoredResult& result) { return *monte_carlo_of(result).machines; }

const EffectResult& effects_of(const StoredResult& result) { return monte_carlo_of(result).effects; }

/// The name of a quantile in JSON: "q_0_95".
std::string quantile_name(double level) {
  std::string name = "q_" + shortest(level);
  std::ranges::replace_if(
      name, [](char c) { return c == '.' || c == '-' || c == '+'; }, '_');
  return name;
}

Table values_table(const StoredResult& result) {
  const Result& found = monte_carlo_of(result);
  const auto number = [&result](std::string name, std::string heading, const auto& values, int dispensable = 0) {
    return FilledColumn{number_column(std::move(name), std::move(heading), "", dispensable),
                        [&result, &values](std::size_t r) {
                          // The last value of a row is its only number, or the quantile of the highest level.
                          return value_cell(values.row(r).back(), result.responses[r]);
                        }};
  };
  const MachineValues& largest = machines_of(result).largest;
  const MachineValues& rms = machines_of(result).rms;
  const std::string level = "q_" + shortest(found.levels.back());
  const std::string name = quantile_name(found.levels.back());
  Table table{.name = "machines",
              .caption = fmt::format("Of each of {} the largest magnitude and the root mean square (rms) over {}",
                                     counted(found.solves.front().total(), "machine", "machines"),
                                     found.poses() == 1 ? "its pose" : fmt::format("all {} poses", found.poses())),
              .columns = {}};
  fill(table, result.headline,
       {name_column(result.responses, "response"), unit_column(result.responses),
        number("largest_mean", "largest: mean", largest.mean), number("largest_" + name, level, largest.quantiles),
        number("largest_max", "max", largest.max), number("rms_mean", "rms: mean", rms.mean, 1),
        number("rms_" + name, level, rms.quantiles, 1), number("rms_max", "max", rms.max, 1)});
  table.notes.push_back("Machines that are not solved at every pose are left out");
  if (!largest.quantile_error.empty()) {  // files of version 0.2 have no quantile_error
    table.notes.push_back(fmt::format("largest: {}; rms: {}",
                                      quantile_error_text(result.headline, largest.quantile_error, largest.std),
                                      quantile_error_text(result.headline, rms.quantile_error, rms.std)));
  }
  return table;
}

/// A table of the poses at which most machines are rejected, for each limit.
Table rejects_table(const StoredResult& result) {
  constexpr std::size_t kMost = 5;
  const YieldResult& yield = *machines_of(result).yield;
  Table table{.name = "reject_poses",
              .caption = "Where machines are rejected: the poses at which most of them are not within a limit",
              .columns = {text_column("response", "response"), number_column("pose", "pose"),
                          percent_column("rejected", "rejected"), text_column("place", "where", 1)}};
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const auto share = [&](std::size_t m) { return yield.worst_pose_share(r, m); };
    const std::vector<std::size_t> order = largest_first(positions(result.poses.size()), share);
    for (const std::size_t m : std::span(order).first(std::min(kMost, order.size()))) {
      if (!(share(m) > 0.0)) break;
      table.rows.push_back({text_cell(result.responses[r].name), count_cell(m), percent_cell(share(m)),
                            text_cell(coordinates_text(result, m))});
    }
  }
  if (table.rows.empty()) table.notes.emplace_back("No machine is rejected at any pose");
  return table;
}

/// Whether some errors are correlated and therefore have no index.
bool has_correlated(const StoredResult& result) {
  return result.study_text.find("\n[[errors.correlated]]\n") != std::string::npos;
}

/// Whether the response has too few samples that count in statistics (counts()) at a pose over which indices are
/// summed.
bool has_too_few_samples(const StoredResult& result, std::size_t r) {
  const Result& found = monte_carlo_of(result);
  return std::ranges::any_of(found.effects.s1_poses,
                             [&](std::uint64_t m) { return found.count(r, m) < kFewestIndexSamples; });
}

/// The reason why no error has an index on a response.
std::string no_index_text(const StoredResult& result, std::size_t r) {
  const std::string& response = result.responses[r].name;
  if (!varies(result, r)) return constant_text(result.responses[r]);
  if (has_too_few_samples(result, r)) {
    return fmt::format("{}: no S1 is formed below {} samples at a pose that count", response, kFewestIndexSamples);
  }
  if (has_correlated(result) || has_zone_shape(result)) {
    return response + ": no error has an index, because each is correlated or drawn with others";
  }
  return response + ": no error has an index, because it does not vary at the poses over which indices add up";
}

/// A text on the poses over which the variances of first-order indices are added up: "added up over 1 of 13 poses (pose
/// 0)".
std::string added_up_text(const StoredResult& result) {
  const std::vector<std::uint64_t>& poses = effects_of(result).s1_poses;
  const std::size_t all = monte_carlo_of(result).mean.length<axis::Pose>();
  if (poses.size() == all) return "added up over " + counted(all, "pose", "poses");
  return fmt::format("added up over {} of {} poses ({} {})", poses.size(), all, poses.size() == 1 ? "pose" : "poses",
                     fmt::join(poses, ", "));
}

std::string indices_note(const StoredResult& result, std::size_t r) {
  double sum = 0.0;
  std::size_t without = 0;
  for (const double s1 : effects_of(result).effects.s1.row(r)) {
    sum += std::isnan(s1) ? 0.0 : s1;
    without += std::isnan(s1) ? 1 : 0;
  }
  if (without == result.factors.size()) return no_index_text(result, r);
  const auto& machines = monte_carlo_of(result).machines;
  const bool has_noise = machines && machines->calibration;
  return fmt::format(
      "{}: the indices sum to {}; what is missing from 1 is what errors do together{}. A response without sign makes "
      "such interaction of its own, so an error with a small index is not one without effect",
      result.responses[r].name, number_text(sum, 3), has_noise ? ", and the noise of what was measured" : "");
}

/// Whether an error has a main-effect curve. An error that machines draw anew at each pose has none, because a mean
/// over the poses does not depend on one value of the error.
bool has_curve(const StoredResult& result, std::size_t p) { return !is_drawn_per_pose(result, p); }

/// Charts of main-effect curves, a panel for each response that a summary shows. The errors with the largest indices
/// come first.
Lines effect_curves(const StoredResult& result, ArrayPool& pool) {
  constexpr std::size_t kMost = 12;
  const MainEffects& effects = effects_of(result).effects;
  const std::size_t factors = result.factors.size();
  std::vector<double> below;
  for (std::size_t k = 0; k < kEffectBins; ++k) below.push_back((static_cast<double>(k) + 0.5) / kEffectBins);
  // The number of curves that are shown at first. The interval bands of more curves would hide each other.
  constexpr std::size_t kAtFirst = 5;
  Lines lines{.x = {"share of the error's values below", "%", pool.add("effect_bin", below, 0.01)},
              .panels = {},
              .most = kAtFirst};
  for (const std::size_t r : headline_order(result)) {
    if (!varies(result, r)) continue;
    const NamedUnit& response = result.responses[r];
    Panel panel{"mean of " + response.name, unit_text(response), {}};
    const auto s1 = [&](std::size_t p) { return effects.s1(r, p); };
    std::vector<std::size_t> order = largest_first(positions(factors), s1);
    std::erase_if(order, [&](std::size_t p) { return !has_curve(result, p); });
    if (order.empty()) continue;
    for (const std::size_t p : std::span(order).first(std::min(kMost, order.size()))) {
      const auto add = [&](std::string_view what, const MainEffects::Curves& values) {
        return pool.add(fmt::format("{}/{}/{}", what, r, p), values.row(r, p), display(response).si);
      };
      panel.series.push_back({result.factors[p].name, add("effect_mean", effects.mean),
                              add("effect_low", effects.ci_low), add("effect_high", effects.ci_high)});
    }
    lines.panels.push_back(std::move(panel));
  }
  return lines;
}

}  // namespace

std::string quantile_error_text(std::span<const std::size_t> responses, std::span<const double> errors,
                                std::span<const double> deviations) {
  double largest = 0.0;
  for (const std::size_t r : responses) {
    if (errors[r] > 0.0) largest = std::max(largest, errors[r] / deviations[r]);
  }
  return largest == 0.0 ? "quantiles are those of the samples"
                        : fmt::format("quantiles to {} of std", percent_text(largest));
}

std::vector<Table> machine_tables(const StoredResult& result) {
  std::vector<Table> tables{values_table(result)};
  if (const auto& yield = machines_of(result).yield) {
    // If limits are not judged by the yield, the verdicts do not contain the yield.
    if (result.verdicts && !result.verdicts->yield) {
      tables.insert(tables.begin(),
                    yield_table(result, {.judge = Judge::yield,
                                         .limits = {},
                                         .yield = judge_yield(*yield, monte_carlo_of(result).total(), 0.0)}));
    }
    tables.push_back(rejects_table(result));
  }
  return tables;
}

Table calibration_table(const StoredResult& result) {
  const CalibrationYields& found = *machines_of(result).calibration;
  const YieldResult& with = *machines_of(result).yield;
  Table table{.name = "calibration",
              .caption = fmt::format("Yield of the same {}, as they are made and calibrated",
                                     counted(with.machines, "machine", "machines")),
              .columns = {text_column("machines", "machines"), percent_column("yield", "yield"),
                          percent_column("yield_low", "low"), percent_column("yield_high", "high")},
              .notes = {fmt::format("low, high: {} interval", percent_text(with.conf_level))}};
  const auto add = [&](const std::string& machines, double value, double low, double high) {
    table.rows.push_back({text_cell(machines), percent_cell(value), percent_cell(low), percent_cell(high)});
  };
  add("as they are made, without calibration", found.uncalibrated, found.uncalibrated_ci_low,
      found.uncalibrated_ci_high);
  add(fmt::format("with this calibration: {}, {} at {}", counted(found.fitted, "fitted error", "fitted errors"),
                  counted(found.measured, "measured value", "measured values"),
                  counted(found.measured_poses, "pose", "poses")),
      with.value, with.ci_low, with.ci_high);
  if (!std::isnan(found.best)) {
    add("with the drives corrected at each pose, best for the platform's points", found.best, found.best_ci_low,
        found.best_ci_high);
    table.notes.emplace_back(
        "corrected at each pose: so that the platform's points (metric_points) are best; for another point, such as "
        "the tool, a calibration can be better");
  }
  table.notes.emplace_back("all other numbers are those with this calibration");
  if (found.not_fitted > 0) {
    table.notes.push_back(fmt::format("{} {} not calibrated, because the fit has no solution, and count as rejects",
                                      counted(found.not_fitted, "machine", "machines"),
                                      found.not_fitted == 1 ? "was" : "were"));
  }
  return table;
}

void add_effects_section(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const EffectResult& found = effects_of(result);
  const std::vector<std::size_t> order = response_order(result);
  Section& section = page.add_section("first-order", "What each error does alone");
  ArrayPool& pool = page.figures.pool;
  const auto quantity = [&](const std::string& label, const std::string& name, const MainEffects& effects) {
    const auto add = [&](const std::string& end, const MainEffects::Indices& values) {
      return pool.add(name + end, in_order(values, order));
    };
    return BarQuantity{label, std::vector(order.size(), std::vector<std::string>{""}), add("", effects.s1),
                       add("_low", effects.s1_ci_low), add("_high", effects.s1_ci_high)};
  };
  section.paragraph(fmt::format(
      "The first-order index of an error is the part of a response's variance that goes when the error is known. "
      "Variances are {}. A response without sign is not additive although the mechanism is nearly linear, so its "
      "indices sum to less than 1: read them with the shares of the scatter.",
      added_up_text(result)));
  Bars bars{{{"response", names_of(result.responses, order)}},
            {quantity("first-order index S1", "S1", found.effects)},
            names_of(result.factors)};
  if (const auto& machines = monte_carlo_of(result).machines) {
    bars.quantities.push_back(
        quantity("the same of a machine's largest magnitude", "S1_largest", machines->effects_on_largest));
  }
  add_figure(page, section, "first-order", std::move(bars), "First-order indices with their intervals.");
  if (Lines curves = effect_curves(result, pool); !curves.panels.empty()) {
    add_figure(page, section, "main-effects", std::move(curves),
               "The mean of a response over poses while one error is known and all others vary, with its interval.");
  }
  section.table(tables, "first_order");
}

Table effect_table(const StoredResult& result) {
  const MainEffects& effects = effects_of(result).effects;
  const std::size_t ranking = response_named(result, default_ranking(result));
  std::vector<FilledColumn> columns{name_column(result.factors, "error")};
  const auto add = [&](const std::string& name, const std::string& heading, std::span<const double> values,
                       int dispensable) {
    columns.push_back(
        {number_column(name, heading, "", dispensable), [values](std::size_t p) { return number_cell(values[p], 3); }});
  };
  for (const std::size_t r : headline_order(result)) {
    const std::string& response = result.responses[r].name;
    add("S1_" + response, response, effects.s1.row(r), r == ranking ? 0 : 1);
    add("S1_ci_low_" + response, "low", effects.s1_ci_low.row(r), r == ranking ? 0 : 2);
    add("S1_ci_high_" + response, "high", effects.s1_ci_high.row(r), r == ranking ? 0 : 2);
  }
  Table table{.name = "first_order",
              .caption = "First-order indices S1: the part of a response's variance that an error makes alone",
              .columns = {},
              .notes = {fmt::format("{}; low, high: {} interval", added_up_text(result),
                                    percent_text(monte_carlo_of(result).conf_level)),
                        indices_note(result, ranking)},
              .ranked = true};
  for (const std::size_t r : headline_order(result)) {
    if (r != ranking && !varies(result, r)) table.notes.push_back(constant_text(result.responses[r]));
  }
  if (has_correlated(result)) {
    table.notes.emplace_back(
        "- for an error that is correlated with others: nothing is its effect alone; indices of groups and Shapley "
        "effects divide the variance of such errors");
  }
  if (has_zone_shape(result)) {
    table.notes.emplace_back(
        "- for an error of a feature whose errors are drawn together in their zone: kind = \"sobol\" has indices of "
        "groups that hold whole features");
  }
  fill(table, largest_first(positions(result.factors.size()), [&](std::size_t p) { return effects.s1(ranking, p); }),
       columns);
  return table;
}

std::vector<Field> reject_fields(const StoredResult& result, const PoseFigures& figures) {
  std::vector<Field> fields;
  if (!machines_of(result).yield) return fields;
  const auto& shares = machines_of(result).yield->worst_pose_share;
  for (const std::size_t r : figures.responses()) {
    if (verdict_on(result, r) == nullptr) continue;
    fields.push_back({result.responses[r].name + ", machines rejected", "%",
                      figures.add(fmt::format("rejected/{}", r), shares.row(r), 0.01)});
  }
  return fields;
}

}  // namespace poesy::monte_carlo
