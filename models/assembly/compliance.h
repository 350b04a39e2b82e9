#pragma once

#include "models/assembly/limb_state.h"

namespace poesy::assembly {

/// The compliance C of a limb in this state, from a wrench to a twist in the base frame. It is the sum of Ad(F) C_k
/// Ad(F)^T over bearings, links and the compliance of the limb as a whole, each given as C_k in a frame F. The frame of
/// a beam of length L is at its middle, with x along the beam. There its compliance is
///
///     diag(L/GJ, L/EIy, L/EIz, L/EA, L^3/(12 E Iz) + L/(shear G A), L^3/(12 E Iy) + L/(shear G A))
///
/// See BeamSection for the stiffnesses; `shear` is the share of the area A that carries shear. from, to: base_T_body of
/// the bodies at which the limb begins and ends.
Matrix6 limb_compliance(const Limb& limb, const LimbState& state, const Transform& from, const Transform& to);

/// The frame base_T_end at an end of a link, with the point and the axes of the joint or body there.
Transform link_end(const LinkEnd& end, const LimbState& state, const Transform& from, const Transform& to);

}  // namespace poesy::assembly
