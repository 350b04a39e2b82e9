#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/base/nan.h"
#include "engine/kinds/allocation/kind.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/search.h"
#include "engine/kinds/confirming_study.h"
#include "engine/run/evaluate_unit.h"
#include "engine/stats/proportion.h"
#include "engine/study/study_file.h"

namespace poesy {
namespace {

/// Yields and multiples of the limits for which a cost is predicted.
constexpr std::array kYields{0.9, 0.95, 0.98, 0.99, 0.995, 0.9973, 0.999, 0.9995, 0.9999};
constexpr std::array kFactors{0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.35, 1.5, 2.0};

/// The study that tries fresh machines with these tolerances.
Study certificate_study(const ToleranceProgramme& programme, const TolerancePoint& found, const Study& study) {
  const AllocationOptions& asked = asked_of<AllocationOptions>(study.analysis);
  Study fresh = as_confirming_study(programme.at(found.tolerance), "certificate");
  fresh.seed = seed_of_others(study, SampleIndex(0));
  fresh.analysis.kind->ask_yield(fresh, asked.yield);
  fresh.analysis.conf_level = asked.confidence;
  return fresh;
}

YieldVerdict verdict_of(const Trial& trial, double yield, double confidence) {
  const std::uint64_t machines = trial.load.size();
  const std::uint64_t good = machines - trial.rejects();
  const Estimate share = proportion(good, machines, confidence);
  YieldVerdict verdict{.decision = YieldVerdict::Decision::undecided,
                       .asked = yield,
                       .conf_level = confidence,
                       .value = share.value,
                       .ci_low = share.interval.low,
                       .ci_high = share.interval.high,
                       .machines = machines,
                       .rejects = machines - good,
                       .unsolved = trial.unsolved,
                       .solves = total_of(trial.solves)};
  if (proportion_at_least(good, machines, confidence) >= yield) verdict.decision = YieldVerdict::Decision::kept;
  if (proportion_at_most(good, machines, confidence) < yield) verdict.decision = YieldVerdict::Decision::not_kept;
  return verdict;
}

/// Divides a part's share of the mean square among its errors, which have one variance, by their slopes under this
/// limit.
void divide_share(const ToleranceSearch& search, std::size_t limit, std::size_t part, AllocationResult& found) {
  const std::span<const std::size_t> errors = search.programme().errors(part);
  const std::span<const double> slopes =
      std::span(search.squares().slope).subspan(limit * found.error_mean_square_share.size());
  double sum = 0.0;
  for (const std::size_t p : errors) sum += slopes[p];
  for (const std::size_t p : errors) {
    const double within = sum > 0.0 ? slopes[p] / sum : 1.0 / static_cast<double>(errors.size());
    found.error_mean_square_share[p] = within * found.mean_square_share[part];
  }
}

/// What is said of each part.
void add_parts(const ToleranceSearch& search, const Study& study, AllocationResult& found) {
  const ToleranceProgramme& programme = search.programme();
  const TolerancePoint& point = search.found();
  found.error_mean_square_share.assign(study.analysis.factors.size(), kNaN);
  const std::size_t parts = programme.size();
  const std::size_t tightest = worst_use(search.limits(), point.tolerance).limit;
  const double need = search.limits().need(tightest, point.tolerance);
  for (std::size_t i = 0; i < parts; ++i) {
    const AllocatedPart& part = programme.parts()[i];
    const Spread spread{part.sigmas, part.shift};
    const double tolerance = point.tolerance[i];
    std::string members;
    for (const FactorIndex factor : part.factors) {
      members += (members.empty() ? "" : " ") + study.model().factors[factor.value].name;
    }
    found.part_names.push_back(part.name);
    found.part_members.push_back(std::move(members));
    found.part_unit.emplace_back(si_unit(study.model().factors[part.factors.front().value].dimension));
    found.tolerance.push_back(tolerance);
    found.sigma.push_back(sigma_per_tolerance(spread) * tolerance);
    found.sigmas.push_back(part.sigmas);
    found.shift.push_back(part.shift * tolerance);
    found.cost.push_back(std::isnan(point.cost) ? kNaN : programme.cost(i, tolerance, point.process[i]));
    found.share.push_back(found.cost.back() / point.cost);
    found.mean_square_share.push_back(search.limits().row(tightest)[i] * tolerance * tolerance / need);
    divide_share(search, tightest, i, found);
    found.bound.push_back(static_cast<std::uint8_t>(programme.at_bound(i, tolerance, point.process[i])));
    found.chosen.push_back(programme.chosen_name(i, point.process[i]));
  }
  found.coarser_yield = search.coarser_yield();
}

/// What is said of each limit.
void add_limits(const ToleranceSearch& search, const Study& study, AllocationResult& found) {
  const ToleranceLimits& limits = search.limits();
  const std::size_t cells = found.responses * found.poses;
  found.limit.assign(found.responses, kNaN);
  found.saving.assign(found.responses, kNaN);
  found.multiplier.assign(cells, kNaN);
  found.limit_use.assign(cells, kNaN);
  for (std::size_t k = 0; k < study.analysis.limits.size(); ++k) {
    const ResponseLimit& limit = study.analysis.limits[k];
    found.limit[limit.response] = limit.most;
    const double allowed = search.share() * limit.most;
    double price = 0.0;
    for (std::size_t m = 0; m < found.poses; ++m) {
      const std::size_t row = k * found.poses + m;
      const std::size_t cell = limit.response * found.poses + m;
      const double square = allowed * allowed - limits.room[row] + limits.need(row, search.found().tolerance);
      found.limit_use[cell] = std::sqrt(std::max(0.0, square)) / allowed;
      if (search.chosen().multiplier.empty()) continue;
      // The room is (share x limit)^2 less what is fixed.
      found.multiplier[cell] = search.chosen().multiplier[row] * 2.0 * search.share() * allowed;
      price += found.multiplier[cell];
    }
    if (!search.chosen().multiplier.empty()) found.saving[limit.response] = 0.01 * limit.most * price;
  }
}

/// Costs of other yields, by the loads of the design's machines, and of other limits.
void add_curves(const ToleranceSearch& search, const AllocationOptions& asked, AllocationResult& found) {
  if (std::isnan(search.found().cost)) return;
  const double cost_here = search.cost_at(search.share(), 1.0);
  const double scale = search.found().cost / cost_here;
  std::vector<double> loads(search.loads().begin(), search.loads().end());
  std::ranges::sort(loads, std::ranges::greater());
  for (const double yield : kYields) {
    if (loads.size() < trials_without_failure(yield, asked.confidence)) continue;
    const std::uint64_t rejects = allowed_rejects(yield, asked.confidence, loads.size()).design;
    const double load = loads[rejects];
    if (rejects == 0 || !(load > 0.0) || std::isinf(load)) continue;  // too few machines to tell
    found.curve_yield.push_back(yield);
    found.curve_yield_cost.push_back(scale * search.cost_at(search.share() / load, 1.0));
  }
  for (const double factor : kFactors) {
    found.curve_factor.push_back(factor);
    found.curve_factor_cost.push_back(scale * search.cost_at(search.share(), factor));
  }
}

AllocationResult result_of(const StudyRun& run, const ToleranceSearch& search, const Trial& trial,
                           const Study& certificate) {
  const Study& study = run.study;
  const AllocationOptions& asked = asked_of<AllocationOptions>(study.analysis);
  AllocationResult found;
  found.responses = study.model().responses.size();
  found.poses = run.poses.size();
  add_parts(search, study, found);
  add_limits(search, study, found);
  add_curves(search, asked, found);
  found.aim = asked.aim;
  found.calibrated = study.mechanism.calibrated;
  found.total_cost = search.found().cost;
  found.lower_bound = search.chosen().lower_bound;  // NaN where nothing but the lowest tolerances was left
  found.gap = search.chosen().cost - search.chosen().lower_bound;
  found.wanted_yield = asked.yield;
  found.confidence = asked.confidence;
  found.stages = search.stages();
  found.stage_tolerance = search.stage_tolerance();
  found.design_machines = search.loads().size();
  found.design_rejects = search.rejects();
  found.design_most = search.allowed().design;
  found.certificate_seed = certificate.seed;
  found.certificate_most = search.allowed().certificate;
  found.certificate = verdict_of(trial, asked.yield, asked.confidence);
  found.certificate_study = resolved_text(certificate);
  found.solves = trial.solves;
  for (std::size_t m = 0; m < found.poses; ++m) append_failures(0, PoseIndex(m), trial.failed[m], found.failures);
  return found;
}

LimitVerdicts verdicts_of(const Study& study, const Trial& trial, const YieldVerdict& certificate) {
  LimitVerdicts verdicts{.judge = Judge::yield, .limits = {}, .yield = certificate};
  for (std::size_t k = 0; k < study.analysis.limits.size(); ++k) {
    const ResponseLimit& limit = study.analysis.limits[k];
    const std::uint64_t within = certificate.machines - trial.beyond[k];
    const double share = static_cast<double>(within) / static_cast<double>(certificate.machines);
    verdicts.limits.push_back({.response = limit.response,
                               .limit = limit.most,
                               .value = kNaN,
                               .passed = share >= certificate.asked,
                               .tried = certificate.machines,
                               .within = within});
  }
  return verdicts;
}

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  ToleranceSearch search(run);
  if (!search.find()) return std::nullopt;
  const Study certificate = certificate_study(search.programme(), search.found(), run.study);
  const auto trial = try_machines(Plan(certificate, run.poses), run.model, certificate.analysis.limits, run.options);
  if (!trial || !run.makes_result()) return std::nullopt;
  AllocationResult found = result_of(run, search, *trial, certificate);
  LimitVerdicts verdicts = verdicts_of(run.study, *trial, found.certificate);
  return StudyResult{std::move(found), std::move(verdicts), {}, certificate};
}

/// Machines are tried about so many times, those of the certificate among them.
constexpr double kTrials = 5.0;

Outlook allocation_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const auto plan = std::make_shared<const Plan>(study, poses);
  constexpr double kMeasurements = 6.0;
  const double effects = kMeasurements * static_cast<double>(mean_square_solves(*plan, kDrawsAmongOthers));
  const double machines = kTrials * static_cast<double>(plan->solves());
  const std::size_t errors = plan->factors().size();
  const std::size_t rows = study.analysis.limits.size() * poses.size();
  const std::size_t loads = plan->samples() * sizeof(double);
  const std::size_t squares = 3 * rows * errors * sizeof(double);
  // Use and multiplier of each limit; the pose with its condition number.
  const std::size_t of_pose = 2 * study.model().responses.size() + study.model().pose_coordinates.size() + 1;
  const std::size_t numbers = poses.size() * of_pose * sizeof(double);
  // Numbers and names of each part, and what the certificate's study says of it.
  constexpr std::size_t kPart = 400;
  const std::size_t parts = kPart * asked_of<AllocationOptions>(study.analysis).parts.size();
  const std::size_t file = numbers + poses.size() * kSolverColumns + parts;
  return {.solves = fmt::format("about {:.0f} x {} x {} machines and {:.2g} for the effects of {}: {:.2g} solves",
                                kTrials, counted_things(poses.size(), "poses"), plan->samples(), effects,
                                counted_things(errors, "errors"), machines + effects),
          .memory = {4 * loads + 2 * squares, 4 * loads + 3 * squares, numbers, file},
          .shared = {sampling<PoseUnitEvaluator>(plan, borrowed(model),
                                                 (machines + effects) / static_cast<double>(plan->solves()))},
          .by_one = {},
          .least = 1.0};
}

}  // namespace

constinit const Kind kAllocationKind{.study = kAllocationStudy,
                                     .run = {run_study_of_kind, allocation_outlook, nullptr, true},
                                     .file = kAllocationFile,
                                     .report = kAllocationReport};

}  // namespace poesy
