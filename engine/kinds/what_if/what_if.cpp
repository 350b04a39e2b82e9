#include "engine/kinds/what_if/what_if.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "engine/kinds/limited_vectors.h"
#include "engine/kinds/what_if/deciding_poses.h"
#include "engine/kinds/what_if/machines.h"
#include "engine/kinds/what_if/single_changes.h"
#include "engine/kinds/what_if/tried.h"
#include "engine/report/display.h"
#include "engine/stats/moments.h"
#include "engine/study/plan.h"

namespace poesy {
namespace {

constexpr std::size_t kMostMachines = Plan::kUnitSamples;
/// The largest number of components of limited vectors in a report, over all machines and poses. Each takes 4 bytes.
constexpr std::size_t kMostNumbers = 60'000;
constexpr std::size_t kMostPoses = 150;  // largest number of poses that are solved, so that a report takes seconds
constexpr std::size_t kMostSliders = 10;
constexpr double kLeastShare = 1e-6;  // smallest share of a slider's errors, as a share of the largest one
// The largest allowed WhatIf::linear_error: the error of the linear prediction if all sizes change by 100 %, as a share
// of a limit. If the error is larger, there is no prediction.
constexpr double kMostLinearError = 0.5;

/// The poses with the largest weights, at most kMostPoses, in ascending order.
std::vector<std::size_t> heaviest_poses(std::span<const double> weights) {
  std::vector<std::size_t> poses = positions(weights.size());
  std::ranges::stable_sort(poses, std::ranges::greater(), [&](std::size_t m) { return weights[m]; });
  poses.resize(std::min(poses.size(), kMostPoses));
  std::ranges::sort(poses);
  return poses;
}

/// [errors] For each error, its share in the mean square of a limited vector at a pose, summed over all limits and,
/// with these weights, over the poses. NaN if a derivative is unknown.
std::vector<double> shares(const TriedMachines& tried, const Plan& plan, std::span<const double> pose_weights) {
  std::vector<double> list(plan.factors().size(), 0.0);
  std::vector<double> squares(list.size());
  for (std::size_t k = 0; k < tried.poses.size(); ++k) {
    for (const ScaledLimit& limit : tried.limits) {
      double all = 0.0;
      for (std::size_t p = 0; p < squares.size(); ++p) {
        squares[p] = 0.0;
        for (std::size_t row = limit.first; row < limit.first + limit.rows; ++row) {
          const double effect = tried.slopes[k](row, p) * plan.distributions()[p].standard_deviation();
          squares[p] += effect * effect;
        }
        all += std::isnan(squares[p]) ? 0.0 : squares[p];
      }
      if (!(all > 0.0)) continue;
      for (std::size_t p = 0; p < squares.size(); ++p) list[p] += pose_weights[k] * squares[p] / all;
    }
  }
  return list;
}

/// [poses] The number of machines that exceed a limit at the pose, plus one.
std::vector<double> rejects_at(const TriedMachines& tried) {
  std::vector<double> weights;
  for (const WhatIfMachines::Rows& rows : tried.rows) {
    const std::vector<double> beyond = badness(rows, tried.limits);
    weights.push_back(1.0 + static_cast<double>(std::ranges::count_if(beyond, [](double one) { return one > 0.0; })));
  }
  return weights;
}

/// The groups of errors that get a slider: those with the largest shares, at most kMostSliders. Groups with less than a
/// millionth of the largest share get none, because their sliders would change nothing.
std::vector<SizedErrors> leading(const JudgedMachines& judged, const TriedMachines& tried, const Plan& plan) {
  const std::vector<double> of_each = shares(tried, plan, rejects_at(tried));
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t g = 0; g < judged.errors.size(); ++g) {
    double share = 0.0;
    for (const std::size_t p : judged.errors[g].slots) share += of_each[p];
    if (share > 0.0) order.emplace_back(share, g);
  }
  std::ranges::stable_sort(order, std::ranges::greater(), [](const auto& one) { return one.first; });
  std::vector<SizedErrors> list;
  for (const auto& [share, g] : std::span(order).first(std::min(kMostSliders, order.size()))) {
    if (share > kLeastShare * order.front().first) list.push_back(judged.errors[g]);
  }
  return list;
}

/// How well the prediction agrees with exact solves of the same machines.
struct Agreement {
  /// Error of the linear prediction (WhatIf::linear_error) that the share `conf_level` of the machines does not exceed.
  double linear_error = 0.0;
  double unsolved = 0.0;  ///< largest share of machines that are predicted, but cannot be solved at the changed sizes
};

/// [machines] The largest badness() of each machine over these poses. at_poses: [poses][machines].
std::vector<double> worst_of(std::span<const std::vector<double>> at_poses) {
  std::vector<double> worst = at_poses.front();
  for (const auto& one : at_poses) {
    std::ranges::transform(worst, one, worst.begin(), [](double a, double b) { return std::max(a, b); });
  }
  return worst;
}

Agreement agreement(const TriedMachines& tried, WhatIfMachines& machines, std::span<const SizedErrors> sliders,
                    const DecidingPoses& deciding, double conf_level) {
  Agreement found;
  const std::size_t errors = machines.deviations().length<axis::Factor>();
  for (const double factor : {what_if_factors().front(), what_if_factors().back()}) {
    const std::vector<double> sizes = sizes_of(sliders, std::vector(sliders.size(), factor), errors);
    std::vector<std::vector<double>> exact;
    std::vector<std::vector<double>> predicted;
    for (const std::size_t k : deciding.places) {
      exact.push_back(badness(machines.solve(PoseIndex(tried.poses[k]), sizes), tried.solved_limits));
      predicted.push_back(badness(changed(tried, machines, k, sizes), tried.limits));
    }
    const std::vector<double> is = worst_of(exact);
    const std::vector<double> said = worst_of(predicted);
    std::vector<double> differences;
    std::size_t unsolved = 0;
    for (std::size_t b = 0; b < is.size(); ++b) {
      if (std::isinf(said[b])) continue;
      if (std::isinf(is[b])) {
        ++unsolved;
      } else {
        differences.push_back(std::abs(is[b] - said[b]) / std::abs(factor - 1.0));
      }
    }
    found.unsolved = std::max(found.unsolved, static_cast<double>(unsolved) / static_cast<double>(is.size()));
    if (differences.empty()) continue;
    std::ranges::sort(differences);
    const auto at = static_cast<std::size_t>(conf_level * static_cast<double>(differences.size() - 1));
    found.linear_error = std::max(found.linear_error, differences[at]);
  }
  return found;
}

/// Whether a prediction is possible: all limits are judged at single poses, all limited responses have a limited
/// vector, these vectors have few enough components for the report, and there are errors to change and more than one
/// machine.
bool may_be_predicted(const JudgedMachines& judged, const LimitedVectors& vectors) {
  const std::vector<ResponseLimit>& limits = judged.study.analysis.limits;
  return vectors.rows() > 0 && vectors.rows() <= kMostNumbers / kMostMachines &&
         vectors.each().size() == limits.size() && !any_over_poses(limits) && !judged.errors.empty() &&
         judged.machines > 1;
}

/// Whether the model reaches these poses, and the pose before each of them, from which solves may start. A result file
/// may contain poses that the model does not reach.
bool are_reached(const JudgedMachines& judged, std::span<const std::size_t> poses) {
  return std::ranges::all_of(poses, [&](std::size_t m) {
    return !judged.model.unreachable(judged.poses[PoseIndex(m)]) &&
           (m == 0 || !judged.model.unreachable(judged.poses[PoseIndex(m - 1)]));
  });
}

/// The numbers that the page needs for its sliders. Errors are numbered slider by slider.
WhatIf packed(const TriedMachines& tried, const WhatIfMachines& machines, std::span<const SizedErrors> sliders,
              const DecidingPoses& deciding, ArrayPool& pool) {
  WhatIf made;
  made.factors.assign(what_if_factors().begin(), what_if_factors().end());
  made.machines = machines.machines();
  made.poses = deciding.places.size();
  std::vector<std::size_t> errors;
  std::vector<double> deviations;
  for (const SizedErrors& one : sliders) {
    WhatIfSlider slider{one.name, one.sizes, {}, one.costs};
    for (const std::size_t p : one.slots) {
      slider.errors.push_back(errors.size());
      errors.push_back(p);
      std::ranges::copy(machines.deviations().row(p), std::back_inserter(deviations));
    }
    made.sliders.push_back(std::move(slider));
  }
  std::vector<double> components;
  std::vector<double> slopes;
  for (const ScaledLimit& limit : tried.limits) made.limits.push_back({limit.rows, limit.low, limit.high});
  for (const std::size_t k : deciding.places) {
    for (const ScaledLimit& limit : tried.limits) {
      for (std::size_t row = limit.first; row < limit.first + limit.rows; ++row) {
        for (const double value : tried.rows[k].row(row)) components.push_back(value / limit.scale);
        for (const std::size_t p : errors) slopes.push_back(tried.slopes[k](row, p) / limit.scale);
      }
    }
  }
  made.components = pool.add("what_if/components", components);
  made.deviations = pool.add("what_if/deviations", deviations);
  made.slopes = pool.add("what_if/slopes", slopes);
  return made;
}

/// The cost of these errors at the study's sizes.
double cost_of(std::span<const SizedErrors> list) {
  const auto same = std::ranges::find(what_if_factors(), 1.0) - what_if_factors().begin();
  double cost = 0.0;
  for (const SizedErrors& one : list) cost += one.costs.empty() ? 0.0 : one.costs[static_cast<std::size_t>(same)];
  return cost;
}

/// The caption, which explains how the prediction and its interval are computed.
std::string caption_of(const WhatIf& made, double conf_level) {
  constexpr double kRounding = 1e-9;
  const std::string level = percent_text(conf_level);
  std::string text = fmt::format(
      "From {} at {}: their solved responses, changed linearly with their errors. A slider scales how far errors are "
      "from their means. The difference between the yield of these machines and that of the study is corrected. The "
      "interval adds up chance, {} for the machines of the study and for these",
      counted(made.machines, "machine of the study", "machines of the study"), counted(made.poses, "pose", "poses"),
      level);
  if (made.linear_error > kRounding) {
    text += fmt::format(
        "; and machines so near a limit that the linear map may misjudge them: with all sizes at either end it errs by "
        "less than {} of the limit for {} of the machines",
        percent_text(made.linear_error), level);
  }
  return text + (made.missed > 0.0
                     ? fmt::format("; and {} of machines that only other poses reject, or that cannot be solved.",
                                   percent_text(made.missed))
                     : ". Other poses reject no further machine.");
}

}  // namespace

std::span<const double> what_if_factors() {
  static constexpr auto kFactors = [] {
    std::array<double, 36> factors{};
    for (std::size_t k = 0; k < factors.size(); ++k) factors[k] = static_cast<double>(k + 5) / 20.0;
    return factors;
  }();
  return kFactors;
}

std::optional<YieldPrediction> what_if(const JudgedMachines& judged, ArrayPool& pool) {
  const Plan plan(judged.study, judged.poses);
  const LimitedVectors vectors(plan, judged.model, judged.study.analysis);
  std::vector<std::size_t> poses = heaviest_poses(judged.pose_weights);
  if (!may_be_predicted(judged, vectors) || !are_reached(judged, poses)) return std::nullopt;
  WhatIfMachines machines(plan, judged.model, vectors, std::min({kMostMachines, judged.machines, plan.samples()}));
  const TriedMachines tried = tried_machines(std::move(poses), plan, vectors, machines);
  const std::vector<SizedErrors> sliders = leading(judged, tried, plan);
  if (sliders.empty()) return std::nullopt;
  const std::size_t components = tried.limits.back().first + tried.limits.back().rows;
  const std::size_t most = kMostNumbers / (machines.machines() * components);
  const DecidingPoses deciding = deciding_poses(tried, machines, sliders, most);
  const Agreement agrees = agreement(tried, machines, sliders, deciding, judged.conf_level);
  if (agrees.linear_error > kMostLinearError) return std::nullopt;
  WhatIf made = packed(tried, machines, sliders, deciding, pool);
  made.yield = judged.yield;
  made.yield_low = judged.yield_low;
  made.yield_high = judged.yield_high;
  made.quantile = two_sided_normal_quantile(judged.conf_level);
  made.linear_error = agrees.linear_error;
  made.missed = deciding.missed + agrees.unsolved;
  made.other_costs = cost_of(judged.errors) - cost_of(sliders);
  std::vector<double> means;
  for (const Distribution& one : plan.distributions()) means.push_back(one.mean());
  const auto changes = single_changes(judged.errors, means, judged.yield, tried, machines, deciding);
  std::string text = changes_text(changes, judged.yield, made.quantile);
  return YieldPrediction{std::move(made), std::move(text)};
}

std::string add_what_if(const JudgedMachines& judged, std::string_view after, Page& page) {
  std::optional<YieldPrediction> prediction = what_if(judged, page.figures.pool);
  if (!prediction) return {};
  WhatIf& made = prediction->figure;
  const bool has_costs = std::ranges::any_of(made.sliders, [](const WhatIfSlider& one) { return !one.costs.empty(); });
  Section& section = page.insert_section(after, "what-if", "What if sizes were different");
  section.paragraph(fmt::format(
      "Move the {} that matter most, and see the yield{} follow. It is a prediction, certified only at the study's "
      "sizes: run the study with the sizes you choose. The sliders need a browser with JavaScript.",
      counted(made.sliders.size(), "size", "sizes"), has_costs ? " and the cost" : ""));
  const std::string caption = caption_of(made, judged.conf_level);
  page.figures.figures.emplace("what-if", std::move(made));
  section.figure("what-if", caption, "<p>The sliders need JavaScript.</p>");
  if (!prediction->changes.empty()) section.paragraph(prediction->changes);
  return prediction->changes;
}

}  // namespace poesy
