#include "engine/kinds/sobol/design.h"

#include <algorithm>

#include "engine/base/contract.h"
#include "engine/random/stream.h"

namespace poesy::sobol {

namespace {

PanelPoints points_of(const Plan& plan, Design design, std::size_t samples) {
  if (design == Design::lhs) return LatinHypercube(samples, plan.seed());
  if (design == Design::sobol) return ScrambledSobol(2 * plan.factors().size(), plan.seed());
  return std::monostate();
}

}  // namespace

PanelDesign::PanelDesign(const Plan& plan, const Options& asked)
    : plan_(&plan),
      replicates_(asked.design == Design::random ? 1 : asked.replicates),
      samples_(plan.samples() / replicates_),
      points_(points_of(plan, asked.design, samples_)) {
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
  // An error has two adjacent dimensions of the points, for its values in the samples A and B. Errors that come first
  // in the study get the first dimensions, in which Sobol' points are distributed best.
  const std::size_t dimension = 2 * slot + (which == PanelSample::A ? 0 : 1);
  const DesignColumn column{dimension, unit.replicate};
  const SampleIndex first(unit.first);
  if (const auto* const cube = std::get_if<LatinHypercube>(&points_)) {
    cube->fill(column, first, uniforms);
  } else if (const auto* const points = std::get_if<ScrambledSobol>(&points_)) {
    points->fill(column, first, uniforms);
  } else {
    StreamAddress address = plan_->address(slot, PoseIndex(0));
    if (which == PanelSample::B) address.purpose = Purpose::second_error_samples;
    fill_uniforms(address, first, uniforms);
  }
}

}  // namespace poesy::sobol
