#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {

/// Number of responses that are components of vectors. These components have the order of the first nine rows of
/// Effects.
inline constexpr std::size_t kComponents = 9;
inline constexpr std::size_t kResponses = kComponents + 3;

/// The responses of all evaluators below. First come nine components in the base frame: `theta_x`, `theta_y`, `theta_z`
/// (rotation vector of the platform, rad), `x`, `y`, `z` (displacement of P, m), `tip_x`, `tip_y`, `tip_z`
/// (displacement of the tool tip, m). Then come the norms of these three vectors: `rotation`, `position`,
/// `tip_position`.
std::vector<Response> responses();

/// The only additional output (Detail in model/model.h), `swing`: the additional swings dphi_i of the three rods (rad).
std::vector<Detail> details();

/// Levels of accuracy of a solve, in the order of ModelDescription::fidelities.
enum class Fidelity : std::size_t {
  /// The closure of all limbs for errors and rotations of finite size (ClosureSolver), which starts from the
  /// first-order motion (ClosureStart).
  exact,
  /// [theta; dr] = J^-1 G eps (San et al. 2023, Eq. 18, corrected): one matrix J^-1 G for each pose, and one
  /// vectorised product for each sample (map_tile). A finite sample converges in one iteration; at a singular pose all
  /// samples are singular.
  first_order
};

/// An evaluator for poses (alpha, beta, z) and the 60 errors of the head, the 3-PRS mechanism.
std::unique_ptr<Evaluator> head_evaluator(const Geometry& geometry, Fidelity fidelity, const SolverOptions& options);

/// An evaluator like head_evaluator(), but with the displacements after the best correction by the carriages
/// (Model::calibrated_evaluator, Corrections). The evaluator subtracts from [theta; dr], and from the swings of the
/// rods, the parts that the correction causes. The displacement of the tool tip and the norms follow from the corrected
/// [theta; dr], with finite rotations if the fidelity is exact. At a singular pose every sample is singular.
std::unique_ptr<Evaluator> calibrated_head_evaluator(const Geometry& geometry, Fidelity fidelity,
                                                     const SolverOptions& options);

/// Computes the last three responses, the norms, from the nine components before them. A solved sample becomes
/// non_finite if its responses overflow.
void fill_norms(const OutcomeBlock& outcomes);

/// The trace of the solve of one sample at a reachable pose (alpha, beta, z). errors: the values of the 60 errors of
/// the head, SI. Exact solves use close_limbs(). First-order solves use the evaluator, which does not iterate.
SolveTrace head_trace(const Geometry& geometry, Fidelity fidelity, std::span<const double> pose,
                      std::span<const double> errors, const SolverOptions& options);

/// An evaluator of the hybrid machine, made from an evaluator of its head. Poses are (alpha, beta, z, slide_x,
/// slide_y). Errors are the 60 of the head followed by the 13 of the slides. Responses are those of the head; they
/// state displacements from the nominal pose in the rack's frame. At exact fidelity the displaced slides carry the
/// head's displaced platform (nominal_T_head()); to first order the effects of both are added. The swings of the rods,
/// status and iterations are the head's, but a sample whose responses overflow is non_finite. The head is evaluated
/// once for each block, with a single sample if none of its errors vary.
std::unique_ptr<Evaluator> machine_evaluator(const Geometry& geometry, Fidelity fidelity,
                                             std::unique_ptr<Evaluator> head);

/// An evaluator that gives the outcome of a trace for every sample, without the swings of the rods. Keeps a reference
/// to the trace.
std::unique_ptr<Evaluator> evaluator_of(const SolveTrace& head);

/// Sets responses, status and iterations of a trace with an evaluator, for one sample whose errors are all constant.
void solve_once(Evaluator& evaluator, std::span<const double> pose, std::span<const double> errors, SolveTrace& trace);

}  // namespace poesy::three_prs
