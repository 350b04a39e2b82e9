#include "models/file/published_model.h"

#include <algorithm>
#include <utility>

#include "models/chain/calibration.h"
#include "models/chain/deformation_model.h"
#include "models/chain/deformation_trace.h"
#include "models/chain/nominal.h"
#include "models/chain/passive_condition.h"
#include "models/chain/separation.h"
#include "models/chain/sketch.h"
#include "models/file/pose_tracker.h"
#include "models/file/structure.h"

namespace poesy::file {
namespace {

/// Returns a function that gives the displacements of joints and fixed frames at a pose.
std::function<std::vector<double>(std::span<const double>)> displacements_by(const Mechanism& mechanism,
                                                                             std::shared_ptr<const PoseTracker> tracker,
                                                                             const chain::ParallelChain& chain) {
  if (!chain.rounded) {
    return [mechanism, tracker = std::move(tracker)](std::span<const double> pose) {
      return with_fixed(mechanism, tracker->track(pose).displacements);
    };
  }
  return [mechanism, tracker = std::move(tracker), chain](std::span<const double> pose) {
    return chain::settled(chain, with_fixed(mechanism, tracker->track(pose).displacements));
  };
}

chain::DeformationModel chain_model(const Mechanism& mechanism, std::shared_ptr<const PoseTracker> tracker,
                                    const Mobility& home) {
  chain::DeformationModel model;
  const std::vector<std::size_t> drives = shared_drives(mechanism);
  std::span<const std::size_t> left = drives;
  for (const Limb& limb : mechanism.limbs) {
    model.chain.limbs.push_back(chain_limb(limb, mechanism.errors_at_joints, left));
  }
  model.chain.pairs = chain::pairs_of(mechanism.limbs.size());
  model.chain.idle = home.idle;
  model.terms = mechanism.terms;
  model.held_at = mechanism.points;
  model.chain.rounded = mechanism.precision.rounded();
  model.joint_displacements = displacements_by(mechanism, std::move(tracker), model.chain);
  model.platform = chain::PlatformReport{mechanism.tool, mechanism.points};
  return model;
}

/// The largest deformation without errors, over poses of the workspace. Only rounded numbers cause it.
double nominal_deformation(const Mechanism& mechanism, const chain::DeformationModel& model, std::size_t response) {
  const std::vector<double> no_errors(model.terms.size(), 0.0);
  double largest = 0.0;
  for (const PoseMobility& pose : workspace_mobility(mechanism)) {
    if (!pose.reached()) continue;
    largest = std::max(largest, chain::first_order_trace(model, pose.pose, no_errors).responses[response]);
  }
  return largest;
}

class PublishedModel final : public TrackedModel {
 public:
  PublishedModel(const MechanismFile& file, Checked found, chain::Fidelity fidelity)
      : TrackedModel(file, found), model_(chain_model(mechanism(), tracker(), found.home)), fidelity_(fidelity) {
    set_responses(chain::responses_of(model_));
    ModelDescription& description = described();
    description.separation = chain::separation_description(model_);
    description.metric = "published";
    description.tolerance = SolverOptions().tolerance;
    DeformationMeasure measure = chain::deformation_measure(model_);
    if (model_.chain.rounded) {
      measure.rounding =
          std::max(measure.rounding, kNominalShare * nominal_deformation(mechanism(), model_, measure.response));
    }
    description.deformation = measure;
    description.details = chain::deformation_details(model_.chain.pairs);
  }

  double condition(std::span<const double> pose) const override {
    return chain::passive_condition(model_.chain, model_.joint_displacements(pose));
  }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return chain::deformation_evaluator(model_, options, fidelity_);
  }

  std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& options) const override {
    return chain::calibrated_evaluator(model_, options, fidelity_);
  }

  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    if (fidelity_ == chain::Fidelity::first_order) return chain::first_order_trace(model_, pose, errors);
    return chain::deformation_trace(model_, pose, errors, options);
  }

  lie::Matrix3<double> orientation(std::span<const double> pose) const override {
    if (pose.empty()) return mechanism().platform.R;
    return model_.platform_points(model_.joint_displacements(pose))->platform.R;
  }

  std::optional<Sketch> sketch(std::span<const double> pose) const override {
    Sketch sketch = sketch_of(mechanism());
    chain::place(sketch, model_,
                 pose.empty() ? std::vector(model_.chain.joints(), 0.0) : model_.joint_displacements(pose));
    return sketch;
  }

  double rounding(std::size_t /*response*/) const override { return chain::effect_rounding(model_); }

  std::vector<double> norm_of_details(std::size_t response, std::span<const double> /*pose*/) const override {
    return chain::norm_of_details(model_, response);
  }

  Separation separation(std::span<const double> pose) const override { return chain::separation(model_, pose); }

 private:
  /// With errors, the deformation that rounded numbers cause changes by less than this factor.
  static constexpr double kNominalShare = 2.0;

  chain::DeformationModel model_;
  chain::Fidelity fidelity_;
};

}  // namespace

std::unique_ptr<TrackedModel> published_model(const MechanismFile& file, Checked found, chain::Fidelity fidelity) {
  return std::make_unique<PublishedModel>(file, std::move(found), fidelity);
}

}  // namespace poesy::file
