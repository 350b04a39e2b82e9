#include "engine/kinds/allocation/programme.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/fits/it_grade.h"
#include "engine/kinds/allocation/parts.h"
#include "engine/kinds/allocation/zone_parts.h"
#include "engine/optimise/max_tolerances.h"

namespace poesy::allocation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// The upper bound on a tolerance for which the study states none, as a share of the dimension of the mechanism that
/// the error changes (Model::error_bound).
constexpr double kShareOfPart = 0.25;

/// The standard deviation (SI) of an error whose tolerance is 0. It is so small that no solve can distinguish it from
/// 0.
constexpr double kPerfect = 1e-18;

/// The upper bound (SI) on the tolerance of a part for which the study states none.
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
  const auto bounded = [&](const CostLaw& cost, double lo, double hi) {
    const double most = std::isinf(hi) ? std::max(lo, largest_of(part, model)) : hi;
    if (!part.round) return Process{cost, lo, most};
    const double least = part.round->up(lo);
    return Process{cost, least, std::max(least, part.round->down(most))};
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
        list.push_back(bounded(process.cost.cost_law(), process.lo, process.hi));
      }
      return list;
    }
    case Choice::range:
      break;
  }
  return {bounded(law, part.lo, part.hi)};
}

/// A distribution of the same shape. sigma: its standard deviation about the mean, SI. shift: its offset of the mean,
/// SI. Precondition: the shape is symmetric.
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

/// The positions of the part's errors among those that vary.
std::vector<std::size_t> errors_of(const AllocatedPart& part, const Study& study) {
  std::vector<std::size_t> errors;
  for (const FactorIndex factor : part.factors) {
    const auto at = std::ranges::find(study.analysis.factors, factor);
    POESY_EXPECTS(at != study.analysis.factors.end());
    errors.push_back(static_cast<std::size_t>(at - study.analysis.factors.begin()));
  }
  return errors;
}

DrawnPart drawn_part(const AllocatedPart& part, const std::vector<std::size_t>& errors, const Study& study) {
  if (part.zone) return drawn_zone(part, study.model(), study.analysis.factors);
  return {{{errors, mean_square_per_tolerance({part.sigmas, part.shift})}}};
}

/// Whether all errors of a part have the same standard deviation, which depends only on the part's own tolerance.
bool has_one_spread(const AllocatedPart& part, const ModelDescription& model) {
  return !part.zone || feature_of(part, model).kind == FeatureKind::distance;
}

/// The drawing does not need a zone of orientation whose width is at least this share of the largest width that the
/// zone of location allows.
constexpr double kVoid = 1.0 - 1e-9;

/// A tolerance and the position of a process that can keep it.
struct Held {
  double tolerance;
  std::size_t process;
};

/// The largest tolerance up to `most` that some process can keep, with the cheapest such process. If there is none, the
/// lowest tolerance of all processes.
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

/// A tolerance that is coarser than `from`: `factor` times as large, but at most the largest of its process. If the
/// process allows no larger one, the next larger tolerance of a process with a single value. None if there is none.
std::optional<Held> larger_than(const std::vector<Process>& list, const Held& from, double factor) {
  const Process& now = list[from.process];
  if (now.hi > from.tolerance) return Held{std::min(now.hi, factor * from.tolerance), from.process};
  std::optional<std::size_t> above;
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (list[k].lo != list[k].hi || list[k].lo <= from.tolerance) continue;
    if (!above || list[k].lo < list[*above].lo) above = k;
  }
  if (!above) return std::nullopt;
  return Held{list[*above].lo, *above};
}

/// The process, restricted to its finest tolerance if all its tolerances cost the same.
Process finest_if_constant(Process process) {
  if (process.cost.is_constant()) process.hi = process.lo;
  return process;
}

}  // namespace

ToleranceProgramme::ToleranceProgramme(const Study& study, const Model& model) : study_(study) {
  for (const AllocatedPart& part : parts()) {
    processes_.push_back(processes_of(part, model));
    errors_.push_back(errors_of(part, study));
    drawn_.push_back(drawn_part(part, errors_.back(), study));
    has_costs_ = has_costs_ || has_cost(part);
  }
  pairs_ = zone_pairs(parts(), study.model());
}

const Within* ToleranceProgramme::pair_of(std::size_t part) const {
  const auto has = [&](const Within& pair) { return pair.inner == part || pair.outer == part; };
  const auto found = std::ranges::find_if(pairs_, has);
  return found == pairs_.end() ? nullptr : &*found;
}

bool ToleranceProgramme::is_void(const TolerancePoint& point, std::size_t part) const {
  const Within* const pair = pair_of(part);
  if (pair == nullptr || pair->inner != part) return false;
  return point.tolerance[part] >= kVoid * std::sqrt(pair->share) * point.tolerance[pair->outer];
}

void ToleranceProgramme::keep_within(std::span<double> tolerance) const {
  for (const Within& pair : pairs_) {
    tolerance[pair.inner] = std::min(tolerance[pair.inner], std::sqrt(pair.share) * tolerance[pair.outer]);
  }
}

void ToleranceProgramme::keep_void(const TolerancePoint& point, std::span<double> tolerance) const {
  for (const Within& pair : pairs_) {
    if (is_void(point, pair.inner)) tolerance[pair.inner] = std::sqrt(pair.share) * tolerance[pair.outer];
  }
}

void ToleranceProgramme::keep_allowed(ToleranceLimits& limits) const {
  for (std::size_t l = 0; l < limits.count(); ++l) {
    for (const Within& pair : pairs_) {
      double* const row = &limits.effects[l * limits.parts];
      row[pair.inner] = std::max(row[pair.inner], -row[pair.outer] / pair.share);
    }
  }
}

/// The mean square (SI squared) of each error of a pair of zones at these tolerances [parts]. The member `factor`
/// contains the mean square.
std::vector<ErrorFactor> ToleranceProgramme::squares_of_pair(const Within& pair,
                                                             std::span<const double> tolerance) const {
  std::vector<ErrorFactor> squares;
  for (const std::size_t part : {pair.outer, pair.inner}) {
    for (const auto& [errors, mean_square] : drawn_[part].groups) {
      for (const std::size_t error : errors) {
        auto at = std::ranges::find(squares, error, &ErrorFactor::error);
        if (at == squares.end()) at = squares.insert(at, {error, 0.0});
        at->factor += mean_square * tolerance[part] * tolerance[part];
      }
    }
  }
  return squares;
}

Variation ToleranceProgramme::variation(const TolerancePoint& point, std::size_t part, double factor) const {
  Variation changes;
  const Within* const pair = pair_of(part);
  if (pair == nullptr) {
    for (const std::size_t error : errors_[part]) changes.push_back({error, factor});
    return changes;
  }
  const bool follows = is_void(point, pair->inner) && part == pair->outer;
  std::vector<double> tolerance = point.tolerance;
  tolerance[part] *= std::abs(factor);
  if (follows) tolerance[pair->inner] *= std::abs(factor);
  keep_within(tolerance);
  const std::vector<ErrorFactor> before = squares_of_pair(*pair, point.tolerance);
  const std::vector<ErrorFactor> after = squares_of_pair(*pair, tolerance);
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (!(before[k].factor > 0.0)) continue;
    const double change = std::sqrt(std::max(0.0, after[k].factor) / before[k].factor);
    changes.push_back({before[k].error, std::copysign(change, factor)});
  }
  return changes;
}

ToleranceProgramme::Weights ToleranceProgramme::weights(const TolerancePoint& point, std::size_t part) const {
  if (const Within* const pair = pair_of(part)) {
    return {squares_of_pair(*pair, point.tolerance), {pair->outer, pair->inner}};
  }
  Weights weights{{}, {part}};
  const bool is_uniform = drawn_[part].groups.size() == 1;
  for (const auto& [errors, mean_square] : drawn_[part].groups) {
    for (const std::size_t error : errors) weights.errors.push_back({error, is_uniform ? 1.0 : mean_square});
  }
  return weights;
}

std::vector<ErrorFactor> ToleranceProgramme::growth(const TolerancePoint& point, std::size_t part) const {
  std::vector<ErrorFactor> growth;
  const Within* const pair = pair_of(part);
  if (pair == nullptr) {
    for (const std::size_t error : errors_[part]) growth.push_back({error, 1.0});
    return growth;
  }
  const std::vector<ErrorFactor> squares = squares_of_pair(*pair, point.tolerance);
  for (const auto& [errors, mean_square] : drawn_[part].groups) {
    const double added = mean_square * point.tolerance[part] * point.tolerance[part];
    for (const std::size_t error : errors) {
      const double all = std::ranges::find(squares, error, &ErrorFactor::error)->factor;
      if (all > 0.0) growth.push_back({error, added / all});
    }
  }
  return growth;
}

const std::vector<AllocatedPart>& ToleranceProgramme::parts() const { return asked_of<Options>(study_.analysis).parts; }

std::string ToleranceProgramme::chosen_name(std::size_t part, std::size_t process) const {
  const AllocatedPart& one = parts()[part];
  if (one.choice == AllocatedPart::Choice::grades) return it_grade_name(one.grades[process]);
  const std::string name = one.choice == AllocatedPart::Choice::processes ? one.processes[process].name : "";
  if (!one.round) return name;
  return name + (name.empty() ? "" : ", ") + rounding_words(*one.round, dimension_of(one, study_.model()));
}

/// For a part that is a zone: the smallest size (m) that the drawing states for this zone at the features of the part.
double ToleranceProgramme::usual_of_zone(const AllocatedPart& part) const {
  const bool turned = is_orientation(part, study_.model());
  double usual = kInfinity;
  for (const std::size_t f : part.zone->features) {
    const Feature& feature = study_.model().features[f];
    usual = std::min(usual, (turned ? feature.orientation : feature.location)->size);
  }
  return usual;
}

std::vector<double> ToleranceProgramme::usual() const {
  std::vector<double> usual;
  for (std::size_t i = 0; i < size(); ++i) {
    if (parts()[i].zone) {
      usual.push_back(usual_of_zone(parts()[i]));
      continue;
    }
    double sigma = kInfinity;
    for (const FactorIndex factor : parts()[i].factors) {
      sigma = std::min(sigma, study_.errors.by_factor[factor.value].standard_deviation());
    }
    usual.push_back(sigma / std::sqrt(drawn_[i].groups.front().mean_square));
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
  for (const Within& pair : pairs_) {
    const double widest = std::sqrt(pair.share);
    const bool was_void = tolerance[pair.inner] >= kVoid * widest * tolerance[pair.outer];
    double& inner = point.tolerance[pair.inner];
    const double most = widest * point.tolerance[pair.outer];
    const bool is_given = pair.left_out == LeftOut::where_it_is_void;
    if ((was_void && !is_given) || inner >= kVoid * most) inner = most;
  }
  point.cost = cost_of(point);
  return point;
}

TolerancePoint ToleranceProgramme::rounded(const TolerancePoint& point) const {
  const auto down = [&](std::size_t part, double tolerance) {
    const std::optional<Rounding>& round = parts()[part].round;
    const double lowest = processes_[part][point.process[part]].lo;
    return round ? std::max(lowest, round->down(tolerance)) : tolerance;
  };
  TolerancePoint next = point;
  for (std::size_t i = 0; i < size(); ++i) next.tolerance[i] = down(i, point.tolerance[i]);
  for (const Within& pair : pairs_) {
    if (is_void(point, pair.inner)) continue;
    const double location = point.tolerance[pair.outer];
    const double before = point.tolerance[pair.inner];
    const double after = next.tolerance[pair.inner];
    // The mean square of the middle is proportional to location^2 - orientation^2, and must not grow.
    const double most = std::sqrt(location * location - (before - after) * (before + after));
    next.tolerance[pair.outer] = down(pair.outer, most);
  }
  keep_void(point, next.tolerance);
  keep_within(next.tolerance);
  next.cost = cost_of(next);
  return next;
}

TolerancePoint ToleranceProgramme::lowest() const { return at_most(std::vector<double>(size(), 0.0)); }

std::optional<TolerancePoint> ToleranceProgramme::coarser(const TolerancePoint& point, std::size_t part,
                                                          double factor) const {
  const double from = point.tolerance[part];
  if (from == 0.0 || is_void(point, part)) return std::nullopt;
  std::optional<Held> larger = larger_than(processes_[part], {from, point.process[part]}, factor);
  const Within* const pair = pair_of(part);
  if (pair != nullptr && pair->inner == part && pair->left_out == LeftOut::by_choice) {
    const double most = std::sqrt(pair->share) * point.tolerance[pair->outer];
    if (!larger || larger->tolerance >= kVoid * most) larger = Held{most, point.process[part]};
  }
  if (!larger) return std::nullopt;
  TolerancePoint next = point;
  next.tolerance[part] = larger->tolerance;
  next.process[part] = larger->process;
  if (pair != nullptr && pair->outer == part && is_void(point, pair->inner)) {
    next.tolerance[pair->inner] *= larger->tolerance / from;
  }
  next.cost = cost_of(next);
  return next;
}

AtBound ToleranceProgramme::at_bound(const TolerancePoint& point, std::size_t part) const {
  const std::vector<Process>& list = processes_[part];
  const double tolerance = point.tolerance[part];
  const std::size_t process = point.process[part];
  const double lowest = std::ranges::min(list, {}, &Process::lo).lo;
  const double highest = std::ranges::max(list, {}, &Process::hi).hi;
  if (lowest == highest) return AtBound::single;
  if (is_void(point, part)) return AtBound::none;
  if (tolerance == lowest) return AtBound::lower;
  if (tolerance == highest) return AtBound::upper;
  const Process& chosen = list[process];
  if (chosen.lo == chosen.hi) return AtBound::none;
  if (tolerance == chosen.lo) return AtBound::lower;
  return tolerance == chosen.hi ? AtBound::upper : AtBound::none;
}

double ToleranceProgramme::cost(const TolerancePoint& point, std::size_t part) const {
  if (is_void(point, part)) return 0.0;
  return processes_[part][point.process[part]].cost.at(point.tolerance[part]);
}

double ToleranceProgramme::cost_of(const TolerancePoint& point) const {
  if (!has_costs_) return kNaN;
  double sum = 0.0;
  for (std::size_t i = 0; i < size(); ++i) sum += cost(point, i);
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
  keep_allowed(limits);
  return limits;
}

std::vector<std::vector<Process>> ToleranceProgramme::within(const TrustRegion& region,
                                                             std::vector<std::vector<std::size_t>>& kept) const {
  const bool anywhere = region.centre.empty();
  std::vector<std::vector<Process>> near;
  for (std::size_t i = 0; i < size(); ++i) {
    const double lowest = std::ranges::min(processes_[i], {}, &Process::lo).lo;
    const double most = anywhere ? kInfinity : std::max(region.growth * region.centre[i], lowest);
    const bool in_pair = pair_of(i) != nullptr;
    near.emplace_back();
    kept.emplace_back();
    for (std::size_t k = 0; k < processes_[i].size(); ++k) {
      const Process& process = processes_[i][k];
      if (process.lo > most) continue;
      near.back().push_back({process.cost, process.lo, std::min(process.hi, most)});
      if (in_pair) near.back().back() = finest_if_constant(near.back().back());
      kept.back().push_back(k);
    }
  }
  return near;
}

ChoiceOfTolerances ToleranceProgramme::least(const ToleranceLimits& limits, const TrustRegion& region) const {
  constexpr SearchOptions kSearch{.relative_gap = 1e-6, .alternatives = 0, .max_nodes = 5000};
  std::vector<std::vector<std::size_t>> kept;
  AllocationOutcome outcome = least_cost({limits, within(region, kept), pairs_}, kSearch);
  if (const auto* broken = std::get_if<Infeasible>(&outcome)) return *broken;
  if (const auto* endless = std::get_if<Unbounded>(&outcome)) return *endless;
  const LeastCost& found = std::get<LeastCost>(outcome);
  ChosenTolerances chosen{{found.best.tolerance, {}, 0.0}, found.lower_bound, found.multiplier};
  if (std::ranges::all_of(chosen.multiplier, [](double one) { return one == 0.0; })) {
    // If every part can only choose from single values, all multipliers are 0. The multipliers of the relaxed problem,
    // in which processes may be mixed, are used instead.
    chosen.multiplier = found.relaxed;
  }
  for (std::size_t i = 0; i < size(); ++i) chosen.process.push_back(kept[i][found.best.process[i]]);
  chosen.cost = cost_of(chosen);
  return chosen;
}

std::vector<double> ToleranceProgramme::proportions(const ToleranceLimits& limits) const {
  const Aim aim = asked_of<Options>(study_.analysis).aim;
  if (aim == Aim::equal_effect) return equal_effect_proportions(limits);
  std::vector<double> list;
  for (std::size_t i = 0; i < size(); ++i) {
    if (parts()[i].zone) {
      list.push_back(usual_of_zone(parts()[i]));
      continue;
    }
    const FactorIndex first = parts()[i].factors.front();
    const double sigma = study_.errors.by_factor[first.value].standard_deviation();
    list.push_back(sigma / std::sqrt(drawn_[i].groups.front().mean_square));
  }
  if (aim == Aim::common_factor) return list;
  for (const Dimension dimension : kErrorDimensions) {
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
  return asked_of<Options>(study_.analysis).aim == Aim::least_cost ? least(limits, region) : largest(limits);
}

Study ToleranceProgramme::at(std::span<const double> tolerance) const {
  Study study = study_;
  const auto set = [&](FactorIndex factor, double sigma, double shift) {
    Distribution& error = study.errors.by_factor[factor.value];
    error = error_of(error, std::max(sigma, kPerfect), shift);
  };
  std::vector<double> squares(study_.analysis.factors.size(), 0.0);  // mean squares of errors in zones, SI squared
  for (std::size_t i = 0; i < size(); ++i) {
    const AllocatedPart& part = parts()[i];
    if (has_one_spread(part, study_.model())) {
      const double sigma = sigma_per_tolerance({part.sigmas, part.shift}) * tolerance[i];
      for (const FactorIndex factor : part.factors) set(factor, sigma, part.shift * tolerance[i]);
      continue;
    }
    for (const auto& [errors, mean_square] : drawn_[i].groups) {
      for (const std::size_t error : errors) squares[error] += mean_square * tolerance[i] * tolerance[i];
    }
  }
  for (std::size_t i = 0; i < size(); ++i) {
    if (has_one_spread(parts()[i], study_.model())) continue;
    for (const std::size_t error : errors_[i]) {
      set(study_.analysis.factors[error], std::sqrt(std::max(0.0, squares[error])), 0.0);
    }
  }
  return study;
}

}  // namespace poesy::allocation
