// The last stage of the search: what one coarser part does, and parts that may be coarser.

#include <algorithm>
#include <numeric>

#include "engine/base/nan.h"
#include "engine/kinds/allocation/search.h"

namespace poesy {
namespace {

/// How much coarser a part is made to see what it does.
constexpr double kCoarser = 1.05;
/// So many machines near the limit tell it; more of them of a part whose errors move loads by less than kSmall.
constexpr std::size_t kTelling = 700;
constexpr std::size_t kTellingOfSmall = 3000;
constexpr double kSmall = 0.01;
/// The first step of a part that may be coarser; each further step is the square of the one before.
constexpr double kFirstStep = 1.25;
constexpr std::size_t kMostSteps = 12;
constexpr std::size_t kMostRounds = 3;

}  // namespace

/// Finds what each of these parts would do if it alone were coarser. Many machines tell it of a part that hardly
/// changes loads, each with its mirror; fewer of any other part. A step to the next value that can be had may be large,
/// and few machines come that far: the rejects of a small step are taken, in the ratio of the growth of T^2.
bool ToleranceSearch::try_coarser(std::span<const std::size_t> parts) {
  const NearLimit few(near_.machines, near_.trial.load, kTelling);
  std::vector<CoarserPart> coarser;
  std::vector<Variation> variations;
  for (const std::size_t i : parts) {
    coarser_yield_[i] = kNaN;
    const auto next = programme_.coarser(found_, i, kCoarser);
    if (!next) continue;
    const double whole = next->tolerance[i] / found_.tolerance[i];
    const double step = std::min(whole, kCoarser);
    coarser.push_back({i, step, (whole * whole - 1.0) / (step * step - 1.0)});
    variations.push_back(varied(i, step));
  }
  const auto loads = try_varied(few, variations);
  if (!loads) return false;
  std::vector<CoarserPart> small;
  for (std::size_t v = 0; v < coarser.size(); ++v) {
    const auto with_part = few.of_variation(*loads, v);
    if (few.change(with_part) < kSmall * (coarser[v].step - 1.0)) small.push_back(coarser[v]);
    set_coarser_yield(coarser[v], few.rejects_to_come(with_part));
  }
  return try_small(small);
}

/// The same for parts that hardly change loads.
bool ToleranceSearch::try_small(std::span<const CoarserPart> parts) {
  const NearLimit many(near_.machines, near_.trial.load, kTellingOfSmall);
  std::vector<Variation> variations;
  for (const CoarserPart& one : parts) {
    for (const double factor : {one.step, -1.0, -one.step}) variations.push_back(varied(one.part, factor));
  }
  const auto loads = try_varied(many, variations);
  if (!loads) return false;
  for (std::size_t v = 0; v < parts.size(); ++v) {
    const auto of = [&](std::size_t variation) { return many.of_variation(*loads, 3 * v + variation); };
    set_coarser_yield(parts[v], many.rejects_to_come(of(0), of(1), of(2)));
  }
  return true;
}

Variation ToleranceSearch::varied(std::size_t part, double factor) const {
  const auto errors = programme_.errors(part);
  return {{errors.begin(), errors.end()}, factor};
}

std::optional<std::vector<double>> ToleranceSearch::try_varied(const NearLimit& near,
                                                               std::span<const Variation> variations) const {
  const Study study = tried_at(found_.tolerance);
  return try_variations(Plan(study, run_.poses), run_.model, study.analysis.limits, near.machines(), variations,
                        run_.options);
}

/// come: rejects that the step of this part adds
void ToleranceSearch::set_coarser_yield(const CoarserPart& of, double come) {
  const double rejects = static_cast<double>(near_.trial.rejects()) + of.steps * come;
  coarser_yield_[of.part] = std::clamp(1.0 - rejects / static_cast<double>(trial_.load.size()), 0.0, 1.0);
}

/// Those of these parts that could be coarser alone and the design would still have no more rejects than it may, to
/// save costs. Of parts that together would use up more than is left those of the least effect.
std::vector<std::size_t> ToleranceSearch::idle_parts(std::span<const std::size_t> parts) const {
  if (asked_.aim != Aim::least_cost) return {};
  const double count = static_cast<double>(trial_.load.size());
  const double least_yield = 1.0 - static_cast<double>(allowed_.design) / count;
  std::vector<std::size_t> idle;
  for (const std::size_t i : parts) {
    const auto next = programme_.coarser(found_, i, kCoarser);
    if (next && next->cost < found_.cost && coarser_yield_[i] >= least_yield) idle.push_back(i);
  }
  std::ranges::stable_sort(idle, std::ranges::greater(), [&](std::size_t i) { return coarser_yield_[i]; });
  const double yield = 1.0 - static_cast<double>(near_.trial.rejects()) / count;
  double left = yield - least_yield;
  std::size_t taken = 0;
  while (taken < idle.size() && (left -= yield - coarser_yield_[idle[taken]]) >= 0.0) ++taken;
  idle.resize(std::min(idle.size(), std::max<std::size_t>(taken, 1)));
  return idle;
}

/// Makes these parts coarser by steps that grow, until each would break the yield or can be no coarser; the others are
/// scaled to what that leaves. Whether that costs less, and keeps the yield; else all stays as it was. None when
/// stopped.
std::optional<bool> ToleranceSearch::loosen(std::vector<std::size_t> idle) {
  const TolerancePoint point = found_;
  const Tried near = near_;
  const std::vector<double> coarser_yield = coarser_yield_;
  std::vector<bool> stays(programme_.size(), false);
  double step = kFirstStep;
  for (std::size_t round = 0; round < kMostSteps && !idle.empty(); ++round, step *= step) {
    for (const std::size_t i : idle) {
      if (auto next = programme_.coarser(found_, i, step)) found_ = *std::move(next);
      stays[i] = true;
    }
    auto tried = try_near(found_);
    if (!tried) return std::nullopt;
    near_ = *std::move(tried);
    if (!try_coarser(idle)) return std::nullopt;
    idle = idle_parts(idle);
  }
  if (!scale_near(stays)) return std::nullopt;
  if (near_.trial.rejects() <= allowed_.design && found_.cost < point.cost) {
    const std::optional<bool> others = left_out();
    if (!others) return std::nullopt;
    if (!*others) {
      for (std::size_t k = 0; k < near_.machines.size(); ++k) trial_.load[near_.machines[k]] = near_.trial.load[k];
      return true;
    }
  }
  found_ = point;
  near_ = near;
  coarser_yield_ = coarser_yield;
  return false;
}

/// Finds what each part would do if it alone were coarser, and loosens those that would do nothing: at the least cost
/// there are none.
bool ToleranceSearch::leave_none_idle() {
  std::vector<std::size_t> all(programme_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (!try_coarser(all)) return false;
  bool better = false;
  for (std::size_t round = 0; round < kMostRounds; ++round) {
    std::vector<std::size_t> idle = idle_parts(all);
    if (idle.empty()) break;
    const std::optional<bool> loosened = loosen(std::move(idle));
    if (!loosened) return false;
    if (!*loosened) break;
    if (!try_coarser(all)) return false;
    better = true;
  }
  if (better) add_stage("coarser where nothing breaks", trial_.load.size(), trial_.rejects());
  return true;
}

}  // namespace poesy
