#include "engine/kinds/allocation/search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "engine/base/nan.h"
#include "engine/random/stream.h"
#include "engine/stats/proportion.h"

namespace poesy {
namespace {

/// Errors are so much smaller than usual where effects are taken as linear.
constexpr double kLinear = 0.01;
/// Tolerances grow at most so much between two measurements of what errors do.
constexpr double kGrowth = 4.0;
constexpr std::size_t kMostRounds = 6;
/// The cost settles when it moves by less than this share.
constexpr double kSettled = 1e-3;
/// Loads of the machines that decide are as near to 1 as this.
constexpr double kFine = 2e-3;
constexpr std::size_t kMostTrials = 12;
/// The same where nothing is left to improve.
constexpr double kExact = 1e-5;
/// Machines below this share of the load that decides do not come to decide while tolerances change a little.
constexpr double kNear = 0.75;
/// Of all machines so many are tried first.
constexpr std::size_t kFirstOf = 8;
/// So many are tried in any case, to find some that were left out.
constexpr std::size_t kFewMachines = 20'000;
/// Where limits on root mean squares had to fall so far, something decides that these do not see.
constexpr double kFarBelow = 0.7;
/// From here on effects are measured again, and all machines tried.
constexpr double kFar = 0.1;
/// So many machines of largest load, at the most, tell the direction of the gradient.
constexpr std::size_t kMostOfGradient = 3000;
/// A score is no noise from so many of its standard deviations on.
constexpr double kSureScore = 3.0;
constexpr std::size_t kMostFits = 6;
constexpr std::size_t kMostGradients = 3;
/// How far one step by the gradient may go, and what it must save.
constexpr double kGradientGrowth = 1.3;
constexpr double kWorthIt = 1e-4;

/// The standard normal's two-sided quantile: |z| is below it in a share `yield` of all draws.
double normal_bound(double yield) { return normal_quantile(1.0, 0.5 + 0.5 * yield); }

/// What a response's limit would have to be for so many rejects: the largest load but `most`.
double deciding_load(std::vector<double> load, std::uint64_t most) {
  const auto at = load.begin() + static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(most, load.size() - 1));
  std::ranges::nth_element(load, at, std::ranges::greater());
  return *at;
}

/// The load of the machine before that one; infinite where no reject is allowed.
double load_before_deciding(const std::vector<double>& load, std::uint64_t most) {
  return most == 0 ? std::numeric_limits<double>::infinity() : deciding_load(load, most - 1);
}

/// By what all tolerances are multiplied so that the machine which decides comes to the limit, just within, and the one
/// before it remains beyond, however near to each other they are.
double factor_to_limit(double deciding, double before) {
  constexpr double kWithin = 1.0 + 0.5 * kExact;
  const double between = before > deciding && std::isfinite(before) ? std::sqrt(before / deciding) : kWithin;
  return 1.0 / std::clamp(deciding * std::min(between, kWithin), 0.5, 2.0);
}

double largest_ratio(std::span<const double> a, std::span<const double> b) {
  double largest = 1.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b[i]) largest = std::max({largest, a[i] / b[i], b[i] / a[i]});
  }
  return largest;
}

/// Whether no part has to be perfect.
bool can_be_made(const TolerancePoint& point) {
  return std::ranges::find(point.tolerance, 0.0) == point.tolerance.end();
}

}  // namespace

AllowedRejects allowed_rejects(double yield, double confidence, std::uint64_t machines) {
  const auto holds = [&](std::uint64_t rejects) {
    return proportion_at_least(machines - rejects, machines, confidence) >= yield;
  };
  std::uint64_t low = 0;  // holds
  std::uint64_t high = machines;
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    (holds(middle) ? low : high) = middle;
  }
  // The largest d with d + z sqrt(2 d) <= low, for the scatter of both numbers.
  const double half = 0.5 * normal_quantile(1.0, 0.99) * std::sqrt(2.0);
  const double root = std::sqrt(half * half + static_cast<double>(low)) - half;
  return {low, static_cast<std::uint64_t>(root * root)};
}

std::uint64_t seed_of_others(const Study& study, SampleIndex set) {
  const StreamAddress address{study.seed, Purpose::seed_of_others, FactorIndex(0), PoseIndex(0)};
  return random_bits(address, set) >> 1U;  // a study file holds signed numbers
}

ToleranceSearch::ToleranceSearch(const StudyRun& run)
    : run_(run),
      asked_(asked_of<AllocationOptions>(run.study.analysis)),
      programme_(run.study, run.model),
      allowed_(allowed_rejects(asked_.yield, asked_.confidence, run.study.analysis.samples)),
      seed_(run.study.seed),
      share_(1.0 / normal_bound(asked_.yield)),
      coarser_yield_(programme_.size(), kNaN) {}

bool ToleranceSearch::measure(std::span<const double> tolerance, std::size_t draws) {
  const Study study = programme_.at(tolerance);
  auto squares = mean_squares(Plan(study, run_.poses), run_.model, study.analysis.limits, draws, run_.options);
  if (!squares) return false;
  squares_ = *std::move(squares);
  measured_.assign(tolerance.begin(), tolerance.end());
  return true;
}

/// Whether the limits of this share can be kept on root mean squares; then chosen_ and found_ keep them.
bool ToleranceSearch::choose(const TrustRegion& region) {
  ToleranceLimits limits = programme_.limits(squares_, measured_, share_);
  const ChoiceOfTolerances choice = programme_.choose(limits, region);
  if (const auto* endless = std::get_if<Unbounded>(&choice)) refuse_endless(*endless);
  if (std::holds_alternative<Infeasible>(choice)) return false;
  limits_ = std::move(limits);
  chosen_ = std::get<ChosenTolerances>(choice);
  found_ = chosen_;
  return true;
}

/// The same by the least share between these with which they can be kept, to a thousandth.
bool ToleranceSearch::choose_by_least_share(double low, double high, const TrustRegion& region) {
  while (high > 1.001 * low) {
    share_ = std::sqrt(low * high);
    (choose(region) ? high : low) = share_;
  }
  share_ = high;
  return choose(region);
}

void ToleranceSearch::add_stage(std::string name, std::uint64_t machines, std::uint64_t rejects) {
  const bool by_programme = found_.tolerance == chosen_.tolerance;
  stages_.push_back(
      {std::move(name), found_.cost, by_programme ? chosen_.lower_bound : kNaN, share_, machines, rejects});
  stage_tolerance_.insert(stage_tolerance_.end(), found_.tolerance.begin(), found_.tolerance.end());
}

/// Tolerances as if every effect were linear. Where root mean squares cannot be as small as a normal response needs
/// for the yield, they are as small as can be.
bool ToleranceSearch::linearise() {
  const std::vector<double> usual = programme_.usual();
  std::vector<double> small = usual;
  for (double& tolerance : small) tolerance *= kLinear;
  if (!measure(small, 0)) return false;
  if (!choose({})) {
    const ChoiceOfTolerances whole = programme_.choose(programme_.limits(squares_, measured_, 1.0), {});
    if (const auto* broken = std::get_if<Infeasible>(&whole)) refuse(*broken);
    choose_by_least_share(share_, 1.0, {});
  }
  add_stage("linear", 0, 0);
  // An error that does nothing alone may act among others, and is as large as usual until this is known.
  for (std::size_t i = 0; i < programme_.size(); ++i) {
    bool acts = false;
    for (std::size_t l = 0; l < limits_.count(); ++l) acts = acts || limits_.row(l)[i] > 0.0;
    if (!acts) found_.tolerance[i] = std::min(found_.tolerance[i], usual[i]);
  }
  return true;
}

/// Measures effects at the tolerances and chooses tolerances by them, until these stay.
bool ToleranceSearch::settle_effects() {
  for (std::size_t round = 0; round < kMostRounds; ++round) {
    const TolerancePoint before = found_;
    if (!measure(before.tolerance, kDrawsAmongOthers)) return false;
    if (!choose({before.tolerance, kGrowth})) {
      found_ = programme_.lowest();  // machines will tell whether these keep the limits
      settled_ = {before, chosen_, share_};
      return true;
    }
    const bool cost_stays = !(std::abs(found_.cost - before.cost) > kSettled * std::abs(found_.cost));
    if (cost_stays && largest_ratio(found_.tolerance, before.tolerance) < 1.0 + 10.0 * kSettled) break;
  }
  add_stage("effects among the others", 0, 0);
  settled_ = {found_, chosen_, share_};
  return true;
}

Study ToleranceSearch::tried_at(std::span<const double> tolerance) const {
  Study study = programme_.at(tolerance);
  study.seed = seed_;
  return study;
}

std::optional<Trial> ToleranceSearch::try_all() const {
  const Study study = tried_at(found_.tolerance);
  return try_machines(Plan(study, run_.poses), run_.model, study.analysis.limits, run_.options);
}

std::optional<ToleranceSearch::Tried> ToleranceSearch::try_some(const TolerancePoint& point,
                                                                std::vector<std::uint32_t> machines) const {
  const Study study = tried_at(point.tolerance);
  auto trial = try_machines(Plan(study, run_.poses), run_.model, study.analysis.limits, machines, run_.options);
  if (!trial) return std::nullopt;
  return Tried{std::move(machines), *std::move(trial)};
}

/// Those machines that may decide: of all, when they were tried last, those with a load of kNear or more of the one
/// that decided.
std::vector<std::uint32_t> ToleranceSearch::near_machines() const {
  const double least = kNear * deciding_load(trial_.load, allowed_.design);
  std::vector<std::uint32_t> machines;
  for (std::size_t s = 0; s < trial_.load.size(); ++s) {
    if (trial_.load[s] >= least) machines.push_back(static_cast<std::uint32_t>(s));
  }
  return machines;
}

std::optional<ToleranceSearch::Tried> ToleranceSearch::try_near(const TolerancePoint& point) const {
  return try_some(point, near_machines());
}

/// Tries all machines at found_, and takes those of them that may decide. False when stopped.
bool ToleranceSearch::try_found() {
  auto all = try_all();
  if (!all) return false;
  trial_ = *std::move(all);
  near_ = {near_machines(), {}};
  for (const std::uint32_t machine : near_.machines) near_.trial.load.push_back(trial_.load[machine]);
  return true;
}

void ToleranceSearch::take(const Programmed& of) {
  found_ = of.point;
  chosen_ = of.chosen;
  share_ = of.share;
  limits_ = programme_.limits(squares_, measured_, share_);
}

/// Makes tolerances finer, where limits on root mean squares do not lead to the yield: a few machines decide that these
/// do not see, such as those of an error that does nothing until it is large. Parts whose errors are larger in these
/// machines than in others are made finer, or all where there are none. Whether that met the yield; none when stopped.
std::optional<bool> ToleranceSearch::lower_what_rejects() {
  take(settled_);
  for (std::size_t trial = 0; trial < kMostTrials; ++trial) {
    if (!try_found()) return std::nullopt;
    const double load = deciding_load(trial_.load, allowed_.design);
    if (load <= 1.0) {
      if (!scale_near(none_stays())) return std::nullopt;
      add_stage("finer where machines fail", trial_.load.size(), near_.trial.rejects());
      return true;
    }
    const std::vector<bool> acts = rejecting_parts();
    const bool none = std::ranges::find(acts, true) == acts.end();
    std::vector<double> finer = found_.tolerance;
    for (std::size_t i = 0; i < finer.size(); ++i) {
      if (none || acts[i]) finer[i] /= std::clamp(load, 1.05, 2.0);
    }
    const TolerancePoint next = programme_.at_most(finer);
    if (next.tolerance == found_.tolerance) break;
    found_ = next;
  }
  return false;
}

/// Tries the lowest tolerances, after which nothing is left to try. False when stopped.
bool ToleranceSearch::lower_to_least() {
  found_ = programme_.lowest();
  auto trial = try_all();
  if (!trial) return false;
  const std::uint64_t before = trial_.rejects();
  trial_ = *std::move(trial);
  if (trial_.rejects() > allowed_.design) refuse_lowest();
  if (!can_be_made(found_)) refuse_unbounded(before);
  near_ = {};
  chosen_ = {found_, kNaN, {}};  // by no programme
  add_stage("the lowest tolerances", trial_.load.size(), trial_.rejects());
  return true;
}

/// Scales the limits on root mean squares by this load of the machine that decides, and chooses tolerances by them.
/// Where none keep limits that are so much smaller, because the other errors alone do not, by limits as small as can be
/// kept. Nothing where there are none, or they stay as they are.
bool ToleranceSearch::rescale(double load) {
  const TolerancePoint before = found_;
  const double share = share_;
  const TrustRegion region{before.tolerance, kGrowth};
  share_ /= std::clamp(load * (1.0 + 0.25 * kFine), 0.25, 4.0);
  if (choose(region)) return load > 1.0 || found_.tolerance != before.tolerance;
  if (load > 1.0 && choose_by_least_share(share_, share, region)) return found_.tolerance != before.tolerance;
  found_ = before;
  return false;
}

/// Comes near the yield with some of the machines, and measures effects again where tolerances have changed much.
bool ToleranceSearch::come_near() {
  const std::size_t machines = std::max<std::size_t>(trial_machines() / kFirstOf, 1);
  for (std::size_t trial = 0; trial < kMostTrials; ++trial) {
    const Study study = tried_at(found_.tolerance);
    const Plan plan = Plan(study, run_.poses).with_samples(machines);
    const auto first = try_machines(plan, run_.model, study.analysis.limits, run_.options);
    if (!first) return false;
    if (trial == 0) add_stage("tried on machines", machines, first->rejects());
    const double load = deciding_load(first->load, allowed_.design / kFirstOf);
    if (std::abs(std::log(load)) < kFar) break;
    const ChosenTolerances before = chosen_;
    if (!rescale(load)) {
      found_ = before;
      if (load > 1.0) found_ = programme_.lowest();
      break;
    }
    if (largest_ratio(found_.tolerance, measured_) < 1.0 + kFar) continue;
    const std::vector<double> at = found_.tolerance;
    if (!measure(at, kDrawsAmongOthers)) return false;
    if (!choose({at, kGrowth})) found_ = programme_.lowest();
  }
  return true;
}

/// Scales the limits on root mean squares until the design has as many rejects as it may, and no more.
bool ToleranceSearch::meet_yield() {
  if (!come_near()) return false;
  auto all = try_all();
  if (!all) return false;
  trial_ = *std::move(all);
  std::optional<Programmed> best;
  double load = deciding_load(trial_.load, allowed_.design);
  for (std::size_t trial = 0; trial < kMostTrials; ++trial) {
    if (load <= 1.0 && can_be_made(found_) && (!best || share_ > best->share)) best = {found_, chosen_, share_};
    if (load <= 1.0 && load >= 1.0 - kFine) break;
    if (!rescale(load)) break;
    const auto near = try_near(found_);
    if (!near) return false;
    load = deciding_load(near->trial.load, allowed_.design);
  }
  if (!best || best->share < kFarBelow * settled_.share) {
    const std::optional<bool> met = lower_what_rejects();
    if (!met) return false;
    if (*met && (!best || found_.cost < best->point.cost)) return true;
    if (!best) return lower_to_least();
    found_ = best->point;
    all = try_all();
    if (!all) return false;
    trial_ = *std::move(all);
  }
  take(*best);
  auto near = try_near(found_);
  if (!near) return false;
  near_ = *std::move(near);
  add_stage("scaled to the yield", trial_.load.size(), near_.trial.rejects());
  return true;
}

/// [N] What each part's tolerance takes of the limits, at their prices: the shares that root mean squares give it.
std::vector<double> ToleranceSearch::shares_by_price() const {
  std::vector<double> shares(programme_.size(), 0.0);
  for (std::size_t l = 0; l < limits_.count(); ++l) {
    const double price = chosen_.multiplier[l];
    if (price == 0.0) continue;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      shares[i] += price * limits_.row(l)[i] * found_.tolerance[i] * found_.tolerance[i];
    }
  }
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share = sum > 0.0 ? share / sum : 1.0 / static_cast<double>(shares.size());
  return shares;
}

/// The machines of largest load that tell the direction of the gradient.
std::vector<std::uint32_t> ToleranceSearch::machines_of_largest_load() const {
  const std::size_t wanted =
      std::min(near_.machines.size(),
               std::max<std::size_t>(allowed_.design, std::min<std::size_t>(kMostOfGradient, trial_.load.size() / 30)));
  const double least = deciding_load(near_.trial.load, wanted);
  std::vector<std::uint32_t> machines;
  for (std::size_t k = 0; k < near_.machines.size(); ++k) {
    if (near_.trial.load[k] > least) machines.push_back(near_.machines[k]);
  }
  return machines;
}

/// [N] Sums of the errors' scores x^2 - 1 over these machines, at found_.
ToleranceSearch::Scores ToleranceSearch::scores(std::span<const std::uint32_t> machines) const {
  const Plan plan(tried_at(found_.tolerance), run_.poses);
  std::vector<double> of_error(plan.factors().size(), 0.0);
  std::vector<double> draws(plan.factors().size());
  Scores found{.of_part = {}, .machines = static_cast<double>(machines.size())};
  for (const std::uint32_t machine : machines) {
    for (std::size_t p = 0; p < draws.size(); ++p) {
      fill_uniforms(plan.address(p, PoseIndex(0)), SampleIndex(machine), std::span(&draws[p], 1));
    }
    plan.transform(draws, 1);
    for (std::size_t p = 0; p < draws.size(); ++p) {
      const double x = draws[p] / plan.distributions()[p].standard_deviation();
      of_error[p] += x * x - 1.0;
    }
  }
  for (std::size_t i = 0; i < programme_.size(); ++i) {
    double sum = 0.0;
    for (const std::size_t p : programme_.errors(i)) sum += of_error[p];
    found.of_part.push_back(sum);
  }
  return found;
}

/// Whether a part's score is more than noise: that of each of its errors has a variance of 2 in a machine.
bool ToleranceSearch::is_sure(const Scores& of, std::size_t part) const {
  const double noise = std::sqrt(2.0 * of.machines * static_cast<double>(programme_.errors(part).size()));
  return of.of_part[part] > kSureScore * noise;
}

/// [N] Parts whose errors are larger in rejected machines than in others.
std::vector<bool> ToleranceSearch::rejecting_parts() const {
  std::vector<std::uint32_t> rejected;
  for (std::size_t s = 0; s < trial_.load.size(); ++s) {
    if (trial_.load[s] > 1.0) rejected.push_back(static_cast<std::uint32_t>(s));
  }
  const Scores found = scores(rejected);
  std::vector<bool> parts;
  for (std::size_t i = 0; i < programme_.size(); ++i) parts.push_back(is_sure(found, i));
  return parts;
}

/// One limit in place of all: what each part adds to the machines of largest load, by its score among them; where that
/// is noise, by the share that root mean squares give it.
ToleranceLimits ToleranceSearch::gradient_limits() const {
  const Scores found = scores(machines_of_largest_load());
  const std::vector<double> shares = shares_by_price();
  double all = 0.0;
  for (const double score : found.of_part) all += std::max(0.0, score);
  ToleranceLimits direction{
      .stacking = Stacking::root_sum_square, .parts = programme_.size(), .effects = {}, .room = {1.0}};
  for (std::size_t i = 0; i < programme_.size(); ++i) {
    const bool is_known = is_sure(found, i);
    const double size = found_.tolerance[i] * found_.tolerance[i];
    const double weight = (is_known ? found.of_part[i] : all * shares[i]) / all;
    direction.effects.push_back(size > 0.0 ? weight / size : 0.0);
  }
  direction.room.front() = direction.need(0, found_.tolerance);
  return direction;
}

/// Takes the tolerances that this limit gives, scaled to the yield, where they cost less; none when stopped.
std::optional<bool> ToleranceSearch::fit_gradient(ToleranceLimits direction) {
  for (std::size_t trial = 0; trial < kMostFits; ++trial) {
    const ChoiceOfTolerances choice = programme_.choose(direction, {found_.tolerance, kGradientGrowth});
    const auto* chosen = std::get_if<ChosenTolerances>(&choice);
    if (chosen == nullptr) return false;
    auto near = try_near(*chosen);
    if (!near) return std::nullopt;
    const double load = deciding_load(near->trial.load, allowed_.design);
    if (load <= 1.0 && chosen->cost < (1.0 - kWorthIt) * found_.cost) {
      found_ = *chosen;
      near_ = *std::move(near);
      return true;
    }
    if (load <= 1.0 && load >= 1.0 - kFine) return false;
    if (!std::isfinite(load)) return false;
    direction.room.front() /= load * load * (1.0 + 0.25 * kFine);
  }
  return false;
}

bool ToleranceSearch::improve_by_gradient() {
  if (asked_.aim != Aim::least_cost || programme_.size() < 2) return true;
  bool better = false;
  for (std::size_t round = 0; round < kMostGradients; ++round) {
    const std::optional<bool> fitted = fit_gradient(gradient_limits());
    if (!fitted) return false;
    if (!*fitted) break;
    better = true;
  }
  if (better) add_stage("by the gradient of the yield", trial_.load.size(), near_.trial.rejects());
  return true;
}

/// Takes all tolerances times one factor, but for those that stay [N], so that the machines near the limit use up what
/// the design allows. Where not even the lowest tolerances hold among them, which held among others, it
/// leaves all as they are: the certificate decides. Precondition: near_ was tried at found_.
bool ToleranceSearch::scale_near(const std::vector<bool>& stays) {
  const TolerancePoint before = found_;
  const Tried near_before = near_;
  double low = 0.0;  // a factor that holds
  double high = std::numeric_limits<double>::infinity();
  double factor = 1.0;
  double load = deciding_load(near_.trial.load, allowed_.design);
  double load_before = load_before_deciding(near_.trial.load, allowed_.design);
  for (std::size_t trial = 0; trial < kMostTrials; ++trial) {
    (load <= 1.0 ? low : high) = factor;
    if (load <= 1.0 && load >= 1.0 - kExact && load_before > 1.0) break;
    factor *= factor_to_limit(load, load_before);
    if (factor <= low || factor >= high) factor = std::sqrt(low * high);
    if (factor <= low || factor >= high) break;
    std::vector<double> wanted = before.tolerance;
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] *= stays[i] ? 1.0 : factor;
    const TolerancePoint next = programme_.at_most(wanted);
    if (next.tolerance == found_.tolerance) break;
    auto near = try_near(next);
    if (!near) return false;
    load = deciding_load(near->trial.load, allowed_.design);
    load_before = load_before_deciding(near->trial.load, allowed_.design);
    if (load > 1.0 || (low > 0.0 && next.cost > found_.cost)) continue;
    found_ = next;
    near_ = *std::move(near);
  }
  if (low > 0.0) return true;
  found_ = before;
  near_ = near_before;
  return true;
}

/// Whether machines are rejects that were left out as far from the limit, by some of all machines.
std::optional<bool> ToleranceSearch::left_out() const {
  const Study study = tried_at(found_.tolerance);
  const std::size_t machines = std::max(trial_machines() / kFirstOf, std::min(trial_machines(), kFewMachines));
  const Plan plan = Plan(study, run_.poses).with_samples(machines);
  const auto some = try_machines(plan, run_.model, study.analysis.limits, run_.options);
  if (!some) return std::nullopt;
  for (std::size_t s = 0; s < some->load.size(); ++s) {
    if (some->load[s] > 1.0 && !std::ranges::binary_search(near_.machines, s)) return true;
  }
  return false;
}

/// Scales all tolerances once more, to machines that nothing chose by: those by which the shares of the parts were
/// chosen make them look better than they are.
bool ToleranceSearch::scale_to_others() {
  seed_ = seed_of_others(run_.study, SampleIndex(1));
  for (std::size_t trial = 0; trial < kMostTrials; ++trial) {
    const std::vector<double> at = found_.tolerance;
    if (!try_found() || !scale_near(none_stays())) return false;
    const double moved = largest_ratio(found_.tolerance, at);
    for (std::size_t k = 0; k < near_.machines.size(); ++k) trial_.load[near_.machines[k]] = near_.trial.load[k];
    const std::optional<bool> again = left_out();
    if (!again) return false;
    if (!*again && moved < 1.0 + kFar) break;
  }
  add_stage("scaled to other machines", trial_.load.size(), trial_.rejects());
  return true;
}

bool ToleranceSearch::find() {
  if (!linearise() || !settle_effects() || !meet_yield()) return false;
  if (near_.machines.empty()) return true;  // the lowest tolerances: nothing is left to choose
  return improve_by_gradient() && scale_to_others() && leave_none_idle();
}

double ToleranceSearch::cost_at(double share, double wider) const {
  const ChoiceOfTolerances choice =
      programme_.choose(programme_.limits(squares_, measured_, share, wider), {found_.tolerance, kGrowth});
  const auto* chosen = std::get_if<ChosenTolerances>(&choice);
  return chosen == nullptr ? kNaN : chosen->cost;
}

}  // namespace poesy
