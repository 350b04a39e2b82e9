#include "models/assembly/calibration.h"

#include <algorithm>
#include <map>
#include <utility>

#include "engine/linalg/decompositions.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;

/// A drive counts as unable to correct anything if it moves the platform by at most this share of the largest motion
/// that any drive causes.
constexpr double kNothing = 1e-9;

Index index(std::size_t value) { return static_cast<Index>(value); }

/// [6 limbs x drives] The twists of the limbs' ends per unit displacement of each drive. A drive moves all its joints.
Matrix driven_twists(const AssemblyModel& model, const Nominal& at) {
  const Index rows = 6 * index(at.limbs.size());
  Matrix twists(rows, 0);
  std::map<std::size_t, Index> shared;  // column of each drive that moves several joints
  for (std::size_t e = 0; e < at.limbs.size(); ++e) {
    const std::vector<chain::Joint>& joints = model.assembly.limbs[e].chain.joints;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (!joints[j].actuated || joints[j].fixed) continue;
      const auto known = joints[j].drive == 0 ? shared.end() : shared.find(joints[j].drive);
      const Index column = known == shared.end() ? twists.cols() : known->second;
      if (column == twists.cols()) {
        twists.conservativeResize(Eigen::NoChange, column + 1);
        twists.col(column).setZero();
        if (joints[j].drive > 0) shared[joints[j].drive] = column;
      }
      twists.block<6, 1>(6 * index(e), column) += at.limbs[e].twist(joints[j], j);
    }
  }
  return twists;
}

/// [6 bodies x 6] The matrix from the uncorrected twist of the platform to the twists that the best correction
/// subtracts from the uncorrected twists of all bodies.
Matrix taken_by_drives(const AssemblyModel& model, const Nominal& at) {
  const FirstOrder first_order(model.assembly, at, model.ranks);
  Matrix moved = first_order.effect(driven_twists(model, at)).twists;
  const Matrix6 root = linalg::cholesky_root(at.W);
  Matrix measured = root * moved.middleRows<6>(6 * index(kPlatform));
  const Eigen::RowVectorXd lengths = measured.colwise().norm();
  for (Index d = 0; d < measured.cols(); ++d) {
    const double scale = lengths[d] > kNothing * lengths.maxCoeff() ? 1.0 / lengths[d] : 0.0;
    measured.col(d) *= scale;
    moved.col(d) *= scale;
  }
  return moved * linalg::pseudo_inverse(measured) * root;
}

/// The nominal state and the correction at one pose.
struct Correction {
  Nominal at;
  Matrix taken;  ///< matrix of taken_by_drives()
};

/// Access to the responses of one sample that describe the displacement of one body.
class Rows {
 public:
  /// first: row of the displacement of the body's origin along x.
  Rows(const OutcomeBlock& outcomes, std::size_t first, std::size_t sample)
      : value_(outcomes.responses.data() + first * outcomes.status.size() + sample), stride_(outcomes.status.size()) {}

  double& operator[](std::size_t row) { return value_[row * stride_]; }
  Vector3 triple(std::size_t row) { return {(*this)[row], (*this)[row + 1], (*this)[row + 2]}; }
  void set(std::size_t row, const Vector3& values) {
    for (std::size_t k = 0; k < 3; ++k) (*this)[row + k] = values[index(k)];
  }

 private:
  double* value_;
  std::size_t stride_;
};

class CalibratedEvaluator final : public Evaluator {
 public:
  CalibratedEvaluator(const AssemblyModel& model, chain::Fidelity fidelity, std::unique_ptr<Evaluator> uncorrected)
      : model_(&model), fidelity_(fidelity), uncorrected_(std::move(uncorrected)) {
    std::size_t row = model.deforms ? kDeformations : 0;
    for (std::size_t b = kPlatform; b < model.assembly.bodies.size(); ++b) {
      first_rows_.push_back(row);
      row += 8 + (b == kPlatform && model.assembly.tool ? 4 : 0);
    }
  }

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    uncorrected_->evaluate(samples, outcomes);
    const Correction& correction = correction_at(samples.pose);
    if (!correction.taken.allFinite()) {
      std::ranges::fill(outcomes.status, SolveStatus::singular);
      return;
    }
    for (std::size_t b = 0; b < samples.count; ++b) correct(correction.taken, correction.at, b, outcomes);
  }

 private:
  /// All corrections are discarded when more poses than this are stored.
  static constexpr std::size_t kMostPoses = 256;

  const Correction& correction_at(std::span<const double> pose) {
    if (corrections_.size() > kMostPoses) corrections_.clear();
    std::vector<double> key(pose.begin(), pose.end());
    const auto known = corrections_.find(key);
    if (known != corrections_.end()) return known->second;
    Nominal at = model_->at(pose);
    Matrix taken = taken_by_drives(*model_, at);
    return corrections_.emplace(std::move(key), Correction{std::move(at), std::move(taken)}).first->second;
  }

  void correct(const Matrix& taken, const Nominal& at, std::size_t sample, const OutcomeBlock& outcomes) const {
    Rows platform(outcomes, first_rows_.front(), sample);
    Screw twist;  // twist of the platform about the base's origin
    twist.head<3>() = platform.triple(3);
    twist.tail<3>() = platform.triple(0) - Vector3(twist.head<3>()).cross(at.bodies[kPlatform].p);
    const Eigen::VectorXd by_drives = taken * twist;
    bool is_finite = true;
    for (std::size_t n = 0; n < first_rows_.size(); ++n) {
      const std::size_t body = kPlatform + n;
      Rows rows(outcomes, first_rows_[n], sample);
      const Vector3 turned = by_drives.segment<3>(6 * index(body));
      const Vector3 moved = Vector3(by_drives.segment<3>(6 * index(body) + 3)) + turned.cross(at.bodies[body].p);
      set(rows, rows.triple(0) - moved, rows.triple(3) - turned);
      is_finite = is_finite && rows.triple(0).allFinite() && rows.triple(3).allFinite();
    }
    if (model_->assembly.tool) set_tool(platform, at.bodies[kPlatform].R * *model_->assembly.tool);
    if (usable(outcomes.status[sample]) && !is_finite) outcomes.status[sample] = SolveStatus::non_finite;
  }

  static void set(Rows& rows, const Vector3& moved, const Vector3& theta) {
    rows.set(0, moved);
    rows.set(3, theta);
    rows[6] = moved.norm();
    rows[7] = theta.norm();
  }

  void set_tool(Rows& platform, const Vector3& arm) const {
    const Vector3 theta = platform.triple(3);
    const Vector3 by_turn = fidelity_ == chain::Fidelity::first_order ? Vector3(theta.cross(arm))
                                                                      : lie::moved_by_rotation<double>(theta, arm);
    const Vector3 tip = platform.triple(0) + by_turn;
    platform.set(8, tip);
    platform[11] = tip.norm();
  }

  const AssemblyModel* model_;
  chain::Fidelity fidelity_;
  std::unique_ptr<Evaluator> uncorrected_;
  std::vector<std::size_t> first_rows_;                    ///< first response row of each body except the base
  std::map<std::vector<double>, Correction> corrections_;  ///< corrections by pose
};

}  // namespace

std::unique_ptr<Evaluator> calibrated_evaluator(const AssemblyModel& model, const SolverOptions& options,
                                                chain::Fidelity fidelity) {
  return std::make_unique<CalibratedEvaluator>(model, fidelity, assembly_evaluator(model, options, fidelity));
}

}  // namespace poesy::assembly
