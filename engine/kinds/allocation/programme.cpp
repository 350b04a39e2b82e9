#include "engine/kinds/allocation/programme.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/fits/it_grade.h"
#include "engine/kinds/allocation/parts.h"
#include "engine/optimise/max_tolerances.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The largest tolerance over the size of its part. Four standard deviations of a normal error are then the whole part.
constexpr double kShareOfPart = 0.25;

/// The standard deviation of a perfect part, m or rad: far below what any solve can distinguish from zero.
constexpr double kPerfect = 1e-18;

/// The largest tolerance that makes sense, whatever the study says.
double largest_of(const AllocatedPart& part, const Model& model) {
  double largest = kInfinity;
  for (const FactorIndex factor : part.factors) {
    largest = std::min(largest, kShareOfPart * model.error_bound(factor).size);
  }
  return largest;
}

std::vector<Process> processes_of(const AllocatedPart& part, const Model& model) {
  using Choice = AllocatedPart::Choice;
  const CostLaw law = part.cost.cost_law();
  const auto bounded = [&](double hi, double lo) {
    return std::isinf(hi) ? std::max(lo, largest_of(part, model)) : hi;
  };
  switch (part.choice) {
    case Choice::fixed:
      return {{law, part.lo, part.lo}};
    case Choice::values:
      return available_values(law, part.values);
    case Choice::grades: {
      std::vector<double> values;
      for (const ItGrade grade : part.grades) values.push_back(0.5 * it_grade_width(part.nominal_size, grade).value());
      return available_values(law, values);
    }
    case Choice::processes: {
      std::vector<Process> list;
      for (const StatedProcess& process : part.processes) {
        list.push_back({process.cost.cost_law(), process.lo, bounded(process.hi, process.lo)});
      }
      return list;
    }
    case Choice::range:
      break;
  }
  return {{law, part.lo, bounded(part.hi, part.lo)}};
}

/// Errors with this shape, this standard deviation and a shifted mean, SI. Precondition: the shape is symmetric.
Distribution error_of(const Distribution& shape, double sigma, double shift) {
  const double without_shift =
      std::sqrt(shape.standard_deviation() * shape.standard_deviation() - shape.shift() * shape.shift());
  const auto scaled = [&] {
    switch (shape.shape()) {
      case Distribution::Shape::truncated_normal:
        return Distribution::truncated_normal(shape.sigma() * sigma / without_shift,
                                              shape.half_width() * sigma / without_shift);
      case Distribution::Shape::uniform:
        return Distribution::uniform(std::sqrt(3.0) * sigma);
      case Distribution::Shape::triangular:
        return Distribution::triangular(std::sqrt(6.0) * sigma);
      case Distribution::Shape::normal:
      case Distribution::Shape::measured:
      case Distribution::Shape::given:
        break;
    }
    return Distribution::normal(sigma);
  };
  return scaled().shifted(shift);
}

DrawnPart drawn_part(const AllocatedPart& part, const Study& study) {
  DrawnPart drawn{{}, {part.sigmas, part.shift}};
  for (const FactorIndex factor : part.factors) {
    const auto at = std::ranges::find(study.analysis.factors, factor);
    POESY_EXPECTS(at != study.analysis.factors.end());
    drawn.factors.push_back(static_cast<std::size_t>(at - study.analysis.factors.begin()));
  }
  return drawn;
}

/// A tolerance and a process that can make it.
struct Held {
  double tolerance;
  std::size_t process;
};

/// The largest tolerance up to `most` that a process can make, with the cheapest such process; otherwise the lowest
/// tolerance.
Held held_below(const std::vector<Process>& processes, double most) {
  std::optional<Held> best;
  for (std::size_t k = 0; k < processes.size(); ++k) {
    const Process& process = processes[k];
    if (process.lo > most) continue;
    const Held held{std::min(most, process.hi), k};
    const auto costs = [&](const Held& one) { return processes[one.process].cost.at(one.tolerance); };
    const bool better =
        !best || held.tolerance > best->tolerance || (held.tolerance == best->tolerance && costs(held) < costs(*best));
    if (better) best = held;
  }
  if (best) return *best;
  const auto lowest = std::ranges::min_element(processes, {}, &Process::lo);
  return {lowest->lo, static_cast<std::size_t>(lowest - processes.begin())};
}

}  // namespace

ToleranceProgramme::ToleranceProgramme(const Study& study, const Model& model) : study_(study) {
  for (const AllocatedPart& part : parts()) {
    processes_.push_back(processes_of(part, model));
    drawn_.push_back(drawn_part(part, study));
    has_costs_ = has_costs_ || has_cost(part);
  }
}

const std::vector<AllocatedPart>& ToleranceProgramme::parts() const {
  return asked_of<AllocationOptions>(study_.analysis).parts;
}

std::string ToleranceProgramme::chosen_name(std::size_t part, std::size_t process) const {
  const AllocatedPart& one = parts()[part];
  if (one.choice == AllocatedPart::Choice::processes) return one.processes[process].name;
  return one.choice == AllocatedPart::Choice::grades ? it_grade_name(one.grades[process]) : "";
}

std::vector<double> ToleranceProgramme::usual() const {
  std::vector<double> usual;
  for (std::size_t i = 0; i < size(); ++i) {
    double sigma = kInfinity;
    for (const FactorIndex factor : parts()[i].factors) {
      sigma = std::min(sigma, study_.errors.by_factor[factor.value].standard_deviation());
    }
    usual.push_back(sigma / std::sqrt(mean_square_per_tolerance(drawn_[i].spread)));
  }
  return at_most(usual).tolerance;
}

TolerancePoint ToleranceProgramme::at_most(std::span<const double> tolerance) const {
  TolerancePoint point;
  for (std::size_t i = 0; i < size(); ++i) {
    const Held held = held_below(processes_[i], tolerance[i]);
    point.tolerance.push_back(held.tolerance);
    point.process.push_back(held.process);
  }
  point.cost = cost_of(point);
  return point;
}

TolerancePoint ToleranceProgramme::lowest() const { return at_most(std::vector<double>(size(), 0.0)); }

std::optional<TolerancePoint> ToleranceProgramme::coarser(const TolerancePoint& point, std::size_t part,
                                                          double factor) const {
  const std::vector<Process>& list = processes_[part];
  const double from = point.tolerance[part];
  if (from == 0.0) return std::nullopt;
  TolerancePoint next = point;
  const Process& now = list[point.process[part]];
  if (now.hi > from) {
    next.tolerance[part] = std::min(now.hi, factor * from);
  } else {
    std::optional<std::size_t> above;  // the next larger single value
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (list[k].lo != list[k].hi || list[k].lo <= from) continue;
      if (!above || list[k].lo < list[*above].lo) above = k;
    }
    if (!above) return std::nullopt;
    next.tolerance[part] = list[*above].lo;
    next.process[part] = *above;
  }
  next.cost = cost_of(next);
  return next;
}

AtBound ToleranceProgramme::at_bound(std::size_t part, double tolerance, std::size_t process) const {
  const std::vector<Process>& list = processes_[part];
  const double lowest = std::ranges::min(list, {}, &Process::lo).lo;
  const double highest = std::ranges::max(list, {}, &Process::hi).hi;
  if (lowest == highest) return AtBound::single;
  if (tolerance == lowest) return AtBound::lower;
  if (tolerance == highest) return AtBound::upper;
  const Process& chosen = list[process];
  if (chosen.lo == chosen.hi) return AtBound::none;
  if (tolerance == chosen.lo) return AtBound::lower;
  return tolerance == chosen.hi ? AtBound::upper : AtBound::none;
}

double ToleranceProgramme::cost(std::size_t part, double tolerance, std::size_t process) const {
  return processes_[part][process].cost.at(tolerance);
}

double ToleranceProgramme::cost_of(const TolerancePoint& point) const {
  if (!has_costs_) return kNaN;
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) sum += cost(i, point.tolerance[i], point.process[i]);
  return sum;
}

ToleranceLimits ToleranceProgramme::limits(const MeanSquares& squares, std::span<const double> at, double share,
                                           double wider) const {
  ToleranceLimits limits{.stacking = Stacking::root_sum_square,
                         .parts = size(),
                         .effects = part_effects(squares.slope, study_.analysis.factors.size(), drawn_),
                         .room = std::vector<double>(squares.value.size())};
  for (std::size_t l = 0; l < limits.count(); ++l) {
    const double most = share * wider * squares.room[l];
    limits.room[l] = most * most - squares.value[l] + limits.need(l, at);
  }
  return limits;
}

std::vector<std::vector<Process>> ToleranceProgramme::within(const TrustRegion& region,
                                                             std::vector<std::vector<std::size_t>>& kept) const {
  const bool anywhere = region.centre.empty();
  const std::vector<double> lowest = this->lowest().tolerance;
  std::vector<std::vector<Process>> near;
  for (std::size_t i = 0; i < size(); ++i) {
    const double most = anywhere ? kInfinity : std::max(region.growth * region.centre[i], lowest[i]);
    near.emplace_back();
    kept.emplace_back();
    for (std::size_t k = 0; k < processes_[i].size(); ++k) {
      const Process& process = processes_[i][k];
      if (process.lo > most) continue;
      near.back().push_back({process.cost, process.lo, std::min(process.hi, most)});
      kept.back().push_back(k);
    }
  }
  return near;
}

ChoiceOfTolerances ToleranceProgramme::least(const ToleranceLimits& limits, const TrustRegion& region) const {
  constexpr SearchOptions kSearch{.relative_gap = 1e-6, .alternatives = 0, .max_nodes = 5000};
  std::vector<std::vector<std::size_t>> kept;
  AllocationOutcome outcome = least_cost({limits, within(region, kept)}, kSearch);
  if (const auto* broken = std::get_if<Infeasible>(&outcome)) return *broken;
  if (const auto* endless = std::get_if<Unbounded>(&outcome)) return *endless;
  const LeastCost& found = std::get<LeastCost>(outcome);
  ChosenTolerances chosen{{found.best.tolerance, {}, 0.0}, found.lower_bound, found.multiplier};
  if (std::ranges::all_of(chosen.multiplier, [](double one) { return one == 0.0; })) {
    chosen.multiplier = found.relaxed;  // single values have no multipliers, so those of the relaxation are used
  }
  for (std::size_t i = 0; i < size(); ++i) chosen.process.push_back(kept[i][found.best.process[i]]);
  chosen.cost = cost_of(chosen);
  return chosen;
}

std::vector<double> ToleranceProgramme::proportions(const ToleranceLimits& limits) const {
  const Aim aim = asked_of<AllocationOptions>(study_.analysis).aim;
  if (aim == Aim::equal_effect) return equal_effect_proportions(limits);
  std::vector<double> list;
  for (std::size_t i = 0; i < size(); ++i) {
    const FactorIndex first = parts()[i].factors.front();
    const double sigma = study_.errors.by_factor[first.value].standard_deviation();
    list.push_back(sigma / std::sqrt(mean_square_per_tolerance(drawn_[i].spread)));
  }
  if (aim == Aim::common_factor) return list;
  for (const Dimension dimension : {Dimension::length, Dimension::angle}) {
    const auto is_one = [&](std::size_t i) {
      return study_.model().factors[parts()[i].factors.front().value].dimension == dimension;
    };
    std::vector<double> sizes;
    for (std::size_t i = 0; i < size(); ++i) {
      if (is_one(i)) sizes.push_back(list[i]);
    }
    if (sizes.empty()) continue;
    std::ranges::nth_element(sizes, sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2));
    for (std::size_t i = 0; i < size(); ++i) {
      if (is_one(i)) list[i] = sizes[sizes.size() / 2];
    }
  }
  return list;
}

ChoiceOfTolerances ToleranceProgramme::largest(const ToleranceLimits& limits) const {
  std::vector<ToleranceRange> ranges;
  for (const auto& list : processes_) {
    ranges.push_back({std::ranges::min(list, {}, &Process::lo).lo, std::ranges::max(list, {}, &Process::hi).hi});
  }
  if (std::ranges::any_of(limits.room, [](double room) { return room <= 0.0; })) {
    const std::vector<double> least = lowest().tolerance;
    const std::size_t worst = worst_use(limits, least).limit;
    return Infeasible{worst, limits.need(worst, least), limits.room[worst]};
  }
  const auto outcome = maximise_tolerances(limits, proportions(limits), ranges);
  if (const auto* broken = std::get_if<Infeasible>(&outcome)) return *broken;
  const TolerancePoint point = at_most(std::get<MaxTolerances>(outcome).tolerance);
  Unbounded endless;
  for (std::size_t i = 0; i < size(); ++i) {
    if (std::isinf(point.tolerance[i])) endless.parts.push_back(i);
  }
  if (!endless.parts.empty()) return endless;
  return ChosenTolerances{point, kNaN, {}};
}

ChoiceOfTolerances ToleranceProgramme::choose(const ToleranceLimits& limits, const TrustRegion& region) const {
  return asked_of<AllocationOptions>(study_.analysis).aim == Aim::least_cost ? least(limits, region) : largest(limits);
}

Study ToleranceProgramme::at(std::span<const double> tolerance) const {
  Study study = study_;
  for (std::size_t i = 0; i < size(); ++i) {
    const double sigma = sigma_per_tolerance(drawn_[i].spread) * tolerance[i];
    const double shift = drawn_[i].spread.shift * tolerance[i];
    for (const FactorIndex factor : parts()[i].factors) {
      Distribution& error = study.errors.by_factor[factor.value];
      error = error_of(error, std::max(sigma, kPerfect), shift);
    }
  }
  return study;
}

}  // namespace poesy
