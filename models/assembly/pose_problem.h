#pragma once

#include <optional>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/closure.h"
#include "models/assembly/equilibrium.h"
#include "models/assembly/kernel_problem.h"
#include "models/assembly/model.h"

namespace poesy::assembly {

/// An elementary joint of a limb.
struct JointPlace {
  std::size_t limb;   ///< position
  std::size_t joint;  ///< of the limb's joints

  /// Limb by limb.
  auto operator<=>(const JointPlace&) const = default;
};

/// What the kernel solves at one pose.
class PoseProblem {
 public:
  /// The model must outlive it.
  PoseProblem(const AssemblyModel& model, Nominal pose, const SolverOptions& options);

  const Nominal& pose() const { return pose_; }  ///< The perfect assembly.

  /// Whether loops close there. From the first call on the problem must stay where it is.
  Closure& closure() { return closure_ ? *closure_ : closure_.emplace(*model_, pose_); }

  /// Whether the linear equations of the nominal pose have a unique solution.
  bool is_regular() const { return coordinates_.allFinite(); }

  /// The problem with the errors of these samples, until the next call. scratch: for the values, if those of the
  /// samples are not what the kernel reads.
  const KernelProblem& with(const SampleBlock& samples, std::vector<double>& scratch);

  /// What the kernel reads since the last call of with(), [entries x padded(samples)].
  const double* values() const { return values_; }

  /// Whether starts are known of samples with the varied error, its range and
  /// the constant errors of these.
  bool has_starts(const SampleBlock& samples) const;

  /// Samples like these start by these series, see KernelStart; empty: by first
  /// order, as others do.
  void set_starts(const SampleBlock& samples, std::vector<double> coefficients);

 private:
  /// An entry of a frame's error, in rad or units of the reach.
  struct Entry {
    std::size_t limb;
    std::size_t frame;
    std::size_t component;  ///< of [omega; v]
    double constant = 0.0;  ///< what does not vary of it
    int row = -1;           ///< among the values; -1: it does not vary
    double unit = 1.0;      ///< by which its values are multiplied
  };

  /// Samples for which starts were computed.
  struct Started {
    FactorIndex factor;          ///< that varies
    double range;                ///< of it
    std::vector<double> errors;  ///< of samples
  };

  /// What an error adds to an entry.
  struct Addition {
    std::size_t entry;  ///< position
    double scale;       ///< in the entry's unit per unit of the error
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
  Transform frame_;                  ///< base_T_kernel
  std::vector<JointPlace> marks_;    ///< joints whose frames are reported
  std::vector<Entry> entries_;       ///< that errors have
  std::vector<Addition> additions_;  ///< of all errors, one error after the other
  std::vector<std::size_t> added_;   ///< [F + 1] where those of an error begin
  std::vector<std::size_t> first_;   ///< [limbs + 1] where the frames of a limb begin among all
  std::vector<KernelError> errors_;  ///< [frames of all limbs]
  Eigen::MatrixXd coordinates_;      ///< [coordinates x (entries + 1)] of a unit of each, and of the load
  const double* values_ = nullptr;   ///< see values()
  std::optional<Started> started_;   ///< of the last call of set_starts()
  KernelProblem problem_;
  std::optional<Closure> closure_;
};

/// A number of samples, filled up to whole batches.
std::size_t padded(std::size_t samples);

}  // namespace poesy::assembly
