#include "engine/kinds/sensitivity/collector.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/base/contract.h"
#include "engine/run/evaluate_unit.h"

namespace poesy {
namespace {

void append(const Estimate& estimate, EstimateCourse& history) {
  history.value.push_back(estimate.value);
  history.ci_low.push_back(estimate.interval.low);
  history.ci_high.push_back(estimate.interval.high);
}

constexpr std::uint64_t kKind = 1;  ///< no other state begins with this number

// What a state holds of a cell.
constexpr std::uint64_t kWhole = 1;
constexpr std::uint64_t kPart = 2;

/// In a cell of so many samples.
std::size_t units_of(std::uint64_t samples) { return Plan::units_for(static_cast<std::size_t>(samples)); }

}  // namespace

HistoryCollector::HistoryCollector(const Plan& plan, std::size_t responses, double conf_level)
    : plan_(&plan),
      responses_(responses),
      conf_level_(conf_level),
      points_(history_points(plan)),
      looks_({plan.slots(), points_.size()}) {}

void HistoryCollector::add(const WorkUnit& unit, std::span<const LocalIndex> within, const UnitStats& cell) {
  const std::size_t number = unit.slot * poses() + unit.pose.value;
  for (std::size_t k = 0; k < within.size() / responses_; ++k) {
    add(number, k, within.subspan(k * responses_, responses_));
  }
  const std::size_t end = unit.first.value + unit.count;
  const auto point = std::ranges::lower_bound(points_, end);
  if (point == points_.end() || *point != end) return;
  POESY_EXPECTS(cell.solves.total() == end);
  std::vector<LocalIndex> indices;
  for (const Moments& response : cell.responses) {
    indices.push_back(local_index_with_error(response, plan_->distributions()[unit.slot].standard_deviation()));
  }
  add(number, static_cast<std::size_t>(point - points_.begin()), indices);
}

void HistoryCollector::add(std::size_t cell, std::size_t point, std::span<const LocalIndex> indices) {
  Look& at = looks_(cell / poses(), point);
  if (at.local.empty()) at.local = Array<LocalIndex, axis::Response, axis::Pose>({responses_, poses()});
  for (std::size_t r = 0; r < responses_; ++r) at.local(r, cell % poses()) = indices[r];
  if (++at.reached < poses()) return;
  const auto local = std::exchange(at.local, {});
  for (std::size_t r = 0; r < responses_; ++r) at.global.push_back(global_index(local.row(r), conf_level_));
}

EstimateCourse HistoryCollector::history(const SensitivityResult& end) const {
  EstimateCourse history;
  history.conf_level = conf_level_;
  history.samples.assign(points_.begin(), points_.end());
  const bool ends_at_a_point = !points_.empty() && points_.back() == plan_->samples();
  if (!ends_at_a_point) history.samples.push_back(plan_->samples());
  for (std::size_t r = 0; r < responses_; ++r) {
    for (std::size_t slot = 0; slot < plan_->slots(); ++slot) {
      for (std::size_t k = 0; k + 1 < history.samples.size(); ++k) append(looks_(slot, k).global.at(r), history);
      append({end.global(r, slot), {end.global_ci_low(r, slot), end.global_ci_high(r, slot)}}, history);
    }
  }
  return history;
}

std::vector<std::size_t> HistoryCollector::poses_at(std::size_t slot, std::size_t point,
                                                    std::span<const std::size_t> units_done) const {
  const std::span<const std::size_t> of_slot = units_done.subspan(slot * poses(), poses());
  std::vector<std::size_t> list;
  for (std::size_t m = 0; m < poses(); ++m) {
    if (of_slot[m] >= Plan::units_for(points_[point])) list.push_back(m);
  }
  return list;
}

void HistoryCollector::write(ByteWriter& to, std::span<const std::size_t> units_done) const {
  for (std::size_t slot = 0; slot < plan_->slots(); ++slot) {
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const Look& at = looks_(slot, k);
      for (const Estimate& index : at.global) {
        to.reals(std::array{index.value, index.interval.low, index.interval.high});
      }
      if (at.local.empty()) continue;
      for (const std::size_t m : poses_at(slot, k, units_done)) {
        for (std::size_t r = 0; r < responses_; ++r) {
          const LocalIndex& index = at.local(r, m);
          to.reals(std::array{index.value, index.standard_error});
        }
      }
    }
  }
}

void HistoryCollector::read(ByteReader& from, std::span<const std::size_t> units_done, std::size_t samples) {
  const auto points = static_cast<std::size_t>(std::ranges::upper_bound(points_, samples) - points_.begin());
  // A first unit that is smaller than others is not the beginning of a longer study's, and is solved again.
  const bool begins_longer = samples == plan_->samples() || samples >= Plan::kUnitSamples;
  std::vector<LocalIndex> indices(responses_);
  for (std::size_t slot = 0; slot < plan_->slots(); ++slot) {
    for (std::size_t k = 0; k < points; ++k) {
      const std::vector<std::size_t> reached = poses_at(slot, k, units_done);
      if (reached.size() == poses()) {
        Look whole{.reached = poses()};
        for (std::size_t r = 0; r < responses_; ++r) {
          const double value = from.real();
          const double low = from.real();
          whole.global.push_back({value, {low, from.real()}});
        }
        if (begins_longer) looks_(slot, k) = std::move(whole);
        continue;
      }
      for (const std::size_t m : reached) {
        for (LocalIndex& index : indices) {
          index.value = from.real();
          index.standard_error = from.real();
        }
        if (begins_longer) add(slot * poses() + m, k, indices);
      }
    }
  }
}

SensitivityCollector::SensitivityCollector(const Plan& plan, std::size_t responses, double conf_level,
                                           const Shard& shard)
    : plan_(&plan), responses_(responses), cells_(shard.of(plan.cells())), history_(plan, responses, conf_level) {}

void SensitivityCollector::add(const WorkUnit& unit, const CellUnit& found) {
  const std::size_t cell = cell_of(unit);
  POESY_EXPECTS(cells_.holds(cell) && unit.first.value == units_done(cell) * Plan::kUnitSamples);
  CellStats& stats = unit.count == Plan::kUnitSamples ? whole_ : parts_;
  merge(stats, cell, found);
  history_.add(unit, found.within, stats.at(cell - cells_.first));
}

void SensitivityCollector::merge(CellStats& stats, std::size_t cell, const UnitStats& unit) {
  if (stats.size() == 0) stats = CellStats(responses_, cells_.end - cells_.first);
  stats.merge(cell - cells_.first, unit);
}

std::uint64_t SensitivityCollector::samples_in(const CellStats& stats, std::size_t cell) const {
  return stats.size() > 0 && cells_.holds(cell) ? stats.solves[cell - cells_.first].total() : 0;
}

std::size_t SensitivityCollector::units_done(std::size_t cell) const {
  return static_cast<std::size_t>(whole_samples(cell) / Plan::kUnitSamples) + (part_samples(cell) > 0 ? 1 : 0);
}

SolveCounts SensitivityCollector::total() const {
  SolveCounts sum = total_of(whole_.solves);
  sum.merge(total_of(parts_.solves));
  return sum;
}

CellStats SensitivityCollector::cells_of(std::size_t slot) const {
  const std::size_t poses = plan_->poses().size();
  const NumberRange range{slot * poses, (slot + 1) * poses};
  POESY_EXPECTS(cells_.first == 0 && range.end <= cells_.end);
  POESY_EXPECTS(whole_.size() > 0 || parts_.size() > 0);
  if (whole_.size() == 0) return parts_.part(range);
  CellStats cells = whole_.part(range);
  if (parts_.size() > 0) cells.merge(parts_.part(range));
  return cells;
}

CellStats SensitivityCollector::cells() && {
  POESY_EXPECTS(cells_.first == 0 && cells_.end == plan_->cells());
  POESY_EXPECTS(whole_.size() > 0 || parts_.size() > 0);
  if (whole_.size() == 0) return std::exchange(parts_, {});
  if (parts_.size() > 0) whole_.merge(std::exchange(parts_, {}));
  return std::exchange(whole_, {});
}

void SensitivityCollector::write_state(ByteWriter& to) const {
  to.number(kKind);
  to.number(responses_);
  to.number(plan_->cells());
  to.number(plan_->samples());
  std::vector<std::size_t> units;
  units.reserve(plan_->cells());
  for (std::size_t cell = 0; cell < plan_->cells(); ++cell) {
    const bool has_whole = whole_samples(cell) > 0;
    const bool has_part = part_samples(cell) > 0;
    to.number((has_whole ? kWhole : 0) | (has_part ? kPart : 0));
    if (has_whole) whole_.at(cell - cells_.first).write(to);
    if (has_part) parts_.at(cell - cells_.first).write(to);
    units.push_back(units_done(cell));
  }
  history_.write(to, units);
}

void SensitivityCollector::restore(std::span<const std::byte> state) {
  ByteReader from(state);
  while (from.left() > 0) restore_one(from);
}

void SensitivityCollector::restore_one(ByteReader& from) {
  if (from.number() != kKind || from.number() != responses_ || from.number() != plan_->cells()) {
    throw BytesError("is the state of another kind or size of study");
  }
  const auto samples = static_cast<std::size_t>(from.number_up_to(plan_->samples()));
  std::vector<std::size_t> units;
  for (std::size_t cell = 0; cell < plan_->cells(); ++cell) units.push_back(restore_cell(from, cell, samples));
  history_.read(from, units, samples);
}

std::size_t SensitivityCollector::restore_cell(ByteReader& from, std::size_t cell, std::size_t samples) {
  const std::uint64_t holds = from.number_up_to(kWhole | kPart);
  if (holds == 0) return 0;
  if (!cells_.holds(cell)) throw BytesError("has a cell of another shard");
  if (units_done(cell) > 0) throw BytesError("has a cell twice");
  std::uint64_t whole_solves = 0;
  if ((holds & kWhole) != 0) {
    const UnitStats whole = UnitStats::read(from, responses_, 0);
    whole_solves = whole.solves.total();
    if (whole_solves == 0 || whole_solves % Plan::kUnitSamples != 0 || whole_solves > samples) {
      throw BytesError("has a cell that is no number of whole units");
    }
    merge(whole_, cell, whole);
  }
  if ((holds & kPart) == 0) return units_of(whole_solves);
  const UnitStats part = UnitStats::read(from, responses_, whole_solves);
  const std::uint64_t solves = part.solves.total();
  if (solves == 0 || solves >= Plan::kUnitSamples || whole_solves + solves != samples) {
    throw BytesError("has a last unit of the wrong size");
  }
  if (samples == plan_->samples()) merge(parts_, cell, part);
  return units_of(samples);
}

}  // namespace poesy
