#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "engine/base/nan.h"
#include "engine/drawing/share_inside.h"
#include "engine/kinds/allocation/kind.h"
#include "engine/kinds/allocation/machine_loads.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/search.h"
#include "engine/kinds/allocation/zone_parts.h"
#include "engine/kinds/confirming_study.h"
#include "engine/run/evaluate_unit.h"
#include "engine/stats/proportion.h"
#include "engine/study/study_file.h"

namespace poesy::allocation {
namespace {

/// Costs are predicted for these yields, and for all limits multiplied by these factors.
constexpr std::array kYields{0.9, 0.95, 0.98, 0.99, 0.995, 0.9973, 0.999, 0.9995, 0.9999};
constexpr std::array kFactors{0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.35, 1.5, 2.0};

/// The study that certifies these tolerances [parts] with fresh machines.
Study certificate_study(const SearchProblem& problem, std::span<const double> tolerance) {
  Study fresh = as_confirming_study(problem.programme.at(tolerance), "certificate");
  fresh.seed = seed_of_others(problem.run.study, SampleIndex(0));
  fresh.analysis.kind->ask_yield(fresh, problem.options.yield);
  fresh.analysis.conf_level = problem.options.confidence;
  return fresh;
}

YieldVerdict verdict_of(const MachineLoads& fresh, double yield, double confidence) {
  const std::uint64_t machines = fresh.load.size();
  const std::uint64_t good = machines - rejects_of(fresh.load);
  const Estimate share = proportion(good, machines, confidence);
  YieldVerdict verdict{.decision = YieldVerdict::Decision::undecided,
                       .asked = yield,
                       .conf_level = confidence,
                       .value = share.value,
                       .ci_low = share.interval.low,
                       .ci_high = share.interval.high,
                       .machines = machines,
                       .rejects = machines - good,
                       .unsolved = fresh.unsolved,
                       .solves = total_of(fresh.solves)};
  if (proportion_at_least(good, machines, confidence) >= yield) verdict.decision = YieldVerdict::Decision::kept;
  if (proportion_at_most(good, machines, confidence) < yield) verdict.decision = YieldVerdict::Decision::not_kept;
  return verdict;
}

/// [parts] The share of each part in the mean square that all parts cause under a limit at a pose. limit: its row in
/// `limits`. The share of an orientation that the drawing does not need is added to that of its location.
std::vector<double> mean_square_shares(const ToleranceProgramme& programme, const TolerancePoint& point,
                                       const ToleranceLimits& limits, std::size_t limit) {
  const double need = limits.need(limit, point.tolerance);
  std::vector<double> shares;
  for (std::size_t i = 0; i < limits.parts; ++i) {
    shares.push_back(limits.row(limit)[i] * point.tolerance[i] * point.tolerance[i] / need);
  }
  for (const Within& pair : programme.pairs()) {
    if (!programme.is_void(point, pair.inner)) continue;
    shares[pair.outer] += shares[pair.inner];
    shares[pair.inner] = 0.0;
  }
  return shares;
}

/// Divides `of_parts`, the share of one or two parts in a mean square, among their errors, in proportion to variance x
/// slope. slopes: [errors] MeanSquares::slope under the limit. weights: the errors of the parts, each with a number
/// proportional to its variance. Writes the shares of these errors into `shares`.
void divide_share(std::span<const double> slopes, std::span<const ErrorFactor> weights, double of_parts,
                  Array<double, axis::Factor>& shares) {
  double sum = 0.0;
  for (const auto& [p, weight] : weights) sum += weight * slopes[p];
  for (const auto& [p, weight] : weights) {
    const double within = sum > 0.0 ? weight * slopes[p] / sum : 1.0 / static_cast<double>(weights.size());
    shares(p) = within * of_parts;
  }
}

/// Returns true if some limit depends on this part at these tolerances (SI): the part uses a share of the limit's room
/// that is larger than rounding.
bool has_effect(const ToleranceLimits& limits, std::span<const double> tolerance, std::size_t part) {
  constexpr double kRounding = 1e-12;  // a smaller share of the room is rounding
  for (std::size_t l = 0; l < limits.count(); ++l) {
    const double taken = limits.row(l)[part] * tolerance[part] * tolerance[part];
    if (std::abs(taken) > kRounding * std::max(limits.need(l, tolerance), limits.room[l])) return true;
  }
  return false;
}

/// The value of Result::bound for a part. An orientation that the drawing does not need is as wide as its location
/// allows, so a limit that depends on this orientation also depends on the location.
std::uint8_t bound_of(const ToleranceProgramme& programme, const TolerancePoint& point, const ToleranceLimits& limits,
                      std::size_t part) {
  const AtBound bound = programme.at_bound(point, part);
  bool decides = bound != AtBound::upper || has_effect(limits, point.tolerance, part);
  for (const Within& pair : programme.pairs()) {
    const bool is_as_wide = pair.outer == part && programme.is_void(point, pair.inner);
    decides = decides || (is_as_wide && has_effect(limits, point.tolerance, pair.inner));
  }
  return decides ? static_cast<std::uint8_t>(bound) : Result::kWithoutEffect;
}

/// Sets the members of a result that have a value for each part.
void add_parts(const SearchProblem& problem, const FoundTolerances& search, const ToleranceLimits& limits,
               Result& found) {
  const Study& study = problem.run.study;
  const ToleranceProgramme& programme = problem.programme;
  const TolerancePoint& point = search.design.candidate.point;
  const std::size_t errors = study.analysis.factors.size();
  const std::size_t parts = programme.size();
  found.error_mean_square_share = Array<double, axis::Factor>({errors}, kNaN);
  for (auto* numbers : {&found.tolerance, &found.sigma, &found.sigmas, &found.shift, &found.cost, &found.share,
                        &found.mean_square_share}) {
    *numbers = Result::Parts<double>({parts});
  }
  for (auto* texts : {&found.part_members, &found.part_unit, &found.chosen}) {
    *texts = Result::Parts<std::string>({parts});
  }
  found.bound = Result::Parts<std::uint8_t>({parts});
  const std::size_t tightest = worst_use(limits, point.tolerance).limit;
  const std::vector<double> shares = mean_square_shares(programme, point, limits, tightest);
  const auto slopes = std::span(search.linearisation.squares.slope).subspan(tightest * errors, errors);
  for (std::size_t i = 0; i < parts; ++i) {
    const AllocatedPart& part = programme.parts()[i];
    const Spread spread{part.sigmas, part.shift};
    const double tolerance = point.tolerance[i];
    std::string members;
    for (const FactorIndex factor : part.factors) {
      members += (members.empty() ? "" : " ") + study.model().factors[factor.value].name;
    }
    found.part_names.push_back(part.name);
    found.part_members(i) = std::move(members);
    found.part_unit(i) = si_unit(study.model().factors[part.factors.front().value].dimension);
    found.tolerance(i) = tolerance;
    found.sigma(i) = sigma_per_tolerance(spread) * tolerance;
    found.sigmas(i) = part.sigmas;
    found.shift(i) = part.shift * tolerance;
    found.cost(i) = std::isnan(point.cost) ? kNaN : programme.cost(point, i);
    found.share(i) = found.cost(i) / point.cost;
    found.mean_square_share(i) = shares[i];
    const auto [weights, parts_of_errors] = programme.weights(point, i);
    double of_errors = 0.0;
    for (const std::size_t one : parts_of_errors) of_errors += shares[one];
    divide_share(slopes, weights, of_errors, found.error_mean_square_share);
    found.bound(i) = bound_of(programme, point, limits, i);
    found.chosen(i) = programme.chosen_name(i, point.process[i]);
  }
  found.coarser_yield = {{parts}, search.coarser_yield};
}

/// The feature of a part, with the zones that the search found.
Feature found_feature(const ToleranceProgramme& programme, const TolerancePoint& point, std::size_t part,
                      const ModelDescription& model) {
  Feature feature = feature_of(programme.parts()[part], model);
  const bool turned = is_orientation(programme.parts()[part], model);
  (turned ? feature.orientation : feature.location)->size = point.tolerance[part];
  for (const Within& pair : programme.pairs()) {
    if (pair.outer == part) feature.orientation->size = point.tolerance[pair.inner];
    if (pair.inner == part) feature.location->size = point.tolerance[pair.outer];
  }
  return feature;
}

/// Sets the members of a result that describe tolerance zones.
void add_zones(const SearchProblem& problem, const TolerancePoint& point, Result& found) {
  const ModelDescription& model = problem.run.study.model();
  const std::vector<AllocatedPart>& parts = problem.programme.parts();
  if (std::ranges::none_of(parts, [](const AllocatedPart& part) { return part.zone.has_value(); })) return;
  const Study drawn = problem.programme.at(point.tolerance);
  for (auto* texts : {&found.zone_feature, &found.zone_limbs, &found.zone_key, &found.zone_shape, &found.zone_datums}) {
    *texts = Result::Parts<std::string>({parts.size()});
  }
  for (auto* numbers : {&found.zone_length, &found.zone_width, &found.zone_inside}) {
    *numbers = Result::Parts<double>({parts.size()}, kNaN);
  }
  found.zone_is_needed = Result::Parts<std::uint8_t>({parts.size()}, 1);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const AllocatedPart& part = parts[i];
    if (!part.zone) continue;
    const Feature feature = found_feature(problem.programme, point, i, model);
    found.zone_feature(i) = feature.label;
    found.zone_limbs(i) = limbs_of(part, model);
    found.zone_key(i) = part.zone->key;
    found.zone_shape(i) = shape_of(part, model);
    found.zone_datums(i) = zone_of(part, model).datums;
    if (feature.size[0] > 0.0) found.zone_length(i) = feature.size[0];
    if (feature.kind == FeatureKind::rectangle) found.zone_width(i) = feature.size[1];
    if (feature.kind == FeatureKind::round) found.zone_width(i) = 0.0;
    found.zone_inside(i) =
        drawing::share_inside(feature, zone_class(part.zone->key, feature.kind), part.sigmas, part.shift);
    found.zone_is_needed(i) = problem.programme.is_void(point, i) ? 0 : 1;
    found.sigma(i) = drawn.errors.by_factor[part.factors.front().value].standard_deviation();
    if (feature.kind == FeatureKind::distance)
      found.sigma(i) = sigma_per_tolerance({part.sigmas, part.shift}) * point.tolerance[i];
  }
}

/// Sets the shares of the machines near the limits that each limit decides at each pose, and what a wider limit saves.
/// If all limits are wider by 1 %, the least cost falls by as much as the programme of root mean squares says: `all`. A
/// single limit saves the part of `all` that is its share in the machines near the limits, because the yield changes in
/// proportion to the machines whose largest ratio of a response to its limit is that of the wider limit. The
/// multipliers of the programme do not say this: limits that nearly bind have the multiplier 0.
void add_savings(std::span<const ResponseLimit> stated, const MachineLoads& fresh, double all, Result& found) {
  const std::size_t poses = found.poses();
  const auto machines = static_cast<double>(std::accumulate(fresh.near.begin(), fresh.near.end(), std::uint64_t{0}));
  found.deciding_share = Result::AtPoses(found.limit_use.lengths(), kNaN);
  for (const ResponseLimit& one : stated) {
    if (stated.size() == 1 || all == 0.0) found.saving(one.response) = all;
  }
  if (machines == 0.0) return;
  for (std::size_t k = 0; k < stated.size(); ++k) {
    const std::span near = fresh.near.row(k);
    const std::span share = found.deciding_share.row(stated[k].response);
    for (std::size_t m = 0; m < poses; ++m) share[m] = static_cast<double>(near[m]) / machines;
    if (stated[k].allowed.is_over_poses()) std::ranges::fill(share, share[0] / static_cast<double>(poses));
    found.saving(stated[k].response) = all * found.decides(stated[k].response);
  }
}

/// Sets the members of a result that describe the limits.
void add_limits(const SearchProblem& problem, const FoundTolerances& search, const ToleranceLimits& limits,
                const MachineLoads& fresh, Result& found) {
  const Candidate& candidate = search.design.candidate;
  const MeanSquares& squares = search.linearisation.squares;
  const std::vector<ResponseLimit>& stated = problem.run.study.analysis.limits;
  const std::vector<double>& multiplier = candidate.chosen.multiplier;
  const std::size_t responses = problem.run.study.model().responses.size();
  const std::size_t poses = problem.run.poses.size();
  found.limit = found.saving = found.fixed_share = Array<double, axis::Response>({responses}, kNaN);
  found.multiplier = found.limit_use = Result::AtPoses({responses, poses}, kNaN);
  if (!std::ranges::all_of(stated, [](const ResponseLimit& one) { return one.allowed.is_magnitude(); })) {
    found.limit_from = found.limit_to = found.limit;
  }
  if (any_over_poses(stated)) found.limit_pose_share = found.limit_is_spread = found.limit;
  double all = multiplier.empty() ? kNaN : 0.0;  // cost saved if all limits are wider by 1 %
  for (std::size_t k = 0; k < stated.size(); ++k) {
    const std::size_t r = stated[k].response;
    if (!found.limit_from.empty()) {
      found.limit_from(r) = stated[k].allowed.from();
      found.limit_to(r) = stated[k].allowed.to();
    }
    if (!found.limit_pose_share.empty()) {
      found.limit_pose_share(r) = stated[k].allowed.share();
      found.limit_is_spread(r) = stated[k].allowed.is_spread() ? 1.0 : 0.0;
    }
    const std::span rooms = std::span(squares.room).subspan(k * poses, poses);
    const double least = *std::ranges::min_element(rooms);
    // The room of a limit on a spread is half the limit (RelativeLimits::room).
    const double limit_of_room = stated[k].allowed.is_spread() ? 2.0 : 1.0;
    found.limit(r) = limit_of_room * least;
    double sum = 0.0;
    double most_used = 0.0;
    for (std::size_t m = 0; m < poses; ++m) {
      const std::size_t row = k * poses + m;
      const double allowed = candidate.share * rooms[m];
      const double fixed = allowed * allowed - limits.room[row];  // mean square that no part causes
      const double square = fixed + limits.need(row, candidate.point.tolerance);
      found.limit_use(r, m) = std::sqrt(std::max(0.0, square)) / allowed;
      if (found.limit_use(r, m) > most_used) {
        most_used = found.limit_use(r, m);
        found.fixed_share(r) = std::max(0.0, fixed) / square;
      }
      if (multiplier.empty()) continue;
      // ChosenTolerances::multiplier is the cost saved per unit of ToleranceLimits::room. This room is (share x
      // limit)^2 minus the mean square that no part causes, so the chain rule gives the cost saved per unit of the
      // limit.
      found.multiplier(r, m) = multiplier[row] * 2.0 * candidate.share * allowed / limit_of_room;
      sum += found.multiplier(r, m) * (rooms[m] / least);
    }
    all += 0.01 * found.limit(r) * sum;
  }
  add_savings(stated, fresh, all, found);
}

/// Sets the predicted costs at other yields and with other limits. The prediction for other yields uses the loads
/// (MachineLoads) of the machines with which the tolerances were found.
void add_curves(const SearchProblem& problem, const FoundTolerances& search, Result& found) {
  const auto& [point, chosen, share] = search.design.candidate;
  if (std::isnan(point.cost)) return;
  const double confidence = problem.options.confidence;
  const double scale = point.cost / predicted_cost(problem, search, share, 1.0);
  std::vector<double> loads = search.design.load;
  std::ranges::sort(loads, std::ranges::greater());
  std::vector<double> costs;
  for (const double yield : kYields) {
    if (loads.size() < trials_without_failure(yield, confidence)) continue;
    const std::uint64_t rejects = allowed_rejects(yield, confidence, loads.size()).design;
    const double load = loads[rejects];
    if (rejects == 0 || !(load > 0.0) || std::isinf(load)) continue;  // too few machines, or too many not solved
    found.curve_yield.push_back(yield);
    costs.push_back(scale * predicted_cost(problem, search, share / load, 1.0));
  }
  found.curve_yield_cost = {{costs.size()}, costs};
  costs.clear();
  for (const double factor : kFactors) {
    found.curve_factor.push_back(factor);
    costs.push_back(scale * predicted_cost(problem, search, share, factor));
  }
  found.curve_factor_cost = {{costs.size()}, costs};
}

/// The result of a study whose search found these tolerances. fresh: the loads (MachineLoads) of the certificate's
/// machines.
Result result_of(const SearchProblem& problem, const FoundTolerances& search, const MachineLoads& fresh,
                 const Study& certificate) {
  const Study& study = problem.run.study;
  const Candidate& candidate = search.design.candidate;
  const ToleranceLimits limits = limits_of(problem, search);
  Result found;
  add_parts(problem, search, limits, found);
  add_zones(problem, candidate.point, found);
  add_limits(problem, search, limits, fresh, found);
  add_curves(problem, search, found);
  found.aim = problem.options.aim;
  found.calibrated = study.mechanism.calibrated;
  found.total_cost = candidate.point.cost;
  // The bound is NaN if the aim is not least_cost, or if the search ended with the lowest tolerances, which solve no
  // optimisation problem.
  found.lower_bound = candidate.chosen.lower_bound;
  found.gap = candidate.chosen.cost - candidate.chosen.lower_bound;
  found.wanted_yield = problem.options.yield;
  found.confidence = problem.options.confidence;
  found.stages = search.log.stages;
  found.stage_tolerance = {{found.stages.size(), found.parts()}, search.log.tolerance};
  found.design_machines = search.design.load.size();
  found.design_rejects = rejects_of(search.design.load);
  found.design_most = problem.allowed.design;
  found.certificate_seed = certificate.seed;
  found.certificate_most = problem.allowed.certificate;
  found.certificate = verdict_of(fresh, problem.options.yield, problem.options.confidence);
  found.certificate_study = resolved_text(certificate);
  found.solves = {{fresh.solves.size()}, fresh.solves};
  for (std::size_t m = 0; m < fresh.failed.size(); ++m)
    append_failures(0, PoseIndex(m), fresh.failed[m], found.failures);
  return found;
}

LimitVerdicts verdicts_of(const Study& study, const MachineLoads& fresh, const YieldVerdict& certificate) {
  LimitVerdicts verdicts{.judge = Judge::yield, .limits = {}, .yield = certificate};
  for (std::size_t k = 0; k < study.analysis.limits.size(); ++k) {
    const ResponseLimit& limit = study.analysis.limits[k];
    const std::uint64_t within = certificate.machines - fresh.beyond[k];
    const double share = static_cast<double>(within) / static_cast<double>(certificate.machines);
    verdicts.limits.push_back({.response = limit.response,
                               .limit = limit.allowed,
                               .value = kNaN,
                               .passed = share >= certificate.asked,
                               .tried = certificate.machines,
                               .within = within});
  }
  return verdicts;
}

std::optional<StudyResult> run_study_of_kind(const StudyRun& run) {
  const SearchProblem problem(run);
  const auto search = find_tolerances(problem);
  if (!search) return std::nullopt;
  const Study certificate = certificate_study(problem, search->design.candidate.point.tolerance);
  const auto fresh = machine_loads(Plan(certificate, run.poses), run.model, certificate.analysis.limits, run.options,
                                   problem.calibration_of(certificate).get());
  if (!fresh || !run.makes_result()) return std::nullopt;
  Result found = result_of(problem, *search, *fresh, certificate);
  LimitVerdicts verdicts = verdicts_of(run.study, *fresh, found.certificate);
  return StudyResult{std::move(found), std::move(verdicts), {}, certificate};
}

/// An estimate of how many times a search tries all machines, including the certificate.
constexpr double kTrials = 5.0;

/// The expected work of a search with calibrated machines. To measure the time for a machine, a few machines are
/// solved.
WorkOutlook trying_calibrated(const std::shared_ptr<const Plan>& plan, const Model& model, const Study& study,
                              const std::shared_ptr<const MachineCalibration>& calibration) {
  return {[plan, &model, &study, calibration](double) {
            const Plan few = plan->with_samples(std::min<std::size_t>(plan->samples(), 20));
            static_cast<void>(machine_loads(few, model, study.analysis.limits, {.threads = 1}, calibration.get()));
            return static_cast<double>(few.samples()) / static_cast<double>(plan->samples());
          },
          kTrials};
}

Outlook allocation_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const auto plan = std::make_shared<const Plan>(study, poses);
  const auto calibration = machine_calibration(study, model, poses);
  constexpr double kMeasurements = 6.0;
  const double effects =
      kMeasurements * static_cast<double>(mean_square_solves(*plan, calibration ? 0 : kDrawsAmongOthers));
  const double machines = kTrials * static_cast<double>(plan->solves());
  const std::size_t errors = plan->factors().size();
  const std::size_t rows = study.analysis.limits.size() * poses.size();
  const std::size_t loads = plan->samples() * sizeof(double);
  const std::size_t squares = 3 * rows * errors * sizeof(double);
  // How many numbers a result stores for a pose: limit_use and multiplier of each response, the coordinates of the
  // pose, and its condition number.
  const std::size_t of_pose = 2 * study.model().responses.size() + study.model().pose_coordinates.size() + 1;
  const std::size_t numbers = poses.size() * of_pose * sizeof(double);
  // Bytes in the result file for a part: its numbers and names, and its text in the study of the certificate.
  constexpr std::size_t kPart = 400;
  const std::size_t parts = kPart * asked_of<Options>(study.analysis).parts.size();
  const std::size_t file = numbers + poses.size() * kSolverColumns + parts;
  return {
      .solves = fmt::format("about {:.0f} x {} x {} machines and {:.2g} for the effects of {}: {:.2g} solves", kTrials,
                            counted_things(poses.size(), "poses"), plan->samples(), effects,
                            counted_things(errors, "errors"), machines + effects) +
                (calibration ? calibration_cost_text(*calibration, "machine") : ""),
      .memory = {4 * loads + 2 * squares, 4 * loads + 3 * squares, numbers, file},
      .shared = {calibration
                     ? trying_calibrated(plan, model, study, std::make_shared<const MachineCalibration>(*calibration))
                     : sampling<PoseUnitEvaluator>(plan, borrowed(model),
                                                   (machines + effects) / static_cast<double>(plan->solves()))},
      .by_one = {},
      .least = 1.0};
}

}  // namespace
}  // namespace poesy::allocation

namespace poesy::allocation {

constinit const Kind kKind{.study = kStudy,
                           .run = {allocation::run_study_of_kind, allocation::allocation_outlook, nullptr, true},
                           .file = kFile,
                           .report = kReport};

}  // namespace poesy::allocation
