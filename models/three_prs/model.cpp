#include "models/three_prs/model.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/base/contract.h"
#include "models/three_prs/closure.h"
#include "models/three_prs/error_mapping.h"
#include "models/three_prs/errors.h"
#include "models/three_prs/evaluators.h"
#include "models/three_prs/kinematics.h"
#include "models/three_prs/sketch.h"

namespace poesy::three_prs {
namespace {

enum Chart : std::size_t { tip, carriages };

/// The charts in the order of Chart.
std::vector<PoseChart> charts() {
  return {{"tip",
           {{"tip_x", Dimension::length, "x of the tool tip in the base frame"},
            {"tip_y", Dimension::length, "y of the tool tip in the base frame"},
            {"tip_z", Dimension::length, "z of the tool tip in the base frame, downwards"}},
           "lengthen h, for the tool may be too short, or move the point nearer to x = y = 0"},
          {"carriages",
           {{"q_1", Dimension::length, "carriage 1 along its rail, downwards from the upper end"},
            {"q_2", Dimension::length, "carriage 2 along its rail"},
            {"q_3", Dimension::length, "carriage 3 along its rail"}},
           "bring q_1, q_2, q_3 closer together, for the carriages may be too far apart for the rods"}};
}

/// The curves of San et al. 2023, Section 5.2.1. The paper prints no start height; the origin chosen here keeps the
/// carriages on their rails.
std::vector<NamedCurve> curves() {
  const std::vector<double> origin{0.0, 0.0, 0.85};
  const auto helix = [](double t) {
    const double angle = std::numbers::pi * t;
    return std::vector{0.03 * std::cos(angle), 0.03 * std::sin(angle), 0.03 * t};
  };
  const auto spiral = [](double t) {
    const double angle = std::numbers::pi * t;
    return std::vector{0.015 * t * std::cos(angle), 0.015 * t * std::sin(angle), 0.015 * t};
  };
  return {{"helix", "30 cos(pi t), 30 sin(pi t), 30 t mm, the paper's first trajectory", Chart::tip, 0.0, 2.0, origin,
           helix},
          {"growing-spiral", "15 t cos(pi t), 15 t sin(pi t), 15 t mm, the paper's second trajectory", Chart::tip, 0.0,
           2.0, origin, spiral}};
}

ModelDescription describe() {
  constexpr double kTilt = std::numbers::pi / 9.0;
  const Geometry published;
  ModelDescription description;
  description.name = "3-prs";
  description.title = "3-PRS parallel mechanism of a hybrid robot (San, Ding, Zhang, Wu 2023, Actuators 12, 324)";
  description.geometry = {
      {"a", Dimension::length, published.a, "radius of the circle on which the rails stand"},
      {"c", Dimension::length, published.c, "radius of the circle of the spherical joints on the platform"},
      {"l", Dimension::length, published.l, "length of the rods"},
      {"rail", Dimension::length, published.rail, "travel of the carriages: each q from 0 to this"},
      {"h", Dimension::length, published.h,
       "tool tip below P on the platform's axis; the paper prints none, this is the value of our reference numbers"}};
  description.pose_coordinates = {
      {"alpha", Dimension::angle, "rotation of the platform about the base's x axis"},
      {"beta", Dimension::angle, "rotation of the platform about its y axis after alpha"},
      {"z", Dimension::length, "z of the platform's centre P in the base frame, downwards from the rails' upper ends"}};
  description.factors = factors();
  description.factor_sets = factor_sets();
  description.responses = responses();
  description.details = details();
  for (std::size_t i = 1; i <= kLimbs; ++i) {
    description.joints.push_back({"q_" + std::to_string(i), Dimension::length, true});
    description.joints.push_back({"th_" + std::to_string(i), Dimension::angle});
  }
  description.pose_lower = {-kTilt, -kTilt, 0.62};
  description.pose_upper = {kTilt, kTilt, 0.99};
  description.workspace_note =
      "The paper states no workspace. This box is chosen: with the published geometry the rails suffice in all of it.";
  description.sources = {
      {"FS", "platform-hinges"}, {"T", "initial-position"}, {"R", "revolute-gap"}, {"L", "rod-length"}};
  description.fidelities = {"exact", "first-order"};
  description.headline = {kComponents + 2, kComponents, kComponents + 1};
  description.signed_headline = {kTip, kTip + 1, kTip + 2, kComponents};
  description.charts = charts();
  description.curves = curves();
  description.separation = separation_description();
  return description;
}

Pose pose_from(std::span<const double> pose) {
  POESY_EXPECTS(pose.size() == 3);
  return {pose[0], pose[1], pose[2]};
}

bool is_tilt(double angle) { return std::abs(angle) < std::numbers::pi / 2.0; }

class ThreePrs final : public Model {
 public:
  ThreePrs(const Geometry& geometry, Fidelity fidelity) : geometry_(geometry), fidelity_(fidelity) {}

  const ModelDescription& description() const override { return description_; }

  std::optional<std::string> unreachable(std::span<const double> pose) const override {
    const Pose wanted = pose_from(pose);
    if (!is_tilt(wanted.alpha)) return "alpha must lie between -90 and 90 deg";
    if (!is_tilt(wanted.beta)) return "beta must lie between -90 and 90 deg";
    const Configuration nominal = configuration(geometry_, wanted);
    for (std::size_t i = 0; i < kLimbs; ++i) {
      if (auto reason = off_rail(nominal.limbs[i].q)) return "limb " + std::to_string(i + 1) + *reason;
    }
    return std::nullopt;
  }

  std::vector<double> joint_displacements(std::span<const double> pose) const override {
    std::vector<double> list;
    for (const LimbConfiguration& limb : configuration(geometry_, pose_from(pose)).limbs) {
      list.push_back(limb.q);
      list.push_back(limb.swing);
    }
    return list;
  }

  double condition(std::span<const double> pose) const override {
    return three_prs::condition(geometry_, configuration(geometry_, pose_from(pose)));
  }

  std::optional<std::vector<double>> pose_from_chart(std::size_t chart,
                                                     std::span<const double> coordinates) const override {
    POESY_EXPECTS(coordinates.size() == 3);
    const lie::Vector3<double> given(coordinates[0], coordinates[1], coordinates[2]);
    const auto pose = chart == Chart::tip ? pose_of_tip(geometry_, given) : pose_of_carriages(geometry_, given);
    if (!pose) return std::nullopt;
    return std::vector{pose->alpha, pose->beta, pose->z};
  }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return head_evaluator(geometry_, fidelity_, options);
  }

  std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& options) const override {
    return calibrated_head_evaluator(geometry_, fidelity_, options);
  }

  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    return head_trace(geometry_, fidelity_, pose, errors, options);
  }

  /// The level at which exact solves stop. Rounding gives their responses a standard deviation of up to a tenth of this
  /// level. First-order solves do not iterate, so they have no such rounding.
  double rounding(std::size_t /*response*/) const override {
    if (fidelity_ == Fidelity::first_order) return 0.0;
    return rounding_level({geometry_.a, 0.0, geometry_.rail + geometry_.l + geometry_.h});
  }

  std::optional<Sketch> sketch(std::span<const double> pose) const override {
    return three_prs::sketch(geometry_,
                             configuration(geometry_, pose.empty() ? home_pose(geometry_) : pose_from(pose)));
  }

  ErrorBound error_bound(FactorIndex factor) const override {
    const auto source = static_cast<Source>(factor.value % kSources);
    if (description_.factors[factor.value].dimension == Dimension::angle) return {std::numbers::pi, "half a turn"};
    if (source < Source::q) return {geometry_.a, "the radius a of the rails' circle"};
    if (source == Source::q) return {geometry_.rail, "the travel of the carriages"};
    if (source < Source::c) return {geometry_.l, "the length l of the rods"};
    return {geometry_.c, "the radius c of the spherical joints' circle"};
  }

  std::vector<std::string> unusual_geometry() const override {
    if (geometry_.c <= geometry_.a) return {};
    return {"the platform's circle of joints (c = " + readable_text({geometry_.c, Dimension::length}) +
            ") is larger than the circle of the rails (a = " + readable_text({geometry_.a, Dimension::length}) + ")"};
  }

  Separation separation(std::span<const double> pose) const override {
    return three_prs::separation(geometry_, configuration(geometry_, pose_from(pose)));
  }

 private:
  std::optional<std::string> off_rail(double q) const {
    if (!std::isfinite(q)) return ": the rod does not reach from the rail to the platform";
    if (q < 0.0) return ": the carriage would stand above the upper end of its rail";
    if (q > geometry_.rail) return ": the carriage would stand below the lower end of its rail";
    return std::nullopt;
  }

  Geometry geometry_;
  Fidelity fidelity_;
  ModelDescription description_ = describe();
};

void require(bool holds, const char* rule) {
  if (!holds) throw std::invalid_argument(rule);
}

std::unique_ptr<Model> build(std::span<const double> values, std::size_t fidelity) {
  POESY_EXPECTS(values.size() == 5 && fidelity < 2);
  const Geometry geometry{values[0], values[1], values[2], values[3], values[4]};
  require(geometry.a > 0.0, "a must be positive");
  require(geometry.c > 0.0, "c must be positive");
  require(geometry.l > std::abs(geometry.a - geometry.c), "l must be greater than the difference of a and c");
  require(geometry.rail > 0.0, "rail must be positive");
  require(geometry.h >= 0.0, "h must not be negative");
  return std::make_unique<ThreePrs>(geometry, static_cast<Fidelity>(fidelity));
}

}  // namespace

CatalogEntry catalog_entry() { return {describe(), build}; }

}  // namespace poesy::three_prs
