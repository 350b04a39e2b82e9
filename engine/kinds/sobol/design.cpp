#include "engine/kinds/sobol/design.h"

#include <algorithm>

#include "engine/base/contract.h"
#include "engine/random/stream.h"

namespace poesy {

PanelDesign::PanelDesign(const Plan& plan, const SobolOptions& asked)
    : plan_(&plan),
      design_(asked.design),
      replicates_(independent() ? 1 : asked.replicates),
      samples_(plan.samples() / replicates_) {
  POESY_EXPECTS(samples_ * replicates_ == plan.samples());
}

std::size_t PanelDesign::units_per_replicate() const { return (samples_ + kUnitSamples - 1) / kUnitSamples; }

PanelUnit PanelDesign::unit(std::size_t n) const {
  POESY_EXPECTS(n < units());
  const std::size_t replicate = n / units_per_replicate();
  const std::size_t first = n % units_per_replicate() * kUnitSamples;
  return {replicate, first, std::min(kUnitSamples, samples_ - first), replicate * samples_ + first};
}

void PanelDesign::fill(PanelSample which, std::size_t slot, const PanelUnit& unit, std::span<double> uniforms) const {
  const Purpose purpose = which == PanelSample::A ? Purpose::error_samples : Purpose::second_error_samples;
  fill_uniforms({plan_->seed(), purpose, plan_->factors()[slot], PoseIndex(0)}, SampleIndex(unit.first), uniforms);
}

}  // namespace poesy
