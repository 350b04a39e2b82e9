#include "bench/reference_model.h"

#include <algorithm>

#include "models/chain/deformation_solver.h"
#include "models/two_upr_rpu/errors.h"
#include "models/two_upr_rpu/kinematics.h"

namespace poesy::bench {
namespace {

class ReferenceEvaluator final : public Evaluator {
 public:
  ReferenceEvaluator(const chain::DeformationModel& model, const SolverOptions& options)
      : model_(&model),
        solver_(model.chain, options),
        errors_(model.chain.frames()),
        frames_(model.chain.frames()),
        displacements_(model.chain.joints()),
        delta_mu_(6 * model.chain.pairs.size()) {
    for (auto& error : errors_) error.setZero();
    for (std::size_t i = 0; i < model.chain.limbs.size(); ++i) {
      first_frame_.push_back(limb_of_.size());
      limb_of_.insert(limb_of_.end(), model.chain.limbs[i].frames(), i);
    }
  }

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    const std::vector<double> nominal = model_->joint_displacements(samples.pose);
    for (std::size_t f = 0; f < model_->terms.size(); ++f) set(f, samples.errors[f]);
    for (std::size_t frame = 0; frame < frames_.size(); ++frame) update(frame);
    for (std::size_t b = 0; b < samples.count; ++b) {
      for (std::size_t v = 0; v < samples.varied.size(); ++v) {
        update(set(samples.varied[v].value, samples.values[v * samples.count + b]));
      }
      std::ranges::copy(nominal, displacements_.begin());
      const chain::Deformation found = solver_.solve(frames_, displacements_, delta_mu_);
      outcomes.status[b] = found.status;
      outcomes.iterations[b] = found.iterations;
      judge(outcomes.responses.subspan(b), samples.count);
    }
  }

 private:
  /// Sets the value (SI) of an error. Returns the index, among the frames of all limbs, of the frame that has the
  /// error.
  std::size_t set(std::size_t factor, double value) {
    const chain::ErrorTerm& term = model_->terms[factor].front();
    const std::size_t frame = first_frame_[term.limb] + term.frame;
    errors_[frame][static_cast<Eigen::Index>(term.component)] = value;
    return frame;
  }

  void update(std::size_t frame) {
    const std::size_t limb = limb_of_[frame];
    frames_[frame] = frame_with_error(model_->chain.limbs[limb], frame - first_frame_[limb], errors_[frame]);
  }

  /// Computes the responses of one sample from the residual delta_mu_ (Du et al. 2022, Eqs. 45-50). column: begins with
  /// the first response of the sample; the others follow at distances of `stride` numbers.
  void judge(std::span<double> column, std::size_t stride) const {
    double angular = 0.0, linear = 0.0, largest = 0.0;
    const std::size_t pairs = delta_mu_.size() / 6;
    for (std::size_t n = 0; n < pairs; ++n) {
      const Eigen::Map<const lie::Screw<double>> screw(delta_mu_.data() + 6 * n);
      angular += screw.head<3>().norm();
      linear += screw.tail<3>().norm();
      largest = std::max(largest, screw.norm());
    }
    column[0] = angular / static_cast<double>(pairs);
    column[stride] = linear / static_cast<double>(pairs);
    column[2 * stride] = largest;
  }

  const chain::DeformationModel* model_;
  chain::DeformationSolver solver_;
  std::vector<std::size_t> first_frame_;  ///< [limbs] index of each limb's first frame among the frames of all limbs
  std::vector<std::size_t> limb_of_;      ///< [frames of all limbs] index of the limb to which each frame belongs
  std::vector<chain::FrameError<double>> errors_;
  std::vector<lie::Transform<double>> frames_;
  std::vector<double> displacements_;
  std::vector<double> delta_mu_;
};

}  // namespace

ReferenceModel::ReferenceModel(const Model& model)
    : model_(&model),
      deformation_{two_upr_rpu::parallel_chain({}), two_upr_rpu::error_terms(),
                   [&model](std::span<const double> pose) { return model.joint_displacements(pose); }} {}

std::unique_ptr<Evaluator> ReferenceModel::evaluator(const SolverOptions& options) const {
  return std::make_unique<ReferenceEvaluator>(deformation_, options);
}

}  // namespace poesy::bench
