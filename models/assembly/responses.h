#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/first_order.h"
#include "models/assembly/solver.h"

namespace poesy::assembly {

/// A joint whose reaction, or whose drive's force, is a response.
struct ReportedJoint {
  std::size_t limb;   ///< position
  std::size_t joint;  ///< of the limb's elementary joints: the first of the joint, or the driven one
  std::string name;   ///< of the joint, as the file has it
};

/// What of an assembly is reported, beside what every assembly has.
struct Report {
  std::vector<ReportedJoint> drives;     ///< actuated joints
  std::vector<ReportedJoint> reactions;  ///< joints whose reactions are wanted
};

/// What errors do to an assembly: what every response follows from.
struct Outcome {
  /// A body's displacement D = T T_nominal^-1.
  struct Motion {
    Vector3 moved = Vector3::Zero();  ///< of its origin (m)
    Vector3 theta = Vector3::Zero();  ///< rotation vector
  };
  std::vector<Motion> bodies;             ///< [bodies]; the base's is 0
  Vector3 tool = Vector3::Zero();         ///< displacement of the tool's point, if there is one
  std::vector<Screw> mismatch;            ///< [limbs] xi
  std::vector<Screw> wrenches;            ///< [limbs] p
  std::span<const LimbState> limbs = {};  ///< [limbs] where forces are taken
};

/// The limb's last joint that moves; its last joint where none does: about its point the limb's moment is taken.
std::size_t last_moving(const Limb& limb);

/// Of an exact solution, which must outlive it.
Outcome outcome_of(const Assembly& assembly, const Nominal& pose, const Solution& solution);

/// Of one column of first order.
Outcome outcome_of(const Assembly& assembly, const Nominal& pose, const Balance& balance, Eigen::Index column);

/// Names, dimensions and meanings in the order of response_values(): deformation (gap, angular_deformation,
/// linear_deformation) unless nothing ever deforms, the platform's displacement, other bodies', and with stiffness
/// strain_energy, forces and moments of limbs, of drives, reactions.
std::vector<Response> responses_of(const Assembly& assembly, const Report& report, bool deforms);

/// The values of the responses, SI.
std::vector<double> response_values(const Assembly& assembly, const Report& report, bool deforms, const Nominal& pose,
                                    const Outcome& outcome);

}  // namespace poesy::assembly
