#include "engine/kinds/what_if/single_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "engine/report/display.h"
#include "engine/report/limb_names.h"

namespace poesy {
namespace {

using Rows = WhatIfMachines::Rows;

/// [machines] Whether each machine is within all limits at the deciding poses. at_pose: the vectors at pose k of
/// `tried`.
template <class AtPose>
std::vector<bool> good_machines(const TriedMachines& tried, const DecidingPoses& deciding, std::size_t machines,
                                const AtPose& at_pose) {
  std::vector<bool> good(machines, true);
  for (const std::size_t k : deciding.places) {
    const std::vector<double> beyond = badness(at_pose(k), tried.limits);
    for (std::size_t b = 0; b < machines; ++b) good[b] = good[b] && !(beyond[b] > 0.0);
  }
  return good;
}

/// The share of good machines after a change, by regression on the known yield, with its standard error by chance. The
/// regression adds one to each of the counts of machines that are good only before, only after, both times, and never.
/// The sliders of the page compute the same.
PredictedChange after(std::string change, const std::vector<bool>& now, const std::vector<bool>& then, double yield) {
  const auto machines = static_cast<double>(now.size());
  const auto good_now = static_cast<double>(std::ranges::count(now, true));
  const auto good_then = static_cast<double>(std::ranges::count(then, true));
  double both = 0.0;
  for (std::size_t b = 0; b < now.size(); ++b) both += now[b] && then[b] ? 1.0 : 0.0;
  const double all = machines + 4.0;
  const double was = (good_now + 2.0) / all;
  const double is = (good_then + 2.0) / all;
  const double slope = ((both + 1.0) / all - was * is) / (was * (1.0 - was));
  const double rest = is * (1.0 - is) - slope * slope * was * (1.0 - was);
  return {std::move(change), std::clamp((good_then + slope * (machines * yield - good_now)) / machines, 0.0, 1.0),
          std::sqrt(std::max(0.0, rest) / all)};
}

/// The vectors minus their means over the machines that are solved.
Rows without_means(Rows rows) {
  for (std::size_t row = 0; row < rows.length<axis::VectorRow>(); ++row) {
    double sum = 0.0;
    std::size_t solved = 0;
    for (const double value : rows.row(row)) {
      if (std::isnan(value)) continue;
      sum += value;
      ++solved;
    }
    if (solved == 0) continue;
    for (double& value : rows.row(row)) value -= sum / static_cast<double>(solved);
  }
  return rows;
}

/// The vectors at pose k without the effects of the means of these errors, to first order.
Rows without_means_of(std::span<const std::size_t> slots, std::span<const double> means, const TriedMachines& tried,
                      std::size_t k) {
  Rows rows = tried.rows[k];
  for (std::size_t row = 0; row < rows.length<axis::VectorRow>(); ++row) {
    double effect = 0.0;
    for (const std::size_t p : slots) effect += means[p] == 0.0 ? 0.0 : tried.slopes[k](row, p) * means[p];
    for (double& value : rows.row(row)) value -= effect;
  }
  return rows;
}

/// The errors of each name, joined over the limbs.
std::map<std::string, std::vector<std::size_t>> slots_by_name(std::span<const SizedErrors> errors) {
  std::vector<std::string> names;
  for (const SizedErrors& one : errors) names.push_back(one.name);
  join_limbs(names);
  std::map<std::string, std::vector<std::size_t>> slots;
  for (std::size_t g = 0; g < errors.size(); ++g) {
    std::ranges::copy(errors[g].slots, std::back_inserter(slots[names[g]]));
  }
  return slots;
}

}  // namespace

std::vector<PredictedChange> single_changes(std::span<const SizedErrors> errors, std::span<const double> means,
                                            double yield, const TriedMachines& tried, const WhatIfMachines& machines,
                                            const DecidingPoses& deciding) {
  const auto good = [&](const auto& at_pose) { return good_machines(tried, deciding, machines.machines(), at_pose); };
  const std::vector<bool> now = good([&](std::size_t k) { return tried.rows[k]; });
  std::vector<PredictedChange> changes;
  const auto add = [&](const std::string& change, const auto& at_pose) {
    changes.push_back(after(change, now, good(at_pose), yield));
  };
  for (const auto& [name, slots] : slots_by_name(errors)) {
    std::vector<double> sizes(machines.deviations().length<axis::Factor>(), 1.0);
    for (const std::size_t p : slots) sizes[p] = 0.5;
    add("halving " + name, [&](std::size_t k) { return changed(tried, machines, k, sizes); });
    if (std::ranges::all_of(slots, [&](std::size_t p) { return means[p] == 0.0; })) continue;
    // Clang 14 captures no structured binding, hence the second name.
    add("removing the means of " + name,
        [&, &of_name = slots](std::size_t k) { return without_means_of(of_name, means, tried, k); });
  }
  add("removing the means of the responses", [&](std::size_t k) { return without_means(tried.rows[k]); });
  std::ranges::stable_sort(changes, std::ranges::greater(), &PredictedChange::yield);
  return changes;
}

std::string changes_text(std::span<const PredictedChange> changes, double yield, double quantile) {
  constexpr std::size_t kMost = 4;
  constexpr double kNotable = 0.001;  // one machine in 1000; a prediction uses no more machines
  std::string text;
  double chance = 0.0;
  for (const PredictedChange& one : changes.first(std::min(kMost, changes.size()))) {
    if (!(one.yield > yield + kNotable)) break;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", one.change, percent_text(one.yield));
    chance = std::max(chance, 100.0 * quantile * one.standard_error);
  }
  if (text.empty()) return {};
  return fmt::format(
      "Predicted yields for one change alone, now {}: {}. Each is uncertain by up to {:.2g} percentage "
      "points; changes that differ by less are not told apart.",
      percent_text(yield), text, chance);
}

}  // namespace poesy
