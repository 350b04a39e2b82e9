// Compares what remains after the best correction of the drives with solves of the same machine with moved drives.
#include "models/assembly/calibration.h"

#include <Eigen/QR>

#include "tests/models/assembly/made.h"

namespace poesy::assembly {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// An assembly at a pose whose drives can be moved. Moving a drive moves the frame before the actuated joint along or
/// about the joint's axis.
class Driven {
 public:
  Driven(const AssemblyModel& model, const std::vector<double>& pose) : model_(model), at_(model.at(pose)) {
    for (std::size_t e = 0; e < model.assembly.limbs.size(); ++e) {
      const std::vector<chain::Joint>& joints = model.assembly.limbs[e].chain.joints;
      for (std::size_t j = 0; j < joints.size(); ++j) {
        if (joints[j].actuated && !joints[j].fixed) drives_.push_back({e, j});
      }
    }
  }

  Eigen::Index drives() const { return static_cast<Eigen::Index>(drives_.size()); }

  /// [6 bodies] The displacements [moved; theta] (m, rad) of all bodies except the base.
  Vector displacements(const std::vector<double>& errors, const Vector& by_drives) const {
    ErrorFrames frames(model_);
    std::vector<std::vector<Transform>> moved = frames.with(errors, at_.displacements);
    for (std::size_t d = 0; d < drives_.size(); ++d) {
      const auto [e, j] = drives_[d];
      chain::move_joint(model_.assembly.limbs[e].chain.joints[j], by_drives[static_cast<Eigen::Index>(d)], moved[e][j]);
    }
    Solver solver(model_.assembly, model_.ranks, kOptions);
    solver.prepare(at_);
    const Solution found = solver.solve(moved);
    EXPECT_TRUE(solved(found.status));
    const Outcome outcome = outcome_of(model_.assembly, at_, found);
    Vector all(6 * (static_cast<Eigen::Index>(outcome.bodies.size()) - 1));
    for (std::size_t b = kPlatform; b < outcome.bodies.size(); ++b) {
      all.segment<6>(6 * static_cast<Eigen::Index>(b - kPlatform)) << outcome.bodies[b].moved, outcome.bodies[b].theta;
    }
    return all;
  }

  /// [3 points] The displacements of the platform's points (m) for this displacement of the platform.
  Vector of_points(const Vector& displacements) const {
    Vector moved(3 * static_cast<Eigen::Index>(model_.assembly.points.size()));
    const Vector3 theta = displacements.segment<3>(3);
    for (std::size_t k = 0; k < model_.assembly.points.size(); ++k) {
      const Vector3 arm = at_.bodies[kPlatform].R * model_.assembly.points[k];
      moved.segment<3>(3 * static_cast<Eigen::Index>(k)) = displacements.head<3>() + theta.cross(arm);
    }
    return moved;
  }

 private:
  const AssemblyModel& model_;
  Nominal at_;
  std::vector<std::pair<std::size_t, std::size_t>> drives_;  ///< limb and joint of each drive
};

class Calibration : public testing::TestWithParam<std::tuple<const char*, Metric>> {};

/// The errors are some nm and 1e-6 deg, so small that the correction has no effect of second order.
TEST_P(Calibration, Holds) {
  const auto [name, metric] = GetParam();
  const auto& one =
      *std::ranges::find_if(cases(), [&sought = name](const Case& each) { return std::string(each.name) == sought; });
  AssemblyModel model = made(one.text(), metric);
  model.assembly.load = {};
  const Driven driven(model, one.pose);
  const std::vector<double> errors = random_errors(model, 1e-6, 3);
  const std::vector<double> none(errors.size(), 0.0);
  const Vector still = Vector::Zero(driven.drives());
  constexpr double kStep = 1e-5;
  Matrix by_drive(3 * static_cast<Eigen::Index>(model.assembly.points.size()), driven.drives());
  for (Eigen::Index d = 0; d < driven.drives(); ++d) {
    const Vector step = kStep * Vector::Unit(driven.drives(), d);
    const Vector effect = (driven.displacements(none, step) - driven.displacements(none, -step)) / (2.0 * kStep);
    by_drive.col(d) = driven.of_points(effect);
  }
  const Vector effect = driven.displacements(errors, still);
  const Vector correction = -by_drive.completeOrthogonalDecomposition().solve(driven.of_points(effect));
  const Vector left = driven.displacements(errors, correction);
  for (const chain::Fidelity fidelity : {kExact, kFirstOrder}) {
    Answers found{responses_of(model), {}, model.assembly.reach};
    found.values.resize(found.responses.size());
    SolveStatus status{};
    std::uint32_t iterations = 0;
    calibrated_evaluator(model, kOptions, fidelity)
        ->evaluate({one.pose, errors, {}, {}, 1}, {found.values, {&status, 1}, {&iterations, 1}, {}});
    EXPECT_TRUE(solved(status));
    const Answers uncorrected = answers(model, one.pose, errors, fidelity);
    for (std::size_t b = kPlatform; b < model.assembly.bodies.size(); ++b) {
      const std::string prefix = b == kPlatform ? "" : model.assembly.bodies[b].name + "_";
      Eigen::Index row = 6 * static_cast<Eigen::Index>(b - kPlatform);
      for (const char* component : {"x", "y", "z", "theta_x", "theta_y", "theta_z"}) {
        const double unit = std::string(component).size() > 1 ? 1.0 : model.assembly.reach;
        EXPECT_NEAR(found[prefix + component], left[row++], 1e-6 * unit * effect.cwiseAbs().maxCoeff())
            << prefix << component;
      }
      EXPECT_NEAR(found[prefix + "rotation"],
                  Vector3(found[prefix + "theta_x"], found[prefix + "theta_y"], found[prefix + "theta_z"]).norm(),
                  1e-20);
    }
    for (const char* same : {"gap", "strain_energy"}) {
      const auto at = std::ranges::find(found.responses, same, &Response::name);
      if (at == found.responses.end()) continue;
      EXPECT_EQ(found[same], uncorrected[same]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Calibration,
                         testing::Combine(testing::Values("linear-delta", "delta-parallelogram", "upr2-rpu-beams",
                                                          "tripteron-msa"),
                                          testing::ValuesIn(kMetrics)),
                         [](const auto& one) {
                           std::string name = std::get<0>(one.param);
                           std::ranges::replace(name, '-', '_');
                           return name + (std::get<1>(one.param) == Metric::stiffness ? "_stiffness" : "_metric");
                         });

}  // namespace
}  // namespace poesy::assembly
