#pragma once

#include <memory>

#include "engine/model/model.h"
#include "models/three_prs/kinematics.h"

namespace poesy::three_prs {

// Evaluators of the machine from one of its head, for poses (alpha, beta, z, slide_x, slide_y) and the head's 60 errors
// followed by the slides' 13. Responses are the head's, in the rack's frame, as differences to the nominal pose. Status
// and iterations are the head's, except that a sample whose responses overflow is non_finite. Details are the head's.
// The head is asked once for each block, and for a single sample where none of its own errors vary.

/// The head's effects and those of the slides, added.
std::unique_ptr<Evaluator> first_order_machine_evaluator(const Geometry& geometry, std::unique_ptr<Evaluator> head);

/// The head's displaced platform carried by the displaced slides (nominal_T_head), exactly.
std::unique_ptr<Evaluator> exact_machine_evaluator(const Geometry& geometry, std::unique_ptr<Evaluator> head);

}  // namespace poesy::three_prs
