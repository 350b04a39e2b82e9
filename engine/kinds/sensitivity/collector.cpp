#include "engine/kinds/sensitivity/collector.h"

#include <utility>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr std::uint64_t kKind = 1;  ///< no other state begins with this number

// What a state holds of a cell.
constexpr std::uint64_t kWhole = 1;
constexpr std::uint64_t kPart = 2;

/// In a cell of so many samples.
std::size_t units_of(std::uint64_t samples) { return Plan::units_for(static_cast<std::size_t>(samples)); }

}  // namespace

SensitivityCollector::SensitivityCollector(const Plan& plan, std::size_t responses, double conf_level)
    : plan_(&plan), responses_(responses), whole_(plan.cells()), history_(plan, responses, conf_level) {
  if (plan.samples() % Plan::kUnitSamples != 0) parts_.resize(plan.cells());
}

void SensitivityCollector::add(const WorkUnit& unit, const CellUnit& found) {
  const std::size_t cell = cell_of(unit);
  POESY_EXPECTS(unit.first.value == units_done(cell) * Plan::kUnitSamples);
  UnitStats& stats = (unit.count == Plan::kUnitSamples ? whole_ : parts_)[cell];
  stats.merge(found);
  history_.add(unit, found.within, stats);
}

std::size_t SensitivityCollector::units_done(std::size_t cell) const {
  return static_cast<std::size_t>(whole_[cell].solves.total() / Plan::kUnitSamples) + (has_part(cell) ? 1 : 0);
}

SolveCounts SensitivityCollector::total() const {
  SolveCounts sum;
  for (const UnitStats& cell : whole_) sum.merge(cell.solves);
  for (const UnitStats& part : parts_) sum.merge(part.solves);
  return sum;
}

std::vector<UnitStats> SensitivityCollector::cells_of(std::size_t slot) const {
  const std::size_t poses = plan_->poses().size();
  std::vector<UnitStats> cells;
  for (std::size_t cell = slot * poses; cell < (slot + 1) * poses; ++cell) {
    cells.push_back(whole_[cell]);
    if (has_part(cell)) cells.back().merge(parts_[cell]);
  }
  return cells;
}

std::vector<UnitStats> SensitivityCollector::cells() && {
  for (std::size_t cell = 0; cell < whole_.size(); ++cell) {
    if (has_part(cell)) whole_[cell].merge(parts_[cell]);
  }
  return std::move(whole_);
}

Bytes SensitivityCollector::state() const {
  ByteWriter to;
  to.number(kKind);
  to.number(responses_);
  to.number(whole_.size());
  to.number(plan_->samples());
  for (std::size_t cell = 0; cell < whole_.size(); ++cell) {
    const bool has_whole = whole_[cell].solves.total() > 0;
    to.number((has_whole ? kWhole : 0) | (has_part(cell) ? kPart : 0));
    if (has_whole) whole_[cell].write(to);
    if (has_part(cell)) parts_[cell].write(to);
  }
  std::vector<std::size_t> units;
  for (std::size_t cell = 0; cell < whole_.size(); ++cell) units.push_back(units_done(cell));
  history_.write(to, units);
  return to.take();
}

void SensitivityCollector::restore(std::span<const std::byte> state) {
  ByteReader from(state);
  while (from.left() > 0) restore_one(from);
}

void SensitivityCollector::restore_one(ByteReader& from) {
  if (from.number() != kKind || from.number() != responses_ || from.number() != whole_.size()) {
    throw BytesError("is the state of another kind or size of study");
  }
  const auto samples = static_cast<std::size_t>(from.number_up_to(plan_->samples()));
  std::vector<std::size_t> units;
  for (std::size_t cell = 0; cell < whole_.size(); ++cell) units.push_back(restore_cell(from, cell, samples));
  history_.read(from, units, samples);
}

std::size_t SensitivityCollector::restore_cell(ByteReader& from, std::size_t cell, std::size_t samples) {
  const std::uint64_t holds = from.number_up_to(kWhole | kPart);
  if (holds == 0) return 0;
  if (units_done(cell) > 0) throw BytesError("has a cell twice");
  if ((holds & kWhole) != 0) {
    whole_[cell] = UnitStats::read(from, responses_, 0);
    const std::uint64_t solves = whole_[cell].solves.total();
    if (solves == 0 || solves % Plan::kUnitSamples != 0 || solves > samples) {
      throw BytesError("has a cell that is no number of whole units");
    }
  }
  if ((holds & kPart) == 0) return units_of(whole_[cell].solves.total());
  UnitStats part = UnitStats::read(from, responses_, whole_[cell].solves.total());
  const std::uint64_t solves = part.solves.total();
  if (solves == 0 || solves >= Plan::kUnitSamples || whole_[cell].solves.total() + solves != samples) {
    throw BytesError("has a last unit of the wrong size");
  }
  if (samples == plan_->samples()) parts_[cell] = std::move(part);
  return units_of(samples);
}

}  // namespace poesy
