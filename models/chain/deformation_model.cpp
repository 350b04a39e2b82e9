#include "models/chain/deformation_model.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "models/chain/deformation_solver.h"

namespace poesy::chain {
namespace {

constexpr std::size_t kResponses = 3;

std::array<double, kResponses> responses_of(std::span<const double> delta_mu) {
  double angular = 0.0;
  double linear = 0.0;
  double largest = 0.0;
  const std::size_t pairs = delta_mu.size() / 6;
  for (std::size_t n = 0; n < pairs; ++n) {
    const Eigen::Map<const lie::Screw<double>> screw(delta_mu.data() + 6 * n);
    angular += screw.head<3>().norm();
    linear += screw.tail<3>().norm();
    largest = std::max(largest, screw.norm());
  }
  const auto count = static_cast<double>(pairs);
  return {angular / count, linear / count, largest};
}

class DeformationEvaluator final : public Evaluator {
 public:
  DeformationEvaluator(const DeformationModel& model, const SolverOptions& options)
      : model_(&model),
        solver_(model.chain, options),
        errors_(model.chain.frames()),
        frames_(model.chain.frames()),
        displacements_(model.chain.joints()),
        delta_mu_(6 * model.chain.pairs.size()) {
    for (std::size_t i = 0; i < model.chain.limbs.size(); ++i) {
      first_frame_.push_back(limb_of_.size());
      limb_of_.insert(limb_of_.end(), model.chain.limbs[i].frames(), i);
    }
  }

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    POESY_EXPECTS(samples.values.size() == samples.varied.size() * samples.count);
    POESY_EXPECTS(outcomes.responses.size() == kResponses * samples.count);
    const std::vector<double> nominal = model_->joint_displacements(samples.pose);
    set_constant_errors(samples);
    for (std::size_t b = 0; b < samples.count; ++b) {
      set_varied_errors(samples, b);
      std::copy(nominal.begin(), nominal.end(), displacements_.begin());
      const Deformation found = solver_.solve(frames_, displacements_, delta_mu_);
      store(found, samples.count, b, outcomes);
    }
  }

 private:
  std::size_t frame_of(const ErrorSlot& slot) const { return first_frame_[slot.limb] + slot.frame; }

  void update_frame(std::size_t frame) {
    const std::size_t limb = limb_of_[frame];
    frames_[frame] = frame_with_error(model_->chain.limbs[limb], frame - first_frame_[limb], errors_[frame]);
  }

  void set_constant_errors(const SampleBlock& samples) {
    for (auto& error : errors_) error.setZero();
    for (std::size_t f = 0; f < model_->slots.size(); ++f) {
      const ErrorSlot& slot = model_->slots[f];
      errors_[frame_of(slot)][static_cast<Eigen::Index>(slot.component)] = samples.errors[f];
    }
    for (std::size_t frame = 0; frame < frames_.size(); ++frame) update_frame(frame);
    varied_frames_.clear();
    for (const FactorIndex factor : samples.varied) varied_frames_.push_back(frame_of(model_->slots[factor.value]));
    std::sort(varied_frames_.begin(), varied_frames_.end());
    varied_frames_.erase(std::unique(varied_frames_.begin(), varied_frames_.end()), varied_frames_.end());
  }

  void set_varied_errors(const SampleBlock& samples, std::size_t b) {
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      const ErrorSlot& slot = model_->slots[samples.varied[v].value];
      errors_[frame_of(slot)][static_cast<Eigen::Index>(slot.component)] = samples.values[v * samples.count + b];
    }
    for (const std::size_t frame : varied_frames_) update_frame(frame);
  }

  void store(const Deformation& found, std::size_t count, std::size_t b, const OutcomeBlock& outcomes) const {
    const auto responses = responses_of(delta_mu_);
    for (std::size_t r = 0; r < kResponses; ++r) outcomes.responses[r * count + b] = responses[r];
    outcomes.status[b] = found.status;
    outcomes.iterations[b] = found.iterations;
    if (outcomes.details.empty()) return;
    for (std::size_t d = 0; d < delta_mu_.size(); ++d) outcomes.details[d * count + b] = delta_mu_[d];
  }

  const DeformationModel* model_;
  DeformationSolver solver_;
  std::vector<std::size_t> first_frame_;  ///< per limb
  std::vector<std::size_t> limb_of_;      ///< per frame
  std::vector<FrameError<double>> errors_;
  std::vector<lie::Transform<double>> frames_;
  std::vector<std::size_t> varied_frames_;
  std::vector<double> displacements_;
  std::vector<double> delta_mu_;
};

}  // namespace

std::vector<Response> deformation_responses() {
  return {{"angular_deformation", Dimension::angle,
           "average angular comprehensive deformation of the limbs (Du et al. 2022, Eq. 49)"},
          {"linear_deformation", Dimension::length,
           "average linear comprehensive deformation of the limbs (Du et al. 2022, Eq. 50)"},
          {"deformation_max", Dimension::number,
           "largest norm of a residual screw, rad and m mixed (Du et al. 2022, Eq. 45)"}};
}

std::vector<Detail> deformation_details(const ParallelChain& chain) {
  std::vector<Detail> details;
  for (const LimbPair& pair : chain.pairs) {
    const std::string k = std::to_string(pair.k + 1);
    const std::string i = std::to_string(pair.i + 1);
    details.push_back({"delta_mu_" + k + i,
                       {"omega_x", "omega_y", "omega_z", "v_x", "v_y", "v_z"},
                       "rad,rad,rad,m,m,m",
                       "end-pose deviation of limb " + k + " from limb " + i +
                           ", screw in the base frame (Du et al. 2022, Eqs. 30, 46)"});
  }
  return details;
}

std::unique_ptr<Evaluator> deformation_evaluator(const DeformationModel& model, const SolverOptions& options) {
  return std::make_unique<DeformationEvaluator>(model, options);
}

}  // namespace poesy::chain
