#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/responses.h"
#include "models/chain/deformation_model.h"

namespace poesy::assembly {

/// An assembly as a model. Its responses are displacements, mismatch, energy and forces.
struct AssemblyModel {
  Assembly assembly;                     ///< perfect limbs that connect bodies
  Report report;                         ///< choice of responses
  std::vector<chain::ErrorTerms> terms;  ///< [errors] components of frames' errors that each error changes
  std::vector<std::size_t> ranks;        ///< [limbs] rank of the columns of each limb's passive joints
  std::size_t idle = 0;                  ///< number of motions of passive joints that move no body
  bool deforms = true;                   ///< true if limbs deform each other or have stiffness, so mismatch is reported
  bool over_constrained = true;          ///< true if limbs deform each other
  /// True if the file's numbers are rounded, so that perfect limbs fit their bodies only approximately.
  bool rounded = false;
  /// Pairs of limbs whose mismatch is an additional output (Detail in engine/model/model.h). All these limbs lead from
  /// the base to the platform. Empty if there are no additional outputs.
  std::vector<chain::LimbPair> pairs = {};
  double stiffness = 0.0;  ///< largest_stiffness() at the home pose (N/m); 0 if limbs have no stiffness
  /// Returns the nominal displacements of all joints at a reachable pose, limb by limb (rad, m).
  std::function<std::vector<double>(std::span<const double> pose)> joint_displacements;

  /// The perfect assembly at a reachable pose. If the file's numbers are rounded, this is the state in which the
  /// perfect limbs are in equilibrium.
  Nominal at(std::span<const double> pose) const;
};

/// The twist of a limb's end that one term of an error causes, per unit of the error.
Screw term_twist(const AssemblyModel& model, const Nominal& pose, const chain::ErrorTerm& term);

/// The matrix G [6 limbs x errors] of the twists of limbs' ends per unit of each error, with all joints held.
Eigen::MatrixXd error_twists(const AssemblyModel& model, const Nominal& pose);

/// All responses of the model.
std::vector<Response> responses_of(const AssemblyModel& model);

/// An evaluator that solves blocks of samples exactly or to first order. The model must outlive the evaluator.
std::unique_ptr<Evaluator> assembly_evaluator(const AssemblyModel& model, const SolverOptions& options,
                                              chain::Fidelity fidelity);

/// The trace of one solve, step by step. pose: reachable, SI. errors: one for each error of the model, SI.
SolveTrace assembly_trace(const AssemblyModel& model, std::span<const double> pose, std::span<const double> errors,
                          const SolverOptions& options, chain::Fidelity fidelity);

/// The condition number (2-norm) of the passive joints, without idle freedoms. It is computed from the columns of B
/// (motion_columns()) that belong to passive joints. They are weighed by the platform's metric, the part that motions
/// of bodies can produce is subtracted, and each column is scaled to length 1. The number is infinite if the matrix of
/// these columns is rank-deficient to rounding.
double condition(const AssemblyModel& model, std::span<const double> pose);

/// A spherical joint without a drive.
struct PassiveBall {
  std::size_t limb;    ///< index of its limb
  std::size_t column;  ///< index, among the passive joints of all limbs, of the first of its three revolute joints
};

/// Returns true if B (motion_columns()) loses rank between two poses. The columns of a ball are first replaced by those
/// of rotations about the base's axes, because its own three axes align in poses that are not singular. B is bordered
/// by its null spaces at the first pose (over-constraints and idle freedoms), and the signs of the determinants of the
/// bordered matrices are compared. None if the null spaces at both poses differ much, or if the axes of a ball are
/// nearly aligned at a pose, because the signs then say nothing.
std::optional<bool> are_separated(const AssemblyModel& model, std::span<const PassiveBall> balls,
                                  std::span<const double> one, std::span<const double> other);

/// The largest component of the force in any limb per unit displacement of the end of any limb, at this pose (N/m).
double largest_stiffness(const AssemblyModel& model, const Nominal& pose);

/// The largest standard deviation of a response (SI) that may be rounding instead of an effect. 0 for an energy.
double effect_rounding(const AssemblyModel& model, const Response& response);

}  // namespace poesy::assembly
