#include "models/assembly/responses.h"

#include <array>
#include <cmath>
#include <string_view>

namespace poesy::assembly {
namespace {

constexpr auto kLength = Dimension::length;
constexpr auto kAngle = Dimension::angle;
constexpr auto kForce = Dimension::force;
constexpr auto kMoment = Dimension::moment;
constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};

/// Builds the list of responses, one after the other.
class Rows {
 public:
  void add(std::string name, Dimension dimension, std::string description) {
    list.push_back({std::move(name), dimension, std::move(description)});
  }

  /// Adds a response that is never negative.
  void add_magnitude(std::string name, Dimension dimension, std::string description) {
    add(std::move(name), dimension, std::move(description));
    list.back().has_no_sign = true;
  }

  /// Adds to the list three responses, the components NAME_x, NAME_y and NAME_z of a vector.
  void add_vector(const std::string& name, Dimension dimension, const std::string& description) {
    for (const std::string_view axis : kAxes) {
      add(name + std::string(axis), dimension, description + " " + std::string(axis));
    }
  }

  /// Adds to the list a response that is the norm of three consecutive others. back: distance of the first of them from
  /// the end of the list.
  void add_norm(std::string name, Dimension dimension, std::string description, std::size_t back) {
    const std::size_t first = list.size() - back;
    add(std::move(name), dimension, std::move(description));
    list.back().components = {first, first + 1, first + 2};
  }

  std::vector<Response> list = {};
};

void add_motion(Rows& rows, const std::string& prefix, const std::string& whose) {
  rows.add_vector(prefix, kLength, "displacement of " + whose + "'s origin along the base's");
  rows.add_vector(prefix + "theta_", kAngle, "rotation vector of " + whose + " about the base's");
  rows.add_norm(prefix + "position", kLength, "length of the displacement of " + whose + "'s origin", 6);
  rows.add_norm(prefix + "rotation", kAngle, "angle by which " + whose + " is rotated", 4);
}

void add_motions(Rows& rows, const Assembly& assembly) {
  add_motion(rows, "", "the platform");
  if (assembly.tool) {
    rows.add_vector("tip_", kLength, "displacement of the tool's point along the base's");
    rows.add_norm("tip_position", kLength, "length of the displacement of the tool's point", 3);
  }
  for (std::size_t b = kPlatform + 1; b < assembly.bodies.size(); ++b) {
    add_motion(rows, assembly.bodies[b].name + "_", assembly.bodies[b].name);
  }
}

void add_forces(Rows& rows, const Assembly& assembly, const Report& report) {
  rows.add_magnitude("strain_energy", Dimension::energy, "elastic energy of all limbs");
  for (const Limb& limb : assembly.limbs) {
    rows.add_magnitude("force_" + limb.label, kForce, "norm of the force that limb " + limb.label + " exerts");
    rows.add_magnitude(
        "moment_" + limb.label, kMoment,
        "norm of the moment that limb " + limb.label + " exerts, about the point of its last moving joint");
  }
  const auto of = [&](const ReportedJoint& joint) { return joint.name + "_" + assembly.limbs[joint.limb].label; };
  for (const ReportedJoint& drive : report.drives) {
    const bool slides = assembly.limbs[drive.limb].chain.joints[drive.joint].type == chain::JointType::prismatic;
    rows.add("actuator_" + of(drive), slides ? kForce : kMoment,
             "what the drive of " + of(drive) + " exerts, positive along positive displacement");
  }
  for (const ReportedJoint& joint : report.reactions) {
    const std::string what = " that joint " + of(joint) + " passes on towards its limb's end, along its own";
    rows.add_vector("reaction_" + of(joint) + "_f", kForce, "force" + what);
    rows.add_vector("reaction_" + of(joint) + "_m", kMoment, "moment" + what);
  }
}

/// The moment of a wrench about a point.
Vector3 moment_about(const Vector3& point, const Screw& wrench) {
  return wrench.head<3>() - point.cross(Vector3(wrench.tail<3>()));
}

class Values {
 public:
  void add(double value) { list.push_back(value); }
  void add(const Vector3& vector) { list.insert(list.end(), vector.begin(), vector.end()); }

  void add(const Outcome::Motion& motion) {
    add(motion.moved);
    add(motion.theta);
    add(motion.moved.norm());
    add(motion.theta.norm());
  }

  std::vector<double> list = {};
};

void add_motions(Values& values, const Assembly& assembly, const Outcome& outcome) {
  values.add(outcome.bodies[kPlatform]);
  if (assembly.tool) {
    values.add(outcome.tool);
    values.add(outcome.tool.norm());
  }
  for (std::size_t b = kPlatform + 1; b < assembly.bodies.size(); ++b) values.add(outcome.bodies[b]);
}

void add_forces(Values& values, const Assembly& assembly, const Report& report, const Nominal& pose,
                const Outcome& outcome) {
  double energy = 0.0;
  // The mismatch is computed as C p, from compliance C and wrench p. If it were computed from poses, it would contain
  // their rounding errors.
  for (std::size_t e = 0; e < assembly.limbs.size(); ++e) {
    energy += 0.5 * outcome.wrenches[e].dot(pose.compliance[e] * outcome.wrenches[e]);
  }
  values.add(energy);
  for (std::size_t e = 0; e < assembly.limbs.size(); ++e) {
    const Screw& wrench = outcome.wrenches[e];
    const Vector3& point = outcome.limbs[e].before[last_moving(assembly.limbs[e])].p;
    values.add(wrench.tail<3>().norm());
    values.add(moment_about(point, wrench).norm());
  }
  for (const ReportedJoint& drive : report.drives) {
    const chain::Joint& joint = assembly.limbs[drive.limb].chain.joints[drive.joint];
    values.add(outcome.limbs[drive.limb].twist(joint, drive.joint).dot(outcome.wrenches[drive.limb]));
  }
  for (const ReportedJoint& joint : report.reactions) {
    const Transform& frame = outcome.limbs[joint.limb].before[joint.joint];
    const Screw& wrench = outcome.wrenches[joint.limb];
    values.add(Vector3(frame.R.transpose() * wrench.tail<3>()));
    values.add(Vector3(frame.R.transpose() * moment_about(frame.p, wrench)));
  }
}

void add_deformation(Values& values, const Assembly& assembly, const Nominal& pose, const Outcome& outcome) {
  double gap = 0.0;
  double angular = 0.0;
  double linear = 0.0;
  const Vector3& origin = pose.bodies[kPlatform].p;
  for (const Screw& xi : outcome.mismatch) {
    gap += xi.dot(pose.W * xi);
    angular += xi.head<3>().squaredNorm();
    linear += (xi.tail<3>() + xi.head<3>().cross(origin)).squaredNorm();
  }
  const double share = 2.0 / static_cast<double>(assembly.loops());
  for (const double sum : {gap, angular, linear}) values.add(std::sqrt(share * std::max(sum, 0.0)));
}

}  // namespace

std::size_t last_moving(const Limb& limb) {
  std::size_t j = limb.chain.joints.size() - 1;
  while (j > 0 && limb.chain.joints[j].fixed) --j;
  return limb.chain.joints[j].fixed ? limb.chain.joints.size() - 1 : j;
}

Outcome outcome_of(const Assembly& assembly, const Nominal& pose, const Solution& solution) {
  Outcome made{.bodies = std::vector<Outcome::Motion>(pose.bodies.size()),
               .mismatch = solution.mismatch,
               .wrenches = solution.wrenches,
               .limbs = solution.limbs};
  for (std::size_t b = kPlatform; b < pose.bodies.size(); ++b) {
    made.bodies[b].moved = solution.bodies[b].p - pose.bodies[b].p;
    made.bodies[b].theta = lie::log<double>(solution.bodies[b].R * pose.bodies[b].R.transpose());
  }
  if (!assembly.tool) return made;
  const Vector3 arm = pose.bodies[kPlatform].R * *assembly.tool;
  const Outcome::Motion& platform = made.bodies[kPlatform];
  made.tool = platform.moved + lie::moved_by_rotation<double>(platform.theta, arm);
  return made;
}

Outcome outcome_of(const Assembly& assembly, const Nominal& pose, const Balance& balance, Eigen::Index column) {
  Outcome made{
      .bodies = std::vector<Outcome::Motion>(pose.bodies.size()), .mismatch = {}, .wrenches = {}, .limbs = pose.limbs};
  for (std::size_t b = kPlatform; b < pose.bodies.size(); ++b) {
    const Screw twist = balance.twists.block<6, 1>(6 * static_cast<Eigen::Index>(b), column);
    made.bodies[b].theta = twist.head<3>();
    made.bodies[b].moved = twist.tail<3>() + made.bodies[b].theta.cross(pose.bodies[b].p);
  }
  for (std::size_t e = 0; e < pose.limbs.size(); ++e) {
    made.wrenches.push_back(balance.wrenches.block<6, 1>(6 * static_cast<Eigen::Index>(e), column));
    made.mismatch.push_back(pose.compliance[e] * made.wrenches.back());
  }
  if (!assembly.tool) return made;
  const Outcome::Motion& platform = made.bodies[kPlatform];
  made.tool = platform.moved + platform.theta.cross(Vector3(pose.bodies[kPlatform].R * *assembly.tool));
  return made;
}

std::vector<Response> responses_of(const Assembly& assembly, const Report& report, bool deforms) {
  Rows rows;
  if (deforms) {
    rows.add_magnitude(
        "gap", kLength,
        "how far the limbs would have their ends apart from the bodies that they hold: root mean square over the "
        "platform's points and the independent loops");
    rows.add_magnitude("angular_deformation", kAngle, "mismatch of angle, root mean square over the independent loops");
    rows.add_magnitude("linear_deformation", kLength,
                       "mismatch of position at the platform's origin, root mean square over the independent loops");
  }
  if (report.motions) add_motions(rows, assembly);
  if (assembly.metric == Metric::stiffness) add_forces(rows, assembly, report);
  return std::move(rows.list);
}

std::vector<double> response_values(const Assembly& assembly, const Report& report, bool deforms, const Nominal& pose,
                                    const Outcome& outcome) {
  Values values;
  if (deforms) add_deformation(values, assembly, pose, outcome);
  if (report.motions) add_motions(values, assembly, outcome);
  if (assembly.metric == Metric::stiffness) add_forces(values, assembly, report, pose, outcome);
  return std::move(values.list);
}

}  // namespace poesy::assembly
