#pragma once

#include <span>
#include <vector>

#include "models/assembly/limb_state.h"

namespace poesy::assembly {

/// A perfect assembly at a pose, rigid and without load. Compliances and loads are evaluated in this state.
struct Nominal {
  std::vector<double> displacements;  ///< [joints] displacements, limb by limb (rad, m)
  std::vector<Transform> bodies;      ///< [bodies] base_T_body
  std::vector<LimbState> limbs;       ///< [limbs] states of the limbs
  std::vector<Matrix6> compliance;    ///< [limbs] compliance C of each limb
  std::vector<Screw> load;            ///< [bodies] wrench of the load; 0 for the base
  std::vector<Screw> mismatch;  ///< [limbs] mismatch between the end of each limb and its body; 0 unless the file's
                                ///< numbers are rounded
  Matrix6 W;  ///< metric of the platform's points: xi^T W xi is their mean square displacement by a twist xi (m^2)
};

/// The assembly for displacements [joints] (rad, m) that close the loops. With Metric::platform there is no load, and
/// the compliance C of a limb is W^-1, divided by the number of limbs in a row with it (limbs_in_a_row()).
Nominal nominal(const Assembly& assembly, std::span<const double> displacements);

/// [limbs] The number of limbs in a row with each limb, including itself. Limbs are in a row if they are connected
/// through bodies that only two limbs touch. The platform does not count as such a body.
std::vector<std::size_t> limbs_in_a_row(const Assembly& assembly);

/// [limbs] The rank of the columns (twists) of each limb's passive joints, about the platform's origin and with lengths
/// in units of the reach. Singular values below the threshold times the largest count as 0.
std::vector<std::size_t> passive_ranks(const Assembly& assembly, const Nominal& pose, double threshold);

/// [6 x 6] The matrix that converts twists from the base frame, with lengths in m, to the origin and axes of `frame`
/// (base_T_frame), with lengths in units of `length` (m).
Matrix6 twists_in_units(const Transform& frame, double length);

/// The frame (base_T_frame) in which the metric W of points is diagonal. Its origin is the centroid of the points.
Transform frame_of_metric(const Matrix6& W);

}  // namespace poesy::assembly
