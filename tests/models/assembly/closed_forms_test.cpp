#include <gtest/gtest.h>

#include <numbers>

#include "engine/linalg/decompositions.h"
#include "tests/models/assembly/made.h"

// Assemblies whose displacements and forces have closed forms.
namespace poesy::assembly {
namespace {

constexpr double kRounding = 1e-15;  ///< tolerance, relative to the largest value of its kind
/// Tolerance for slender rods. The axial compliance is 1/1000 of the transverse one and is computed as a difference, so
/// three digits are lost.
constexpr double kOfRods = 1e-13;

/// The model of a mechanism file without its loads.
AssemblyModel unloaded(const std::string& text, Metric metric) {
  AssemblyModel model = made(text, metric);
  model.assembly.load = {};
  return model;
}

// ---- a table on four legs

TEST(AssemblyClosedForms, ATableWithALegTooLong) {
  const std::string text = file::text_of("lift-table");
  const AssemblyModel model = unloaded(text, Metric::stiffness);
  constexpr double kStiffness = 90e6;
  constexpr double kA = 0.4;
  constexpr double kB = 0.25;
  const double d = 0.1 * kMillimetre;
  const Answers found = answers(model, {0.6, 0.0, 0.0}, named_errors(text, {{"leg_1", d}}), kFirstOrder);
  EXPECT_NEAR(found["z"], d / 4.0, kRounding * d);
  EXPECT_NEAR(found["theta_x"], d / (4.0 * kB), kRounding * d / kB);
  EXPECT_NEAR(found["theta_y"], -d / (4.0 * kA), kRounding * d / kA);
  EXPECT_NEAR(found["x"], 0.0, kRounding * d);
  EXPECT_NEAR(found["y"], 0.0, kRounding * d);
  EXPECT_NEAR(found["strain_energy"], kStiffness * d * d / 8.0, kRounding * kStiffness * d * d);
  const double force = kStiffness * d / 4.0;
  for (const auto& [leg, sign] : std::map<std::string, double>{{"1", 1.0}, {"2", -1.0}, {"3", 1.0}, {"4", -1.0}}) {
    EXPECT_NEAR(found["actuator_screw_" + leg], sign * force, 4.0 * kRounding * force) << leg;
    EXPECT_NEAR(found["force_" + leg], force, 4.0 * kRounding * force) << leg;
  }
}

// ---- rods side by side

constexpr const char* kPlanar = R"(format = "poesy-mechanism"
version = 1
name = "rods"

[geometry]
w = "100 mm"
l = "400 mm"

[platform]
origin = [0, 0, "l"]
coordinates = ["x"]
workspace = { x = ["-20 mm", "100 mm"] }
points = [[0, 0, 0], ["w", 0, 0], [0, "50 mm", 0]]

[[error]]
name = "rod"
limb = "each"
frame = "A"
component = "delta_x"
)";

/// The text of a limb: a rod between two hinges at this x.
std::string rod(const std::string& x, bool driven) {
  return "\n[[limb]]\njoints = [\n  { name = \"A\", type = \"R\", at = [" + x +
         ", 0, 0], axis = \"y\", reaction = true" + (driven ? ", actuated = true" : "") +
         " },\n  { name = \"B\", type = \"R\", at = [" + x +
         ", 0, \"l\"], axis = \"y\" } ]\n"
         "links = [ { from = \"A\", to = \"B\", E = \"70 GPa\", G = \"26 GPa\", diameter = \"20 mm\" } ]\n";
}

TEST(AssemblyClosedForms, ThreeRodsSideBySide) {
  const std::string text = kPlanar + rod("\"-w\"", true) + rod("0", false) + rod("\"w\"", false);
  const AssemblyModel model = made(text, Metric::stiffness);
  const double stiffness = 70e9 * std::numbers::pi * 0.02 * 0.02 / 4.0 / 0.4;
  const double d = 0.1 * kMillimetre;
  const double force = stiffness * d / 6.0;
  const std::vector<double> by_outer{1.0, -2.0, 1.0};
  for (const auto& [name, factor] : std::map<std::string, double>{{"rod_1", 1.0}, {"rod_2", -2.0}, {"rod_3", 1.0}}) {
    const Answers found = answers(model, {0.0}, named_errors(text, {{name, d}}), kFirstOrder);
    for (std::size_t k = 0; k < 3; ++k) {  // the hinge's x axis is along the rod: a positive fx pushes
      EXPECT_NEAR(found["reaction_A_" + std::to_string(k + 1) + "_fx"], factor * by_outer[k] * force, kOfRods * force)
          << name << ", rod " << k + 1;
      EXPECT_NEAR(found["reaction_A_" + std::to_string(k + 1) + "_fy"], 0.0, kOfRods * force);
    }
    EXPECT_NEAR(found["strain_energy"], factor * factor * stiffness * d * d / 12.0, kOfRods * stiffness * d * d);
  }
}

TEST(AssemblyClosedForms, AParallelogramWithARodTooLong) {
  const std::string text = kPlanar + rod("0", true) + rod("\"w\"", false);
  constexpr double kW = 0.1;
  constexpr double kL = 0.4;
  const double d = 1.0 * kMillimetre;
  const double x = 0.05;
  for (const Metric metric : kMetrics) {
    const Answers found = answers(made(text, metric), {x}, named_errors(text, {{"rod_2", d}}), kExact);
    // The driven rod ends at B, where the coupler begins. The other end of the coupler is the intersection of two
    // circles.
    const Eigen::Vector2d B(x, std::sqrt(kL * kL - x * x));
    const Eigen::Vector2d to = Eigen::Vector2d(kW, 0.0) - B;
    const double along = (to.squaredNorm() + kW * kW - (kL + d) * (kL + d)) / (2.0 * to.norm());
    const double beside = std::sqrt(kW * kW - along * along);
    const Eigen::Vector2d u = to.normalized();
    const Eigen::Vector2d coupler = along * u + beside * Eigen::Vector2d(-u.y(), u.x());
    EXPECT_NEAR(found["theta_y"], std::atan2(-coupler.y(), coupler.x()), 1e-14);
    for (const char* zero : {"x", "y", "z", "theta_x", "theta_z", "gap"}) EXPECT_NEAR(found[zero], 0.0, 1e-15) << zero;
  }
}

// ---- a Delta with a rod too long

/// The pose base_T_platform at which six rods with these lengths (m) hold the platform, by Newton's method. ends: in
/// the base frame; on_platform: in the platform frame (m). at: initial pose.
Transform held_by(const std::vector<Vector3>& ends, const std::vector<Vector3>& on_platform,
                  const std::vector<double>& lengths, Transform at) {
  for (int n = 0; n < 20; ++n) {
    Eigen::MatrixXd rows(6, 6);
    Eigen::VectorXd left(6);
    for (Eigen::Index k = 0; k < 6; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Vector3 arm = at.R * on_platform[i];
      const Vector3 rod = at.p + arm - ends[i];
      rows.row(k) << arm.cross(rod).transpose(), rod.transpose();  // rotation and translation of the platform
      left[k] = 0.5 * (lengths[i] * lengths[i] - rod.squaredNorm());
    }
    const Eigen::VectorXd step = linalg::solve(rows, left);
    at.R = lie::exp<double>(Vector3(step.head<3>())) * at.R;
    at.p += step.tail<3>();
  }
  return at;
}

TEST(AssemblyClosedForms, ALinearDeltaWithARodTooLong) {
  const std::string text = file::text_of("linear-delta");
  const double d = 0.1 * kMillimetre;
  const std::vector<double> errors = named_errors(text, {{"rod_left_2", d}});
  for (const Metric metric : kMetrics) {
    const AssemblyModel model = unloaded(text, metric);
    const Nominal pose = model.at(std::vector<double>{0.05, -0.03, 0.21});
    std::vector<Vector3> ends;
    std::vector<Vector3> on_platform;
    std::vector<double> lengths;
    const Transform& platform = pose.bodies[kPlatform];
    for (std::size_t e = 0; e < model.assembly.limbs.size(); ++e) {
      const Limb& limb = model.assembly.limbs[e];
      if (limb.to != kPlatform) continue;
      const Vector3& begin = pose.limbs[e].before[0].p;
      const Vector3& end = pose.limbs[e].before[3].p;
      ends.push_back(begin);
      on_platform.emplace_back(platform.R.transpose() * (end - platform.p));
      lengths.push_back((end - begin).norm() + (limb.label == "left_2" ? d : 0.0));
    }
    const Transform wanted = held_by(ends, on_platform, lengths, platform);
    const Answers found = answers(model, {0.05, -0.03, 0.21}, errors, kExact);
    const Vector3 moved = wanted.p - platform.p;
    const Vector3 turned = lie::log<double>(wanted.R * platform.R.transpose());
    for (Eigen::Index k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      EXPECT_NEAR(found[axis], moved[k], 3e-15);
      EXPECT_NEAR(found["theta_" + axis], turned[k], 3e-15);
    }
    EXPECT_NEAR(found["rotation"], 1.460888e-3, 5e-10);
    EXPECT_NEAR(found["position"], 0.1498077e-3, 5e-11);
  }
}

}  // namespace
}  // namespace poesy::assembly
