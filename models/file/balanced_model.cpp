#include "models/file/balanced_model.h"

#include <algorithm>
#include <utility>

#include "models/assembly/calibration.h"
#include "models/assembly/details.h"
#include "models/assembly/model.h"
#include "models/assembly/separation.h"
#include "models/assembly/sketch.h"
#include "models/chain/metric.h"
#include "models/file/rigid_limbs.h"
#include "models/file/structure.h"

namespace poesy::file {
namespace {

assembly::Assembly assembly_of(const Mechanism& mechanism, assembly::Metric metric) {
  assembly::Assembly made{.bodies = mechanism.bodies,
                          .limbs = {},
                          .points = mechanism.points,
                          .tool = mechanism.tool,
                          .load = mechanism.load,
                          .metric = metric,
                          .reach = mechanism.reach};
  const std::vector<std::size_t> drives = shared_drives(mechanism);
  std::span<const std::size_t> left = drives;
  for (const Limb& limb : mechanism.limbs) {
    made.limbs.push_back({chain_limb(limb, mechanism.errors_at_joints, left), limb.from, limb.to, limb.label,
                          limb.bearings, limb.links, limb.compliance});
  }
  return made;
}

/// The name of the drive of joint j: the name of the joint in the file. If two drives hold one joint of the file, such
/// as a cylindrical joint, the direction is appended: "q_rz", "q_z".
std::string drive_name(const std::vector<Joint>& joints, std::size_t j) {
  const auto is_of_it = [&](const Joint& one) { return one.name == joints[j].name && one.actuated; };
  if (std::ranges::count_if(joints, is_of_it) == 1) return joints[j].name;
  return joints[j].name + (joints[j].motion == Motion::prismatic ? "_z" : "_rz");
}

/// The drives, and the joints whose reactions are wanted, in the order of the file.
assembly::Report report_of(const Mechanism& mechanism) {
  assembly::Report report;
  for (std::size_t e = 0; e < mechanism.limbs.size(); ++e) {
    const std::vector<Joint>& joints = mechanism.limbs[e].joints;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (joints[j].actuated) report.drives.push_back({e, j, drive_name(joints, j)});
      const bool is_first = j == 0 || joints[j - 1].name != joints[j].name;
      if (joints[j].reaction && is_first) report.reactions.push_back({e, j, joints[j].name});
    }
  }
  return report;
}

/// Throws if names of bodies, limbs and joints give two responses the same name.
void check_names(const Mechanism& mechanism, const std::vector<Response>& responses) {
  for (auto one = responses.begin(); one != responses.end(); ++one) {
    const auto other = std::find_if(one + 1, responses.end(), [&](const Response& r) { return r.name == one->name; });
    if (other == responses.end()) continue;
    throw InputError(
        mechanism.coordinates_place,
        "'" + one->name + "' is the name of two responses: " + one->description + ", and " + other->description,
        "give the body, limb or joint another name");
  }
}

/// The passive spherical joints, each of which is three revolute joints of its limb.
std::vector<assembly::PassiveBall> passive_balls(const Mechanism& mechanism) {
  std::vector<assembly::PassiveBall> balls;
  std::size_t column = 0;
  for (std::size_t e = 0; e < mechanism.limbs.size(); ++e) {
    std::size_t of_ball = 0;  // joints so far of the present spherical joint
    for (const Joint& joint : mechanism.limbs[e].joints) {
      if (!joint.moves() || joint.actuated) continue;
      if (joint.kind == JointKind::spherical && of_ball++ % 3 == 0) balls.push_back({e, column});
      ++column;
    }
  }
  return balls;
}

class BalancedModel final : public TrackedModel {
 public:
  BalancedModel(const MechanismFile& file, Checked found, assembly::Metric metric, chain::Fidelity fidelity)
      : TrackedModel(file, found),
        model_(assembly_model(mechanism(), tracker(), found.home, metric)),
        fidelity_(fidelity),
        has_forces_of_drives_(metric == assembly::Metric::stiffness &&
                              found.home.loop_equations - found.home.passive_rank > found.home.over_constraints) {
    set_responses(assembly::responses_of(model_), model_.over_constrained);
    check_names(mechanism(), description().responses);
    ModelDescription& description = described();
    description.separation = assembly::separation_description(model_);
    if (!model_.deforms) return;
    description.metric = metric == assembly::Metric::stiffness ? "stiffness" : "platform";
    if (model_.assembly.load.acts_on(model_.assembly.bodies) && metric == assembly::Metric::stiffness) return;
    description.deformation =
        DeformationMeasure{0, std::max(assembly::effect_rounding(model_, description.responses[0]), nominal_gap())};
    description.details = chain::deformation_details(model_.pairs);
  }

  double condition(std::span<const double> pose) const override { return assembly::condition(model_, pose); }
  std::optional<bool> are_separated(std::span<const double> one, std::span<const double> other) const override {
    return assembly::are_separated(model_, passive_balls(mechanism()), one, other);
  }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return assembly::assembly_evaluator(model_, options, fidelity_);
  }

  std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& options) const override {
    return has_forces_of_drives_ ? nullptr : assembly::calibrated_evaluator(model_, options, fidelity_);
  }

  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    return assembly::assembly_trace(model_, pose, errors, options, fidelity_);
  }

  lie::Matrix3<double> orientation(std::span<const double> pose) const override {
    if (pose.empty()) return mechanism().platform.R;
    return model_.at(pose).bodies[assembly::kPlatform].R;
  }

  std::optional<Sketch> sketch(std::span<const double> pose) const override {
    Sketch sketch = sketch_of(mechanism());
    assembly::place(sketch, model_,
                    pose.empty() ? std::vector(model_.assembly.joints(), 0.0) : model_.joint_displacements(pose));
    return sketch;
  }

  double rounding(std::size_t response) const override {
    return assembly::effect_rounding(model_, description().responses[response]);
  }

  std::vector<double> norm_of_details(std::size_t response, std::span<const double> pose) const override {
    return assembly::norm_of_details(model_, response, pose);
  }

  Separation separation(std::span<const double> pose) const override { return assembly::separation(model_, pose); }

  std::vector<PlatformPoint> metric_points() const override {
    std::vector<PlatformPoint> points;
    for (const Vector3& point : model_.assembly.points) points.push_back({point.x(), point.y(), point.z()});
    return points;
  }

 private:
  /// The largest response `gap` that rounded numbers may cause: twice the largest one without errors, over poses of the
  /// workspace.
  double nominal_gap() const {
    if (!model_.rounded) return 0.0;
    const std::vector<double> no_errors(model_.terms.size(), 0.0);
    double largest = 0.0;
    for (const PoseMobility& pose : workspace_mobility(mechanism())) {
      if (!pose.reached()) continue;
      const SolveTrace found =
          assembly::assembly_trace(model_, pose.pose, no_errors, SolverOptions(), chain::Fidelity::first_order);
      largest = std::max(largest, found.responses[0]);
    }
    return 2.0 * largest;
  }

  assembly::AssemblyModel model_;
  chain::Fidelity fidelity_;
  /// True if there is stiffness and there are more drives than freedoms (without idle ones). Then drives put forces on
  /// limbs, and corrections by the drives change these forces.
  bool has_forces_of_drives_;
};

}  // namespace

assembly::AssemblyModel assembly_model(const Mechanism& mechanism, std::shared_ptr<const PoseTracker> tracker,
                                       const Mobility& home, assembly::Metric metric) {
  assembly::AssemblyModel model{
      .assembly = assembly_of(mechanism, metric),
      .report = report_of(mechanism),
      .terms = mechanism.terms,
      .ranks = {},
      .idle = home.left_when_locked,
      .deforms = metric == assembly::Metric::stiffness || home.passive_rank < home.loop_equations,
      .over_constrained = home.passive_rank < home.loop_equations,
      .rounded = metric == assembly::Metric::platform && mechanism.precision.rounded(),
      .joint_displacements = {}};
  const assembly::Nominal at_home =
      assembly::nominal(model.assembly, std::vector<double>(model.assembly.joints(), 0.0));
  model.ranks = assembly::passive_ranks(model.assembly, at_home, mechanism.precision.rank_threshold);
  if (metric == assembly::Metric::stiffness) {
    check_rigid_limbs(mechanism, model, at_home);
    model.stiffness = assembly::largest_stiffness(model, at_home);
  }
  if (model.deforms && metric == assembly::Metric::platform && !mechanism.is_branched()) {
    model.pairs = chain::pairs_of(mechanism.limbs.size());
  }
  model.joint_displacements = [mechanism, tracker = std::move(tracker)](std::span<const double> pose) {
    return with_fixed(mechanism, tracker->track(pose).displacements);
  };
  return model;
}

std::unique_ptr<TrackedModel> balanced_model(const MechanismFile& file, Checked found, assembly::Metric metric,
                                             chain::Fidelity fidelity) {
  return std::make_unique<BalancedModel>(file, std::move(found), metric, fidelity);
}

}  // namespace poesy::file
