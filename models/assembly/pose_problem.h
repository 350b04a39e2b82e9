#pragma once

#include <optional>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/closure.h"
#include "models/assembly/equilibrium.h"
#include "models/assembly/kernel_problem.h"
#include "models/assembly/model.h"

namespace poesy::assembly {

/// The indices that identify a joint of one freedom.
struct JointPlace {
  std::size_t limb;   ///< index of the limb
  std::size_t joint;  ///< index of the joint in the limb

  /// The order limb by limb, then joint by joint.
  auto operator<=>(const JointPlace&) const = default;
};

/// The problem that the kernels solve at one pose.
class PoseProblem {
 public:
  /// The model must outlive this object.
  PoseProblem(const AssemblyModel& model, Nominal pose, const SolverOptions& options);

  const Nominal& pose() const { return pose_; }  ///< The perfect assembly at the pose.

  /// The object that decides whether loops close at this pose. The problem must not be moved after the first call.
  Closure& closure() { return closure_ ? *closure_ : closure_.emplace(*model_, pose_); }

  /// Returns true if the linear equations of the nominal pose have a unique solution.
  bool is_regular() const { return coordinates_.allFinite(); }

  /// The problem with the errors of these samples, valid until the next call. scratch: receives the values of the
  /// varied components of frames' errors if the kernel cannot read them from the samples; must exist as long as the
  /// problem is used.
  const KernelProblem& with(const SampleBlock& samples, std::vector<double>& scratch);

  /// [varied components x padded(samples)] The values of the varied components of frames' errors, set by the last call
  /// of with().
  const double* values() const { return values_; }

  /// [6 x 6] The matrix from twists in the kernel's units and axes to twists in the base frame (rad, m).
  const Matrix6& twists_from_units() const { return from_units_; }

  /// Returns true if a Chebyshev series of starting points is known for samples with this varied error, range and
  /// constant errors.
  bool has_starts(const SampleBlock& samples) const;

  /// Sets the Chebyshev series of the starting points of samples like these; see KernelStart. If the series is empty,
  /// samples start from the first-order solution.
  void set_starts(const SampleBlock& samples, std::vector<double> coefficients);

 private:
  /// A component of a frame's error, in rad or units of the reach.
  struct Entry {
    std::size_t limb;
    std::size_t frame;
    std::size_t component;  ///< index in [omega; v]
    double constant = 0.0;  ///< part of the component that does not vary
    int row = -1;           ///< row of the component in the array values(); -1 if the component does not vary
    double unit = 1.0;      ///< factor from the numbers in this row to the component
  };

  /// The kind of samples for which a Chebyshev series of starting points was computed.
  struct Started {
    FactorIndex factor;          ///< the only varied error
    double range;                ///< half-width of the range of the varied error's values (SampleBlock::range)
    std::vector<double> errors;  ///< constant errors of the samples
  };

  /// The contribution of an error of the model to a component of a frame's error.
  struct Addition {
    std::size_t entry;  ///< index of the component in entries_
    double scale;       ///< change of the component, in its unit, per unit of the model's error
  };

  void find_entries();
  std::span<const Addition> additions(std::size_t f) const {
    return std::span(additions_).subspan(added_[f], added_[f + 1] - added_[f]);
  }
  int mark_of(const JointPlace& place) const;
  KernelJoint kernel_joint(const JointPlace& place, std::size_t passive) const;
  KernelMark kernel_mark(const JointPlace& place) const;
  void set_limb(const Equilibrium& equations, std::size_t e);
  void set_report();
  void set_own_matrices(const Equilibrium& equations);
  bool is_soft(const Equilibrium& equations) const;
  void set_idle(const Equilibrium& equations, std::size_t e, const Eigen::MatrixXd& weight);
  void solve_first_order(const Equilibrium& equations);
  Eigen::MatrixXd twists_of_entries(const Equilibrium& equations) const;
  static double* row_of(const Entry& entry, std::size_t stride, std::vector<double>& values);
  bool take_values(const SampleBlock& samples);
  void add_values(const SampleBlock& samples, std::vector<double>& values);
  void set_constants(const SampleBlock& samples);
  void set_segments(std::size_t e);
  void set_map();
  void use_starts(const SampleBlock& samples);

  const AssemblyModel* model_;
  Nominal pose_;
  Transform frame_;                  ///< frame of the kernel's axes, base_T_kernel
  Matrix6 from_units_;               ///< from twists in the kernel's units to twists in the base frame and SI
  std::vector<JointPlace> marks_;    ///< joints whose frames are reported
  std::vector<Entry> entries_;       ///< components of frames' errors that errors of the model change
  std::vector<Addition> additions_;  ///< contributions of the model's errors to entries_, ordered by error
  std::vector<std::size_t> added_;   ///< [errors + 1] index in additions_ at which each error's contributions begin
  std::vector<std::size_t> first_;   ///< [limbs + 1] index of each limb's first frame among all frames
  std::vector<KernelError> errors_;  ///< [frames of all limbs] error of each frame
  /// First-order coordinates (KernelMap), a row for each. Columns: change per unit of each of entries_, then the
  /// coordinates without errors.
  Eigen::MatrixXd coordinates_;
  const double* values_ = nullptr;  ///< see values()
  std::optional<Started> started_;  ///< samples of the last call of set_starts()
  KernelProblem problem_;
  std::optional<Closure> closure_;
};

/// The number of samples rounded up to whole batches.
std::size_t padded(std::size_t samples);

}  // namespace poesy::assembly
