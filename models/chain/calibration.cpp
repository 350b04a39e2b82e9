#include "models/chain/calibration.h"

#include <algorithm>
#include <utility>

#include "engine/base/contract.h"
#include "models/chain/platform_motion.h"
#include "models/chain/separation.h"

namespace poesy::chain {
namespace {

using Vector3 = lie::Vector3<double>;
using Screw = lie::Screw<double>;

class CalibratedEvaluator final : public Evaluator {
 public:
  CalibratedEvaluator(const DeformationModel& model, Fidelity fidelity, std::unique_ptr<Evaluator> uncorrected)
      : model_(model),
        fidelity_(fidelity),
        uncorrected_(std::move(uncorrected)),
        first_row_(
            static_cast<Eigen::Index>(responses_of(model).size() - platform_responses(*model.platform, 0).size())) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    uncorrected_->evaluate(samples, outcomes);
    const std::optional<lie::Matrix6<double>> left = left_by_drives(model_, samples.pose);
    if (!left || !left->allFinite()) {
      std::ranges::fill(outcomes.status, SolveStatus::singular);
      return;
    }
    const PlatformPoints points = *model_.platform_points(model_.joint_displacements(samples.pose));
    for (std::size_t b = 0; b < samples.count; ++b) correct(*left, points, b, outcomes);
  }

 private:
  /// Corrects the platform's responses of one sample. The responses are in the order of platform_responses().
  void correct(const lie::Matrix6<double>& left, const PlatformPoints& points, std::size_t sample,
               const OutcomeBlock& outcomes) const {
    const auto count = static_cast<Eigen::Index>(outcomes.status.size());
    const auto all = static_cast<Eigen::Index>(outcomes.responses.size()) / count;
    Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>> rows(
        outcomes.responses.data() + first_row_ * count + static_cast<Eigen::Index>(sample), all - first_row_,
        Eigen::InnerStride<>(count));
    Screw displacement;
    displacement << rows.segment<3>(3), rows.segment<3>(0);
    const Screw rest = left * displacement;
    const Vector3 theta = rest.head<3>();
    const Vector3 origin = rest.tail<3>();
    rows.head<8>() << origin, theta, origin.norm(), theta.norm();
    if (points.tool) {
      const Vector3 arm = *points.tool - points.platform.p;
      const bool linear = fidelity_ == Fidelity::first_order;
      const Vector3 tip = origin + (linear ? Vector3(theta.cross(arm)) : lie::moved_by_rotation<double>(theta, arm));
      rows.tail<4>() << tip, tip.norm();
    }
    if (usable(outcomes.status[sample]) && !rows.allFinite()) outcomes.status[sample] = SolveStatus::non_finite;
  }

  const DeformationModel& model_;
  Fidelity fidelity_;
  std::unique_ptr<Evaluator> uncorrected_;
  Eigen::Index first_row_;  ///< index of the platform's first response
};

}  // namespace

std::unique_ptr<Evaluator> calibrated_evaluator(const DeformationModel& model, const SolverOptions& options,
                                                Fidelity fidelity) {
  POESY_EXPECTS(model.platform && model.platform->points.size() >= 3);
  return std::make_unique<CalibratedEvaluator>(model, fidelity, deformation_evaluator(model, options, fidelity));
}

}  // namespace poesy::chain
