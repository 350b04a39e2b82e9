#include "models/assembly/error_frames.h"

#include <algorithm>

namespace poesy::assembly {

using Eigen::Index;

ErrorFrames::ErrorFrames(const AssemblyModel& model) : model_(&model) {
  for (const Limb& limb : model.assembly.limbs) {
    frames_.push_back(limb.chain.home);
    errors_.emplace_back(limb.chain.frames(), chain::FrameError<double>::Zero());
  }
}

const std::vector<std::vector<Transform>>& ErrorFrames::with(std::span<const double> errors,
                                                             std::span<const double> displacements) {
  for (auto& limb : errors_) std::ranges::fill(limb, chain::FrameError<double>::Zero());
  for (std::size_t f = 0; f < errors.size(); ++f) {
    for (const chain::ErrorTerm& term : model_->terms[f]) {
      errors_[term.limb][term.frame][static_cast<Index>(term.component)] += term.at(displacements) * errors[f];
    }
  }
  for (std::size_t e = 0; e < frames_.size(); ++e) {
    const chain::Limb& limb = model_->assembly.limbs[e].chain;
    for (std::size_t j = 0; j < limb.frames(); ++j) {
      frames_[e][j] = errors_[e][j].isZero(0.0) ? limb.home[j] : chain::frame_with_error(limb, j, errors_[e][j]);
    }
  }
  return frames_;
}

}  // namespace poesy::assembly
