#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/first_order.h"
#include "models/assembly/solver.h"

namespace poesy::assembly {

/// A joint whose reaction, or whose drive force, is a response.
struct ReportedJoint {
  std::size_t limb;  ///< index of the limb
  /// Index of the joint in the limb. A joint with several freedoms is a series of joints with one freedom each. The
  /// index belongs to the first joint of the series for a reaction, and to the driven joint for a drive.
  std::size_t joint;
  std::string name;  ///< name of the joint in the file
};

/// The number of responses that measure mismatch: `gap`, `angular_deformation` and `linear_deformation`. If an assembly
/// has them, they are its first responses.
inline constexpr std::size_t kDeformations = 3;

/// The optional responses of an assembly, among which its model chooses.
struct Report {
  std::vector<ReportedJoint> drives;     ///< actuated joints whose drive forces are responses if limbs have stiffness
  std::vector<ReportedJoint> reactions;  ///< joints whose reactions are responses if limbs have stiffness
  bool motions = true;                   ///< true if displacements of bodies are responses
};

/// The effects of errors on an assembly, from which all responses follow.
struct Outcome {
  /// The displacement D = T T_nominal^-1 of a body with pose T.
  struct Motion {
    Vector3 moved = Vector3::Zero();  ///< displacement of the body's origin (m)
    Vector3 theta = Vector3::Zero();  ///< rotation vector (rad)
  };
  std::vector<Motion> bodies;             ///< [bodies] displacements; 0 for the base
  Vector3 tool = Vector3::Zero();         ///< displacement of the tool point (m), if there is one
  std::vector<Screw> mismatch;            ///< [limbs] mismatch between the end of each limb and its body
  std::vector<Screw> wrenches;            ///< [limbs] wrench of each limb on the body at its end
  std::span<const LimbState> limbs = {};  ///< [limbs] states at which forces are evaluated
};

/// The index of the limb's last joint that is not fixed, or of the last joint if all are fixed. The moment of the
/// limb is taken about the point of this joint.
std::size_t last_moving(const Limb& limb);

/// The outcome of an exact solution. The solution must outlive the outcome.
Outcome outcome_of(const Assembly& assembly, const Nominal& pose, const Solution& solution);

/// The outcome of one column of a first-order result.
Outcome outcome_of(const Assembly& assembly, const Nominal& pose, const Balance& balance, Eigen::Index column);

/// Names, dimensions and meanings of the responses, in the order of response_values(). If `deforms` is true,
/// `gap`, `angular_deformation` and `linear_deformation` come first. If Report::motions is true, the displacements of
/// the platform, of the tool and of the other bodies follow. If limbs have stiffness, `strain_energy`, the forces and
/// moments of limbs, the forces of drives, and the reactions follow.
std::vector<Response> responses_of(const Assembly& assembly, const Report& report, bool deforms);

/// The values of the responses in the order of responses_of(), SI.
std::vector<double> response_values(const Assembly& assembly, const Report& report, bool deforms, const Nominal& pose,
                                    const Outcome& outcome);

}  // namespace poesy::assembly
