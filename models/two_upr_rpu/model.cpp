#include "models/two_upr_rpu/model.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "engine/base/contract.h"
#include "models/assembly/details.h"
#include "models/assembly/model.h"
#include "models/assembly/sketch.h"
#include "models/chain/deformation_model.h"
#include "models/chain/deformation_trace.h"
#include "models/chain/metric.h"
#include "models/chain/passive_condition.h"
#include "models/chain/sketch.h"
#include "models/two_upr_rpu/errors.h"
#include "models/two_upr_rpu/kinematics.h"

namespace poesy::two_upr_rpu {
namespace {

/// The loop of a limb counts as open if the limb's platform pose differs by this or more from the wanted pose.
/// Rotations are compared in rad, translations as shares of the chain's reach. Closed loops differ by about 1e-15.
constexpr double kClosure = 1e-9;

using Vector3 = lie::Vector3<double>;

Pose pose_from(std::span<const double> pose) {
  POESY_EXPECTS(pose.size() == 3);
  return {pose[0], pose[1], pose[2]};
}

Pose home(const Geometry& geometry) { return {geometry.z_0, 0.0, 0.0}; }

std::function<std::vector<double>(std::span<const double>)> displacements_by(const Geometry& geometry) {
  return [geometry](std::span<const double> pose) {
    const auto q = two_upr_rpu::joint_displacements(geometry, pose_from(pose));
    return std::vector<double>(q.begin(), q.end());
  };
}

chain::DeformationModel deformation_model(const Geometry& geometry) {
  return {.chain = parallel_chain(geometry),
          .terms = error_terms(),
          .joint_displacements = displacements_by(geometry),
          .platform = {},
          .held_at = platform_joints(geometry)};
}

/// The mechanism as limbs between base and platform. points: points of the platform that define the metric (m, platform
/// frame).
assembly::AssemblyModel assembly_model(const Geometry& geometry, std::vector<Vector3> points) {
  const chain::ParallelChain chain = parallel_chain(geometry);
  assembly::AssemblyModel model;
  model.assembly.bodies.push_back({"base", {}});
  model.assembly.bodies.push_back({"platform", base_T_platform(home(geometry))});
  for (const chain::Limb& limb : chain.limbs) {
    model.ranks.push_back(limb.passive_joints());
    model.assembly.limbs.push_back({.chain = limb, .label = std::to_string(model.ranks.size())});
  }
  model.assembly.points = std::move(points);
  model.assembly.reach = chain.reach();
  model.report.motions = false;
  model.terms = error_terms();
  model.pairs = chain.pairs;
  model.joint_displacements = displacements_by(geometry);
  return model;
}

/// The parts of the description that do not depend on the metric.
ModelDescription describe(const chain::ParallelChain& chain) {
  const Geometry published;
  ModelDescription description;
  description.name = "2upr-rpu";
  description.title = "2UPR-RPU over-constrained manipulator (Du, Wang, Zheng 2022, Machines 10, 990)";
  description.geometry = {
      {"l_A", Dimension::length, published.l_A, "half of A1 A2 and distance from o_A to A3 on the platform"},
      {"l_B", Dimension::length, published.l_B, "half of B1 B2 and distance from o_B to B3 on the base"},
      {"c", Dimension::length, published.c, "offset of frame 4 of limb 3 along the platform's v axis"},
      {"d", Dimension::length, published.d, "offset of frame 1 of limbs 1 and 2 outwards along x"},
      {"z_0", Dimension::length, published.z_0, "z of the platform at the home configuration, below the base"}};
  description.pose_coordinates = {{"z", Dimension::length, "z of the platform's origin o_A in the base frame"},
                                  {"beta", Dimension::angle, "rotation of the platform about the base's x axis"},
                                  {"gamma", Dimension::angle, "rotation of the platform about its own v axis"}};
  description.factors = factors();
  description.factor_sets = factor_sets();
  description.details = chain::deformation_details(chain.pairs);
  description.joints = chain::joint_displacement_names(chain);
  description.fidelities = {"exact", "first-order"};
  description.pose_lower = {-0.30, -0.5, -0.6};
  description.pose_upper = {-0.18, 0.5, 0.6};
  description.workspace_note =
      "The paper draws its workspace but prints no limits. This box is inferred: it reproduces the published angular "
      "figures of Tables 9 and 11 within 2 %.";
  return description;
}

/// Returns true if two poses are equal up to kClosure. reach: the length by which translations are divided, m.
bool are_same(const lie::Transform<double>& a, const lie::Transform<double>& b, double reach) {
  const lie::Screw<double> screw = lie::log(a * b.inverse());
  return screw.head<3>().norm() < kClosure && screw.tail<3>().norm() < kClosure * reach;
}

/// The joints of the limbs: U, P and R for the first two limbs, R, P and U for the third. A U joint is at the
/// intersection of its axes.
std::vector<std::vector<SketchedJoint>> joints() {
  const auto joint = [](char type, std::size_t first, std::size_t frame) {
    return SketchedJoint{.name = {},
                         .type = type,
                         .actuated = type == 'P',
                         .point = {},
                         .axis = {},
                         .has_errors = true,
                         .first = first,
                         .frame = frame};
  };
  const std::vector upr{joint('U', 1, 2), joint('P', 3, 3), joint('R', 4, 4)};
  return {upr, upr, {joint('R', 1, 1), joint('P', 2, 2), joint('U', 3, 3)}};
}

/// The poses, geometry and errors of the mechanism, which are the same for all metrics.
class TwoUprRpu : public Model {
 public:
  const ModelDescription& description() const override { return description_; }

  std::optional<std::string> unreachable(std::span<const double> pose) const override {
    const Pose wanted = pose_from(pose);
    if (!(std::abs(wanted.beta) < std::numbers::pi / 2.0)) return "beta must lie between -90 and 90 deg";
    if (!(std::abs(wanted.gamma) < std::numbers::pi / 2.0)) return "gamma must lie between -90 and 90 deg";
    if (!(wanted.z < 0.0)) return "z must be negative: the platform hangs below the base";
    return open_loop(wanted);
  }

  std::vector<double> joint_displacements(std::span<const double> pose) const override {
    const auto q = two_upr_rpu::joint_displacements(geometry_, pose_from(pose));
    return {q.begin(), q.end()};
  }

  /// The bound of an error that is a length is l_A (of the platform) or l_B (of the base), whichever is smaller,
  /// because every limb joins platform and base. The offsets c and d are not links and may be 0.
  ErrorBound error_bound(FactorIndex factor) const override {
    if (description_.factors[factor.value].dimension == Dimension::angle) return {std::numbers::pi, "half a turn"};
    if (geometry_.l_A < geometry_.l_B) return {geometry_.l_A, "the platform's size l_A"};
    return {geometry_.l_B, "the base's size l_B"};
  }

  std::optional<Sketch> sketch(std::span<const double> pose) const override {
    Sketch sketch{.limbs = joints(), .platform = {}, .tool = {}};
    place(sketch, pose.empty() ? std::vector(description_.joints.size(), 0.0) : joint_displacements(pose));
    return sketch;
  }

  std::vector<std::string> unusual_geometry() const override {
    if (geometry_.l_A <= geometry_.l_B) return {};
    return {"the platform (l_A = " + readable_text({geometry_.l_A, Dimension::length}) +
            ") is larger than the base (l_B = " + readable_text({geometry_.l_B, Dimension::length}) + ")"};
  }

 protected:
  explicit TwoUprRpu(const Geometry& geometry)
      : geometry_(geometry), chain_(parallel_chain(geometry)), description_(describe(chain_)) {
    if (auto problem = open_loop(home(geometry))) {
      throw std::invalid_argument("the home configuration does not assemble: " + *problem);
    }
  }

  /// The description, for derived classes that complete it.
  ModelDescription& described() { return description_; }

  /// Places the joints, the platform and the errors of a sketch for these displacements of the joints (rad, m).
  virtual void place(Sketch& sketch, const std::vector<double>& displacements) const = 0;

 private:
  /// The reason why the loop of a limb is open at a pose, if one is open: a leg has no length, or a coordinate is so
  /// large that digits are lost.
  std::optional<std::string> open_loop(const Pose& pose) const {
    const auto q = two_upr_rpu::joint_displacements(geometry_, pose);
    const lie::Transform<double> wanted = base_T_platform(pose);
    for (std::size_t i = 0; i < chain_.limbs.size(); ++i) {
      const chain::Limb& limb = chain_.limbs[i];
      const auto reached = chain::forward_kinematics<double>(limb, limb.home, std::span(q).subspan(4 * i, 4),
                                                             [](std::size_t, const lie::Screw<double>&) {});
      if (!are_same(reached, wanted, chain_.reach())) {
        return "limb " + std::to_string(i + 1) + " cannot reach the platform there";
      }
    }
    return std::nullopt;
  }

  Geometry geometry_;
  chain::ParallelChain chain_;
  ModelDescription description_;
};

class AsPublished final : public TwoUprRpu {
 public:
  AsPublished(const Geometry& geometry, chain::Fidelity fidelity)
      : TwoUprRpu(geometry), model_(deformation_model(geometry)), fidelity_(fidelity) {
    ModelDescription& description = described();
    description.metric = "published";
    description.responses = chain::deformation_responses();
    description.deformation = chain::deformation_measure(model_);
  }

  double condition(std::span<const double> pose) const override {
    return chain::passive_condition(model_.chain, joint_displacements(pose));
  }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return chain::deformation_evaluator(model_, options, fidelity_);
  }

  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    if (fidelity_ == chain::Fidelity::first_order) return chain::first_order_trace(model_, pose, errors);
    return chain::deformation_trace(model_, pose, errors, options);
  }

  double rounding(std::size_t /*response*/) const override { return chain::effect_rounding(model_); }

  std::vector<double> norm_of_details(std::size_t response, std::span<const double> /*pose*/) const override {
    return chain::norm_of_details(model_, response);
  }

 private:
  void place(Sketch& sketch, const std::vector<double>& displacements) const override {
    chain::place(sketch, model_, displacements);
  }

  chain::DeformationModel model_;
  chain::Fidelity fidelity_;
};

class ByPlatform final : public TwoUprRpu {
 public:
  /// points: points of the platform that define the metric (m, platform frame).
  ByPlatform(const Geometry& geometry, std::vector<Vector3> points, chain::Fidelity fidelity)
      : TwoUprRpu(geometry), model_(assembly_model(geometry, std::move(points))), fidelity_(fidelity) {
    ModelDescription& description = described();
    description.metric = "platform";
    description.tolerance = chain::kToleranceByMetric;
    description.responses = assembly::responses_of(model_);
    description.deformation = DeformationMeasure{0, rounding(0)};
  }

  double condition(std::span<const double> pose) const override { return assembly::condition(model_, pose); }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return assembly::assembly_evaluator(model_, options, fidelity_);
  }

  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    return assembly::assembly_trace(model_, pose, errors, options, fidelity_);
  }

  double rounding(std::size_t response) const override {
    return assembly::effect_rounding(model_, description().responses[response]);
  }

  std::vector<double> norm_of_details(std::size_t response, std::span<const double> pose) const override {
    return assembly::norm_of_details(model_, response, pose);
  }

  std::vector<PlatformPoint> metric_points() const override {
    std::vector<PlatformPoint> points;
    for (const Vector3& point : model_.assembly.points) points.push_back({point.x(), point.y(), point.z()});
    return points;
  }

 private:
  void place(Sketch& sketch, const std::vector<double>& displacements) const override {
    assembly::place(sketch, model_, displacements);
  }

  assembly::AssemblyModel model_;
  chain::Fidelity fidelity_;
};

void require(bool holds, const char* rule) {
  if (!holds) throw std::invalid_argument(rule);
}

Geometry checked_geometry(std::span<const double> values) {
  POESY_EXPECTS(values.size() == 5);
  const Geometry geometry{values[0], values[1], values[2], values[3], values[4]};
  require(geometry.l_A > 0.0, "l_A must be positive");
  require(geometry.l_B > 0.0, "l_B must be positive");
  require(geometry.c >= 0.0, "c must not be negative");
  require(geometry.d >= 0.0, "d must not be negative");
  require(geometry.z_0 < 0.0, "z_0 must be negative: the platform hangs below the base");
  return geometry;
}

std::unique_ptr<Model> build_as_published(std::span<const double> values, std::size_t fidelity) {
  return std::make_unique<AsPublished>(checked_geometry(values), static_cast<chain::Fidelity>(fidelity));
}

std::unique_ptr<Model> build_by_platform(std::span<const double> values, std::size_t fidelity) {
  const Geometry geometry = checked_geometry(values);
  return std::make_unique<ByPlatform>(geometry, platform_joints(geometry), static_cast<chain::Fidelity>(fidelity));
}

std::unique_ptr<Model> build_with_points(std::span<const double> values, std::size_t fidelity,
                                         std::span<const PlatformPoint> points) {
  std::vector<Vector3> own;
  for (const PlatformPoint& point : points) own.emplace_back(point[0], point[1], point[2]);
  const Geometry geometry = checked_geometry(values);
  if (const std::string why = chain::why_no_metric(own, parallel_chain(geometry).reach()); !why.empty()) {
    throw std::invalid_argument(why);
  }
  return std::make_unique<ByPlatform>(geometry, own, static_cast<chain::Fidelity>(fidelity));
}

/// The catalog entry of the models that `build` makes. Its description is that of the model with the published
/// geometry.
CatalogEntry entry_of(decltype(CatalogEntry::build) build) {
  std::vector<double> values;
  for (const GeometryParameter& parameter : describe(parallel_chain({})).geometry)
    values.push_back(parameter.published);
  ModelDescription description = build(values, 0)->description();
  return {std::move(description), std::move(build)};
}

}  // namespace

CatalogEntry catalog_entry() {
  CatalogEntry by_platform = entry_of(build_by_platform);
  by_platform.build_with_points = build_with_points;
  CatalogEntry entry = entry_of(build_as_published);
  entry.other_metric = std::make_shared<const CatalogEntry>(std::move(by_platform));
  return entry;
}

}  // namespace poesy::two_upr_rpu
