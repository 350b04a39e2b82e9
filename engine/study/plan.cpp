#include "engine/study/plan.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "engine/base/contract.h"
#include "engine/random/normal_quantile.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

std::size_t slots_of(const Analysis& analysis) {
  POESY_EXPECTS(analysis.kind != nullptr);
  return analysis.kind->varies == Varies::together ? 1 : analysis.factors.size();
}

/// The indices of these factors in the list of factors that the analysis varies. Precondition: the analysis varies all
/// of them.
std::vector<std::size_t> slots_of(std::span<const FactorIndex> factors, const Analysis& analysis) {
  std::vector<std::size_t> slots;
  for (const FactorIndex factor : factors) {
    const auto place = std::ranges::find(analysis.factors, factor);
    POESY_EXPECTS(place != analysis.factors.end());
    slots.push_back(static_cast<std::size_t>(place - analysis.factors.begin()));
  }
  return slots;
}

std::vector<CorrelatedSlots> correlated_slots(const Study& study) {
  std::vector<CorrelatedSlots> blocks;
  if (study.analysis.kind->varies != Varies::together) return blocks;
  for (const CorrelatedErrors& block : study.errors.correlated) {
    blocks.push_back({slots_of(block.factors, study.analysis), NormalCopula(block.correlation)});
  }
  return blocks;
}

std::vector<ZoneSlots> zone_slots(const Study& study) {
  std::vector<ZoneSlots> blocks;
  for (const Feature& feature : features_drawn_together(study)) {
    blocks.push_back({slots_of(feature.errors(), study.analysis), {feature, *study.errors.zones}});
  }
  return blocks;
}

/// [rows of the table of machines] The uniforms that the distribution of the error (Distribution::given) converts to
/// the values that given machines have. Empty if the error is drawn.
std::vector<double> given_uniforms(const ErrorModel& errors, FactorIndex factor) {
  if (errors.by_factor[factor.value].shape() != Distribution::Shape::given) return {};
  const std::vector<double> values = errors.machines->column(factor);
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t row) { return values[row]; });
  std::vector<double> uniforms(values.size());
  for (std::size_t place = 0; place < order.size(); ++place) {
    uniforms[order[place]] = (static_cast<double>(place) + 0.5) / static_cast<double>(values.size());
  }
  return uniforms;
}

}  // namespace

Plan::Plan(const Study& study, PoseSet poses)
    : poses_(std::move(poses)),
      factors_(study.analysis.factors),
      correlated_(correlated_slots(study)),
      zones_(zone_slots(study)),
      background_(background_errors(study.analysis.background, study.model())),
      slots_(slots_of(study.analysis)),
      samples_(study.analysis.samples),
      adaptive_(study.analysis.adaptive),
      units_per_cell_(units_for(samples_)),
      seed_(study.seed),
      draws_(study.analysis.draws),
      solver_(study.solver),
      not_converged_(study.not_converged) {
  for (const FactorIndex factor : factors_) background_[factor.value] = 0.0;
  distributions_.reserve(factors_.size());
  for (const FactorIndex factor : factors_) distributions_.push_back(study.errors.by_factor[factor.value]);
  for (std::size_t slot = 0; slot < factors_.size() && draws_ == Draws::per_machine; ++slot) {
    if (study.errors.is_per_pose(factors_[slot])) per_pose_.push_back(slot);
  }
  for (const FactorIndex factor : factors_) given_.push_back(given_uniforms(study.errors, factor));
}

void Plan::draw_uniforms(std::size_t slot, PoseIndex pose, SampleIndex first, std::span<double> row) const {
  const std::vector<double>& given = given_[slot];
  if (given.empty()) return fill_uniforms(address(slot, pose), first, row);
  POESY_EXPECTS(first.value + row.size() <= given.size());
  std::ranges::copy(std::span(given).subspan(first.value, row.size()), row.begin());
}

bool Plan::is_per_pose(std::size_t slot) const { return std::ranges::binary_search(per_pose_, slot); }

bool Plan::is_correlated(std::size_t slot) const {
  return std::ranges::any_of(correlated_, [&](const CorrelatedSlots& block) {
    return std::ranges::find(block.slots, slot) != block.slots.end();
  });
}

bool Plan::is_drawn_alone(std::size_t slot) const {
  return !is_correlated(slot) && std::ranges::none_of(zones_, [&](const ZoneSlots& feature) {
    return std::ranges::find(feature.slots, slot) != feature.slots.end();
  });
}

template <class Chosen>
void Plan::transform_if(std::span<double> uniforms, std::size_t count, const Chosen& is_chosen) const {
  POESY_EXPECTS(uniforms.size() == factors_.size() * count);
  const auto row = [&](std::size_t slot) { return uniforms.subspan(slot * count, count); };
  std::vector<std::span<double>> rows;
  for (const CorrelatedSlots& block : correlated_) {
    if (!is_chosen(block.slots.front())) continue;
    rows.clear();
    for (const std::size_t slot : block.slots) {
      normal_quantiles(1.0, row(slot));
      rows.push_back(row(slot));
    }
    block.copula.correlate(rows);
    for (const std::size_t slot : block.slots) distributions_[slot].transform_scores(row(slot));
  }
  for (const ZoneSlots& feature : zones_) {
    if (!is_chosen(feature.slots.front())) continue;
    rows.clear();
    for (const std::size_t slot : feature.slots) rows.push_back(row(slot));
    feature.draws.transform(rows);
  }
  for (std::size_t slot = 0; slot < factors_.size(); ++slot) {
    if (is_chosen(slot) && is_drawn_alone(slot)) distributions_[slot].transform(row(slot));
  }
}

void Plan::transform(std::span<double> uniforms, std::size_t count) const {
  transform_if(uniforms, count, [](std::size_t) { return true; });
}

void Plan::transform_per_pose(std::span<double> uniforms, std::size_t count) const {
  transform_if(uniforms, count, [&](std::size_t slot) { return is_per_pose(slot); });
}

Plan Plan::with_samples(std::size_t samples) const {
  Plan plan = *this;
  plan.samples_ = samples;
  plan.units_per_cell_ = units_for(samples);
  return plan;
}

WorkUnit Plan::unit(std::size_t u) const {
  POESY_EXPECTS(u < units());
  const std::size_t cell = u / units_per_cell_;
  const std::size_t first = first_sample(u % units_per_cell_);
  return {cell / poses_.size(), PoseIndex(cell % poses_.size()), SampleIndex(first),
          std::min(kUnitSamples, samples_ - first)};
}

std::uint64_t Plan::solves() const {
  return std::uint64_t{slots_} * std::uint64_t{poses_.size()} * std::uint64_t{samples_};
}

std::vector<std::size_t> milestones(std::size_t min, std::size_t max) {
  std::vector<std::size_t> list;
  std::size_t units = Plan::units_for(min);
  while (units * Plan::kUnitSamples < max) {
    list.push_back(units * Plan::kUnitSamples);
    units += (units + 1) / 2;
  }
  return list;
}

}  // namespace poesy
