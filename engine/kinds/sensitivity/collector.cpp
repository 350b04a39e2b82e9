#include "engine/kinds/sensitivity/collector.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/base/contract.h"
#include "engine/run/evaluate_unit.h"

namespace poesy::sensitivity {
namespace {

void append(const Estimate& estimate, EstimateCourse& history) {
  history.value.push_back(estimate.value);
  history.ci_low.push_back(estimate.interval.low);
  history.ci_high.push_back(estimate.interval.high);
}

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

EstimateCourse HistoryCollector::history(const Result& end) const {
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

void HistoryCollector::state(Archive& archive, std::span<const std::size_t> units_done, std::size_t samples) {
  const auto points = static_cast<std::size_t>(std::ranges::upper_bound(points_, samples) - points_.begin());
  // If the study that wrote the indices had fewer samples than a whole unit, a longer study solves this unit again and
  // ignores these indices.
  const bool begins_longer = samples == plan_->samples() || samples >= Plan::kUnitSamples;
  const bool takes = archive.reads() && begins_longer;
  std::vector<LocalIndex> indices(responses_);
  for (std::size_t slot = 0; slot < plan_->slots(); ++slot) {
    for (std::size_t k = 0; k < points; ++k) {
      const std::vector<std::size_t> reached = poses_at(slot, k, units_done);
      if (reached.size() == poses()) {
        Look whole = looks_(slot, k);
        if (archive.reads()) whole = {.reached = poses(), .global = std::vector<Estimate>(responses_)};
        for (auto& [value, interval] : whole.global) archive.real(value, interval.low, interval.high);
        if (takes) looks_(slot, k) = std::move(whole);
        continue;
      }
      for (const std::size_t m : reached) {
        for (std::size_t r = 0; r < responses_ && !archive.reads(); ++r) indices[r] = looks_(slot, k).local(r, m);
        archive.object(indices);
        if (takes) add(slot * poses() + m, k, indices);
      }
    }
  }
}

Collector::Collector(const Plan& plan, std::size_t responses, double conf_level, const Shard& shard)
    : CellSums(plan, responses, shard), history_(plan, responses, conf_level) {}

void Collector::add(const WorkUnit& unit, const CellUnit& found) {
  CellSums::add(unit, found);
  history_.add(unit, found.within, store_of(unit).at(cell_of(unit) - cells_.first));
}

void Collector::state(Archive& archive, std::size_t samples) {
  const std::vector<std::size_t> units = CellSums::state(archive, samples);
  history_.state(archive, units, samples);
}

}  // namespace poesy::sensitivity
