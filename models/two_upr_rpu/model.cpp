#include "models/two_upr_rpu/model.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/base/contract.h"
#include "models/chain/deformation_model.h"
#include "models/chain/deformation_trace.h"
#include "models/chain/passive_condition.h"
#include "models/chain/sketch.h"
#include "models/two_upr_rpu/errors.h"
#include "models/two_upr_rpu/kinematics.h"

namespace poesy::two_upr_rpu {
namespace {

/// A limb's loop counts as open if its platform pose differs from the wanted one by more than this (rad, and shares of
/// the chain's reach). Closed loops differ by about 1e-15.
constexpr double kClosure = 1e-9;

using Vector3 = lie::Vector3<double>;

Pose pose_from(std::span<const double> pose) {
  POESY_EXPECTS(pose.size() == 3);
  return {pose[0], pose[1], pose[2]};
}

/// The chain with the metric of these points, or with the published weight if there are none.
chain::DeformationModel deformation_model(const Geometry& geometry, std::vector<Vector3> points) {
  const auto displacements = [geometry](std::span<const double> pose) {
    const auto q = two_upr_rpu::joint_displacements(geometry, pose_from(pose));
    return std::vector<double>(q.begin(), q.end());
  };
  return {.chain = parallel_chain(geometry),
          .terms = error_terms(),
          .joint_displacements = displacements,
          .points = std::move(points),
          .platform = {},
          .held_at = platform_joints(geometry)};
}

ModelDescription describe(const chain::DeformationModel& deformation) {
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
  const bool by_platform = !deformation.points.empty();
  description.metric = by_platform ? "platform" : "published";
  if (by_platform) description.tolerance = chain::kToleranceByMetric;
  description.responses = by_platform ? chain::responses_by_metric() : chain::deformation_responses();
  description.deformation = chain::deformation_measure(deformation);
  description.details = chain::deformation_details(deformation.chain);
  description.joints = chain::joint_displacement_names(deformation.chain);
  description.fidelities = {"exact", "first-order"};
  description.pose_lower = {-0.30, -0.5, -0.6};
  description.pose_upper = {-0.18, 0.5, 0.6};
  description.workspace_note =
      "The paper draws its workspace but prints no limits. This box is inferred: it reproduces the published angular "
      "figures of Tables 9 and 11 within 2 %.";
  return description;
}

/// Whether two poses are equal up to kClosure.
bool are_same(const lie::Transform<double>& a, const lie::Transform<double>& b, double reach) {
  const lie::Screw<double> screw = lie::log(a * b.inverse());
  return screw.head<3>().norm() < kClosure && screw.tail<3>().norm() < kClosure * reach;
}

/// The joints of the limbs: U, P and R of the first two, R, P and U of the third. U is at the intersection of its axes.
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

class TwoUprRpu final : public Model {
 public:
  /// points: of the platform's metric; none: the published weight.
  TwoUprRpu(const Geometry& geometry, std::vector<Vector3> points, chain::Fidelity fidelity)
      : geometry_(geometry),
        deformation_(deformation_model(geometry, std::move(points))),
        description_(describe(deformation_)),
        fidelity_(fidelity) {
    if (auto problem = open_loop({geometry.z_0, 0.0, 0.0})) {
      throw std::invalid_argument("the home configuration does not assemble: " + *problem);
    }
  }

  const ModelDescription& description() const override { return description_; }

  std::optional<std::string> unreachable(std::span<const double> pose) const override {
    const Pose wanted = pose_from(pose);
    if (!(std::abs(wanted.beta) < std::numbers::pi / 2.0)) return "beta must lie between -90 and 90 deg";
    if (!(std::abs(wanted.gamma) < std::numbers::pi / 2.0)) return "gamma must lie between -90 and 90 deg";
    if (!(wanted.z < 0.0)) return "z must be negative: the platform hangs below the base";
    return open_loop(wanted);
  }

  std::vector<double> joint_displacements(std::span<const double> pose) const override {
    return deformation_.joint_displacements(pose);
  }

  double condition(std::span<const double> pose) const override {
    const std::vector<double> displacements = joint_displacements(pose);
    const std::optional<chain::Metric> metric = deformation_.metric(displacements);
    return chain::passive_condition(deformation_.chain, displacements, metric ? &*metric : nullptr);
  }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return chain::deformation_evaluator(deformation_, options, fidelity_);
  }

  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    if (fidelity_ == chain::Fidelity::first_order) return chain::first_order_trace(deformation_, pose, errors);
    return chain::deformation_trace(deformation_, pose, errors, options);
  }

  double rounding(std::size_t response) const override { return chain::effect_rounding(deformation_, response); }

  std::vector<double> norm_of_details(std::size_t response, std::span<const double> pose) const override {
    return chain::norm_of_details(deformation_, response, pose);
  }

  std::vector<PlatformPoint> metric_points() const override {
    std::vector<PlatformPoint> points;
    for (const Vector3& point : deformation_.points) points.push_back({point.x(), point.y(), point.z()});
    return points;
  }

  /// Lengths are bounded by the smaller of the platform and the base, which every limb joins; the offsets c and d are
  /// not links and may be 0.
  ErrorBound error_bound(FactorIndex factor) const override {
    if (description_.factors[factor.value].dimension == Dimension::angle) return {std::numbers::pi, "half a turn"};
    if (geometry_.l_A < geometry_.l_B) return {geometry_.l_A, "the platform's size l_A"};
    return {geometry_.l_B, "the base's size l_B"};
  }

  std::optional<Sketch> sketch(std::span<const double> pose) const override {
    Sketch sketch{.limbs = joints(), .platform = {}, .tool = {}};
    chain::place(sketch, deformation_,
                 pose.empty() ? std::vector(deformation_.chain.joints(), 0.0) : joint_displacements(pose));
    return sketch;
  }

  std::vector<std::string> unusual_geometry() const override {
    if (geometry_.l_A <= geometry_.l_B) return {};
    return {"the platform (l_A = " + readable_text({geometry_.l_A, Dimension::length}) +
            ") is larger than the base (l_B = " + readable_text({geometry_.l_B, Dimension::length}) + ")"};
  }

 private:
  /// The limbs do not meet if a leg has no length, or if a coordinate is so large that digits are lost.
  std::optional<std::string> open_loop(const Pose& pose) const {
    const auto q = two_upr_rpu::joint_displacements(geometry_, pose);
    const lie::Transform<double> wanted = base_T_platform(pose);
    for (std::size_t i = 0; i < deformation_.chain.limbs.size(); ++i) {
      const chain::Limb& limb = deformation_.chain.limbs[i];
      const auto reached = chain::forward_kinematics<double>(limb, limb.home, std::span(q).subspan(4 * i, 4),
                                                             [](std::size_t, const lie::Screw<double>&) {});
      if (!are_same(reached, wanted, deformation_.chain.reach())) {
        return "limb " + std::to_string(i + 1) + " cannot reach the platform there";
      }
    }
    return std::nullopt;
  }

  Geometry geometry_;
  chain::DeformationModel deformation_;
  ModelDescription description_;
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
  return std::make_unique<TwoUprRpu>(checked_geometry(values), std::vector<Vector3>(),
                                     static_cast<chain::Fidelity>(fidelity));
}

std::unique_ptr<Model> build_by_platform(std::span<const double> values, std::size_t fidelity) {
  const Geometry geometry = checked_geometry(values);
  return std::make_unique<TwoUprRpu>(geometry, platform_joints(geometry), static_cast<chain::Fidelity>(fidelity));
}

std::unique_ptr<Model> build_with_points(std::span<const double> values, std::size_t fidelity,
                                         std::span<const PlatformPoint> points) {
  std::vector<Vector3> own;
  for (const PlatformPoint& point : points) own.emplace_back(point[0], point[1], point[2]);
  const Geometry geometry = checked_geometry(values);
  if (const std::string why = chain::why_no_metric(own, parallel_chain(geometry).reach()); !why.empty()) {
    throw std::invalid_argument(why);
  }
  return std::make_unique<TwoUprRpu>(geometry, own, static_cast<chain::Fidelity>(fidelity));
}

}  // namespace

CatalogEntry catalog_entry() {
  const Geometry published;
  CatalogEntry by_platform{describe(deformation_model(published, platform_joints(published))), build_by_platform};
  by_platform.build_with_points = build_with_points;
  return {describe(deformation_model(published, {})), build_as_published,
          std::make_shared<const CatalogEntry>(std::move(by_platform))};
}

}  // namespace poesy::two_upr_rpu
