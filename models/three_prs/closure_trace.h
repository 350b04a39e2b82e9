#pragma once

#include <memory>
#include <span>

#include "engine/model/model.h"
#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {

// Solves of one sample at a reachable pose (alpha, beta, z); errors: the head's 60, SI.

/// By close_limbs, from the first order (ClosureStart).
SolveTrace closure_trace(const Geometry& geometry, std::span<const double> pose, std::span<const double> errors,
                         const SolverOptions& options);

/// By the evaluator of first order, which iterates nothing.
SolveTrace first_order_trace(const Geometry& geometry, std::span<const double> pose, std::span<const double> errors);

/// An evaluator that gives the outcome of this trace, to which it refers, for any sample; no details.
std::unique_ptr<Evaluator> evaluator_of(const SolveTrace& head);

/// Fills in responses, status and iterations of a trace by an evaluator, with all errors constant.
void solve_once(Evaluator& evaluator, std::span<const double> pose, std::span<const double> errors, SolveTrace& trace);

}  // namespace poesy::three_prs
