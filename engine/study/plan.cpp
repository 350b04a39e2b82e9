#include "engine/study/plan.h"

#include <algorithm>
#include <utility>

#include "engine/base/contract.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

std::size_t slots_of(const Analysis& analysis) {
  POESY_EXPECTS(analysis.kind != nullptr);
  return analysis.kind->varies == Varies::together ? 1 : analysis.factors.size();
}

}  // namespace

Plan::Plan(const Study& study, PoseSet poses)
    : poses_(std::move(poses)),
      factors_(study.analysis.factors),
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
