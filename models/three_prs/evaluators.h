#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {

inline constexpr std::size_t kComponents = 9;  ///< responses that are components of vectors: rows kTheta, kDr, kTip
inline constexpr std::size_t kResponses = kComponents + 3;

/// What both evaluators give, in this order: theta_x, _y, _z (rotation vector of the platform), x, y, z (displacement
/// of P), tip_x, _y, _z (of the tool tip), in the base frame, then the norms rotation, position, tip_position.
std::vector<Response> responses();

/// One detail, `swing`: additional swing dphi_i of the three rods, rad.
std::vector<Detail> details();

/// In the order of ModelDescription::fidelities.
enum class Fidelity : std::size_t {
  /// The closure of all limbs with errors and rotations of finite size (ClosureSolver), started from the first order
  /// (ClosureStart).
  exact,
  /// [theta; dr] = J^-1 G eps (San et al. 2023, Eq. 18, corrected): one matrix for each block, one product for each
  /// sample, by vectors (map_tile). Every sample converges in one iteration; at a singular pose every one is singular.
  first_order
};

/// For poses (alpha, beta, z) and the head's 60 errors.
std::unique_ptr<Evaluator> head_evaluator(const Geometry& geometry, Fidelity fidelity, const SolverOptions& options);

/// The same with what the best correction of the carriages leaves (Model::calibrated_evaluator, Corrections). Of
/// [theta; dr] as the evaluator gives it the correction's motion is subtracted; tool tip and norms are those of the
/// rest, rotations of finite size where the fidelity is exact; swings are less what the correction adds to them. At a
/// singular pose every sample is singular.
std::unique_ptr<Evaluator> calibrated_head_evaluator(const Geometry& geometry, Fidelity fidelity,
                                                     const SolverOptions& options);

/// Fills the last three responses, the norms, from the nine components above them. A sample that was solved and whose
/// responses overflow becomes non_finite.
void fill_norms(const OutcomeBlock& outcomes);

/// One sample at a reachable pose (alpha, beta, z); errors: the head's 60, SI. Exactly by close_limbs; to first order
/// by the evaluator, which iterates nothing.
SolveTrace head_trace(const Geometry& geometry, Fidelity fidelity, std::span<const double> pose,
                      std::span<const double> errors, const SolverOptions& options);

/// From an evaluator of the head, for poses (alpha, beta, z, slide_x, slide_y) and the head's 60 errors followed by the
/// slides' 13. Responses are the head's, in the rack's frame, as differences to the nominal pose: exactly the head's
/// displaced platform carried by the displaced slides (nominal_T_head), to first order the effects of both, added.
/// Status and iterations are the head's, except that a sample whose responses overflow is non_finite. Details are the
/// head's. The head is asked once for each block, and for a single sample where none of its own errors vary.
std::unique_ptr<Evaluator> machine_evaluator(const Geometry& geometry, Fidelity fidelity,
                                             std::unique_ptr<Evaluator> head);

/// An evaluator that gives the outcome of this trace, to which it refers, for any sample; no details.
std::unique_ptr<Evaluator> evaluator_of(const SolveTrace& head);

/// Fills in responses, status and iterations of a trace by an evaluator, with all errors constant.
void solve_once(Evaluator& evaluator, std::span<const double> pose, std::span<const double> errors, SolveTrace& trace);

}  // namespace poesy::three_prs
