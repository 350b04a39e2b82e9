#pragma once

#include <memory>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {

inline constexpr std::size_t kComponents = 9;  ///< responses that are vector components: rows kTheta, kDr, kTip
inline constexpr std::size_t kResponses = kComponents + 3;

/// The responses of both evaluators, in this order: theta_x, _y, _z (rotation vector of the platform, rad), x, y, z
/// (displacement of P, m), tip_x, _y, _z (of the tool tip, m), in the base frame, then the norms rotation, position,
/// tip_position.
std::vector<Response> responses();

/// The only detail, `swing`: additional swing dphi_i of the three rods (rad).
std::vector<Detail> details();

/// Levels of accuracy, in the order of ModelDescription::fidelities.
enum class Fidelity : std::size_t {
  /// The closure of all limbs with errors and rotations of finite size (ClosureSolver), started from the first-order
  /// motion (ClosureStart).
  exact,
  /// [theta; dr] = J^-1 G eps (San et al. 2023, Eq. 18, corrected): one matrix for each block, one vectorised product
  /// for each sample (map_tile). Every sample converges in one iteration; at a singular pose every sample is singular.
  first_order
};

/// An evaluator for poses (alpha, beta, z) and the head's 60 errors.
std::unique_ptr<Evaluator> head_evaluator(const Geometry& geometry, Fidelity fidelity, const SolverOptions& options);

/// An evaluator like head_evaluator() after the best correction of the carriages (Model::calibrated_evaluator,
/// Corrections). The motion by the correction is subtracted from [theta; dr]. The tool tip's displacement and the norms
/// follow from the difference, with finite rotations if the fidelity is exact; the swings by the correction are
/// subtracted too. At a singular pose every sample is singular.
std::unique_ptr<Evaluator> calibrated_head_evaluator(const Geometry& geometry, Fidelity fidelity,
                                                     const SolverOptions& options);

/// Computes the last three responses, the norms, from the nine components before them. A solved sample whose responses
/// overflow becomes non_finite.
void fill_norms(const OutcomeBlock& outcomes);

/// The solve of one sample at a reachable pose (alpha, beta, z). errors: the head's 60, SI. The exact solve uses
/// close_limbs(); the first order uses the evaluator, which does not iterate.
SolveTrace head_trace(const Geometry& geometry, Fidelity fidelity, std::span<const double> pose,
                      std::span<const double> errors, const SolverOptions& options);

/// An evaluator of the machine for poses (alpha, beta, z, slide_x, slide_y) and the head's 60 errors followed by the
/// slides' 13, made from an evaluator of the head. Responses are the head's, in the rack's frame, as differences to the
/// nominal pose: at exact fidelity the head's displaced platform is carried by the displaced slides (nominal_T_head()),
/// to first order both effects are added. Details, status and iterations are the head's, but a sample whose responses
/// overflow is non_finite. The head is evaluated once for each block, with a single sample if none of its errors vary.
std::unique_ptr<Evaluator> machine_evaluator(const Geometry& geometry, Fidelity fidelity,
                                             std::unique_ptr<Evaluator> head);

/// An evaluator that gives the outcome of this trace for any sample, without details. Keeps a reference to the trace.
std::unique_ptr<Evaluator> evaluator_of(const SolveTrace& head);

/// Sets responses, status and iterations of a trace by an evaluator, with all errors constant.
void solve_once(Evaluator& evaluator, std::span<const double> pose, std::span<const double> errors, SolveTrace& trace);

}  // namespace poesy::three_prs
