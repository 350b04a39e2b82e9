#pragma once

#include "models/assembly/limb_state.h"

namespace poesy::assembly {

/// C of a limb at this state, twist from wrench in the base frame: sum of Ad(F) C_k Ad(F)^T over its bearings, links
/// and what the limb itself has. A beam of length L has its frame F in its middle, x along it, where it is diagonal:
///
///     diag(L/GJ, L/EIy, L/EIz, L/EA, L^3/(12 E Iz) + L/(shear G A), L^3/(12 E Iy) + L/(shear G A))
///
/// from, to: base_T_body of its bodies.
Matrix6 limb_compliance(const Limb& limb, const LimbState& state, const Transform& from, const Transform& to);

/// base_T_end of a link's end: its point is the joint's or the body's, its axes are theirs.
Transform link_end(const LinkEnd& end, const LimbState& state, const Transform& from, const Transform& to);

}  // namespace poesy::assembly
