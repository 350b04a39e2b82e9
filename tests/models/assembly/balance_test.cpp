#include <gtest/gtest.h>

#include "models/assembly/first_order.h"
#include "tests/models/assembly/made.h"

// Tests that the wrenches balance, that they do no work in passive joints, and that they are the derivatives of the
// energy.
namespace poesy::assembly {
namespace {

using Eigen::Index;

Index row_of(std::size_t k) { return 6 * static_cast<Index>(k); }

/// The largest of all limbs' forces and of their moments divided by the reach (N).
double largest(const AssemblyModel& model, const std::vector<Screw>& wrenches) {
  double most = 0.0;
  for (const Screw& wrench : wrenches) {
    most = std::max({most, wrench.tail<3>().norm(), wrench.head<3>().norm() / model.assembly.reach});
  }
  return most;
}

/// Expects that at each body the limbs' wrenches and the load add up to zero, and that the wrenches do no work in
/// passive joints.
void expect_balance(const AssemblyModel& model, const Nominal& pose, const std::vector<LimbState>& limbs,
                    const std::vector<Screw>& wrenches) {
  const double reach = model.assembly.reach;
  const double tolerance = 1e-12 * largest(model, wrenches);
  std::vector<Screw> sums = pose.load;
  for (std::size_t e = 0; e < wrenches.size(); ++e) {
    const Limb& limb = model.assembly.limbs[e];
    sums[limb.to] += wrenches[e];
    sums[limb.from] -= wrenches[e];
    Index passive = 0;
    for (const chain::Joint& joint : limb.chain.joints) {
      if (joint.actuated) continue;
      const double felt = limbs[e].passive.col(passive++).dot(wrenches[e]);
      EXPECT_LE(std::abs(felt), tolerance * (joint.type == chain::JointType::prismatic ? 1.0 : reach))
          << "limb " << limb.label << ", passive joint " << passive;
    }
  }
  for (std::size_t b = kPlatform; b < sums.size(); ++b) {
    EXPECT_LE(sums[b].tail<3>().norm(), tolerance) << model.assembly.bodies[b].name;
    EXPECT_LE(sums[b].head<3>().norm(), tolerance * reach) << model.assembly.bodies[b].name;
  }
}

/// The wrenches of the limbs in one column of a balance.
std::vector<Screw> wrenches_of(const Balance& balance, Index column = 0) {
  std::vector<Screw> list;
  for (Index row = 0; row < balance.wrenches.rows(); row += 6) {
    list.emplace_back(balance.wrenches.block<6, 1>(row, column));
  }
  return list;
}

/// Calls check(model, pose) for each case with the stiffness metric.
template <class Check>
void for_each_case(Check check) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.name);
    const AssemblyModel model = made(one.text(), Metric::stiffness);
    check(model, model.at(one.pose));
  }
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Index>(values.size()));
}

TEST(AssemblyBalance, ExactForcesBalance) {
  for_each_case([](const AssemblyModel& model, const Nominal& pose) {
    for (const double size : {0.1, 1.0}) {
      const std::vector<double> errors = random_errors(model, size, 5);
      const Solution solution = solution_of(model, pose, errors);
      ASSERT_TRUE(solved(solution.status));
      expect_balance(model, pose, solution.limbs, solution.wrenches);
    }
  });
}

TEST(AssemblyBalance, FirstOrderForcesBalance) {
  for_each_case([](const AssemblyModel& model, const Nominal& pose) {
    const FirstOrder first_order(model.assembly, pose, model.ranks);
    Balance sum = first_order.effect(error_twists(model, pose) * vector_of(random_errors(model, 0.1, 6)));
    sum.wrenches += first_order.by_load().wrenches;
    expect_balance(model, pose, pose.limbs, wrenches_of(sum));
  });
}

/// The components of a passive joint's reaction along its freedoms. They must vanish. None for an actuated joint.
std::vector<std::string> free_components(const file::Joint& joint) {
  if (joint.actuated) return {};
  switch (joint.kind) {
    case file::JointKind::spherical:
      return {"mx", "my", "mz"};
    case file::JointKind::revolute:
      return {"mz"};
    case file::JointKind::prismatic:
      return {"fz"};
    default:
      return {};
  }
}

TEST(AssemblyBalance, ReactionsAlongFreedomsVanish) {
  std::size_t compared = 0;
  for (const Case& one : cases()) {
    const file::Mechanism mechanism = file::from_file(one.name);
    const AssemblyModel model = made(one.text(), Metric::stiffness);
    for (const chain::Fidelity fidelity : {kExact, kFirstOrder}) {
      const Answers found = answers(model, one.pose, random_errors(model, 0.1, 9), fidelity);
      std::map<Dimension, double> most = largest_of(found);
      for (const ReportedJoint& reported : model.report.reactions) {
        const file::Limb& limb = mechanism.limbs[reported.limb];
        const std::string name = "reaction_" + reported.name + "_" + limb.label + "_";
        for (const std::string& component : free_components(limb.joints[reported.joint])) {
          ++compared;
          const Dimension dimension = component[0] == 'f' ? Dimension::force : Dimension::moment;
          EXPECT_NEAR(found[name + component], 0.0, 1e-12 * most[dimension]) << one.name << ", " << name << component;
        }
      }
    }
  }
  EXPECT_GE(compared, 60u);
}

/// [6 limbs x drives] The twists of the limbs' ends per displacement of each drive.
Eigen::MatrixXd drive_twists(const AssemblyModel& model, const Nominal& pose) {
  const std::vector<ReportedJoint>& drives = model.report.drives;
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(row_of(model.assembly.limbs.size()), static_cast<Index>(drives.size()));
  for (std::size_t d = 0; d < drives.size(); ++d) {
    const chain::Joint& joint = model.assembly.limbs[drives[d].limb].chain.joints[drives[d].joint];
    columns.block<6, 1>(row_of(drives[d].limb), static_cast<Index>(d)) =
        pose.limbs[drives[d].limb].twist(joint, drives[d].joint);
  }
  return columns;
}

double energy(const Nominal& pose, const Balance& balance) {
  double sum = 0.0;
  const std::vector<Screw> wrenches = wrenches_of(balance);
  for (std::size_t e = 0; e < wrenches.size(); ++e) sum += 0.5 * wrenches[e].dot(pose.compliance[e] * wrenches[e]);
  return sum;
}

TEST(AssemblyBalance, EnergyChangesByForcesOnErrorsDrives) {
  for_each_case([](const AssemblyModel& model, const Nominal& pose) {
    const FirstOrder first_order(model.assembly, pose, model.ranks);
    Eigen::MatrixXd twists(row_of(model.assembly.limbs.size()),
                           static_cast<Index>(model.terms.size() + model.report.drives.size()));
    twists << error_twists(model, pose), drive_twists(model, pose);
    std::vector<double> sizes = random_errors(model, 0.1, 7);
    sizes.resize(static_cast<std::size_t>(twists.cols()), 0.1 * kMillimetre);
    const Eigen::VectorXd errors = vector_of(sizes);
    const Eigen::VectorXd forces =
        twists.transpose() * first_order.effect(twists * errors).wrenches;  // along each error and each drive
    const double most = forces.cwiseProduct(errors).cwiseAbs().maxCoeff();
    for (Index f = 0; f < errors.size(); ++f) {
      const auto with = [&](double step) {  // exact, because the energy is quadratic
        const Eigen::VectorXd changed = errors + step * Eigen::VectorXd::Unit(errors.size(), f);
        return energy(pose, first_order.effect(twists * changed));
      };
      const double step = std::abs(errors[f]);
      EXPECT_NEAR((with(step) - with(-step)) / 2.0, forces[f] * step, 1e-11 * most) << "error " << f;
    }
  });
}

TEST(AssemblyBalance, ErrorsLoadNoDriveUnlessTooMany) {
  for (const char* name : {"upr2-rpu-beams", "delta-parallelogram", "tripteron-msa"}) {
    SCOPED_TRACE(name);
    const auto one = std::ranges::find(cases(), std::string(name), &Case::name);
    const AssemblyModel model = made(one->text(), Metric::stiffness);
    const Nominal pose = model.at(one->pose);
    const FirstOrder first_order(model.assembly, pose, model.ranks);
    const Balance balance = first_order.effect(error_twists(model, pose) * vector_of(random_errors(model, 0.1, 8)));
    const double most = largest(model, wrenches_of(balance));
    EXPECT_GT(most, 1.0) << "the limbs load each other";
    const Eigen::VectorXd drives = drive_twists(model, pose).transpose() * balance.wrenches;
    EXPECT_LE(drives.cwiseAbs().maxCoeff(), 1e-14 * most);
  }
}

TEST(AssemblyBalance, ErrorsLoadRedundantDrives) {
  const Case& table = cases().front();
  const AssemblyModel model = made(table.text(), Metric::stiffness);
  const Nominal pose = model.at(table.pose);
  const FirstOrder first_order(model.assembly, pose, model.ranks);
  const Balance balance = first_order.effect(error_twists(model, pose) * vector_of(random_errors(model, 0.1, 8)));
  EXPECT_GT((drive_twists(model, pose).transpose() * balance.wrenches).cwiseAbs().minCoeff(), 10.0);
}

}  // namespace
}  // namespace poesy::assembly
