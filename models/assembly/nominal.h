#pragma once

#include <span>
#include <vector>

#include "models/assembly/limb_state.h"

namespace poesy::assembly {

/// A perfect assembly at a pose, rigid and without load: what compliance and loads belong to.
struct Nominal {
  std::vector<double> displacements;  ///< [joints], limb by limb (rad, m)
  std::vector<Transform> bodies;      ///< [bodies] base_T_body
  std::vector<LimbState> limbs;       ///< [limbs]
  std::vector<Matrix6> compliance;    ///< [limbs] C
  std::vector<Screw> load;            ///< [bodies] wrench from outside; the base's is 0
  std::vector<Screw> mismatch;        ///< [limbs] xi; 0 but where numbers are rounded
  Matrix6 W;                          ///< metric of the platform's points
};

/// At these displacements [joints], which close the loops. By the metric of the platform C is W^-1, of which limbs in a
/// row, through bodies other than the platform that only two limbs touch, take equal shares, and there is no load.
Nominal nominal(const Assembly& assembly, std::span<const double> displacements);

/// How many limbs are in a row with each, itself included, through bodies other than the platform that only two touch.
std::vector<std::size_t> limbs_in_a_row(const Assembly& assembly);

/// Of each limb the rank of its passive joints' columns, [limbs]: lengths in units of the reach about the platform's
/// origin, singular values below the threshold times the largest count as 0.
std::vector<std::size_t> passive_ranks(const Assembly& assembly, const Nominal& pose, double threshold);

/// Twists about the origin of a frame and along its axes, with lengths in this unit (m): to those from twists in the
/// base frame in m. frame: base_T_frame.
Matrix6 twists_in_units(const Transform& frame, double length);

/// base_T_frame of the frame in which a metric of points is diagonal: in their middle.
Transform frame_of_metric(const Matrix6& W);

}  // namespace poesy::assembly
