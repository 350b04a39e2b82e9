// Random assemblies whose limbs all lead from the base to the platform. Tests the solved equation by its definition,
// the details of each pair of limbs, and the condition number.

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <array>
#include <cmath>

#include "models/assembly/details.h"
#include "tests/models/assembly/made.h"
#include "tests/models/assembly/random_assembly.h"
#include "tests/support/isa.h"

namespace poesy::assembly {
namespace {

using chain::PassiveJoints;

/// The outcome of one sample.
struct Found {
  std::vector<double> responses;
  std::vector<double> details;
  SolveStatus status{};
};

Found evaluate(const AssemblyModel& model, const std::vector<double>& errors, chain::Fidelity fidelity) {
  Found found{std::vector<double>(responses_of(model).size()), std::vector<double>(6 * model.pairs.size())};
  std::uint32_t iterations = 0;
  assembly_evaluator(model, kOptions, fidelity)
      ->evaluate({{}, errors, {}, {}, 1}, {found.responses, {&found.status, 1}, {&iterations, 1}, found.details});
  return found;
}

/// Calls check(model, errors) for five random assemblies of each shape. The errors are normal, sigma = 0.1 mm or deg.
template <class Check>
void for_each_assembly(unsigned seed, Check check) {
  std::mt19937_64 engine(seed);
  for (unsigned n = 0; n < 5; ++n) {
    for (const std::vector<std::size_t>& joints : limbs_of_random_assemblies()) {
      const AssemblyModel model = random_assembly(joints, PassiveJoints::mixed, engine);
      check(model, random_errors(model, 0.1, 10 * seed + n));
    }
  }
}

/// [6 x passive joints] The spatial Jacobian columns of a limb's passive joints, by finite differences of the platform
/// pose.
Eigen::MatrixXd columns_of(const chain::Limb& limb, std::span<const Transform> frames, std::vector<double> q) {
  constexpr double kStep = 1e-5;
  Eigen::MatrixXd columns(6, 0);
  for (std::size_t j = 0; j < limb.joints.size(); ++j) {
    if (limb.joints[j].actuated) continue;
    const double at = q[j];
    q[j] = at + kStep;
    const Transform ahead = chain::platform_pose(limb, frames, q);
    q[j] = at - kStep;
    const Transform behind = chain::platform_pose(limb, frames, q);
    q[j] = at;
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
    columns.rightCols<1>() = lie::log(ahead * behind.inverse()) / (2.0 * kStep);
  }
  return columns;
}

/// At the solution of the plain solver, the wrenches W xi of the limbs' mismatches xi balance on the platform and do no
/// work in passive joints.
TEST(UnbranchedAssembly, IsWhereTheEquationHolds) {
  for_each_assembly(3, [](const AssemblyModel& model, const std::vector<double>& errors) {
    const Nominal pose = model.at({});
    const Solution found = solution_of(model, pose, errors);
    ASSERT_TRUE(solved(found.status));
    ErrorFrames frames(model);
    const std::vector<std::vector<Transform>>& with_errors = frames.with(errors, pose.displacements);
    Screw sum = Screw::Zero();
    double largest = 0.0;
    std::size_t joint = 0;
    for (std::size_t e = 0; e < with_errors.size(); ++e) {
      const chain::Limb& limb = model.assembly.limbs[e].chain;
      const std::vector<double> q(
          found.displacements.begin() + static_cast<std::ptrdiff_t>(joint),
          found.displacements.begin() + static_cast<std::ptrdiff_t>(joint + limb.joints.size()));
      joint += limb.joints.size();
      const Transform end = chain::platform_pose(limb, with_errors[e], q);
      const Screw xi = lie::log(end * found.bodies[kPlatform].inverse());
      const Screw wrench = pose.W * xi;
      sum += wrench;
      largest = std::max(largest, xi.norm());
      EXPECT_LE((columns_of(limb, with_errors[e], q).transpose() * wrench).cwiseAbs().maxCoeff(), 1e-11);
    }
    EXPECT_LE(sum.cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_GT(largest, 1e-6);
  });
}

class EveryUnbranchedKernel : public test::WithIsa {};

/// The responses of a kernel are those of the plain solver. The details of a pair are the mismatch between the ends of
/// its limbs.
TEST_P(EveryUnbranchedKernel, TellsOfEachPair) {
  for_each_assembly(5, [](const AssemblyModel& model, const std::vector<double>& errors) {
    const Nominal pose = model.at({});
    const Solution wanted = solution_of(model, pose, errors);
    const Found found = evaluate(model, errors, kExact);
    EXPECT_EQ(found.status, SolveStatus::converged);
    const std::vector<double> responses =
        response_values(model.assembly, model.report, model.deforms, pose, outcome_of(model.assembly, pose, wanted));
    for (std::size_t r = 0; r < responses.size(); ++r) EXPECT_NEAR(found.responses[r], responses[r], 1e-12) << r;
    for (std::size_t n = 0; n < model.pairs.size(); ++n) {
      const auto [k, i] = model.pairs[n];
      const Screw apart = lie::log(wanted.limbs[k].end * wanted.limbs[i].end.inverse());
      for (std::size_t c = 0; c < 6; ++c) {
        EXPECT_NEAR(found.details[6 * n + c], apart[static_cast<Eigen::Index>(c)], 1e-12) << n << ' ' << c;
      }
    }
  });
}

/// To first order, the deformation responses are norms of the details.
TEST_P(EveryUnbranchedKernel, HasNormsOfDetails) {
  for_each_assembly(7, [](const AssemblyModel& model, const std::vector<double>& errors) {
    const Found found = evaluate(model, errors, kFirstOrder);
    const Eigen::Map<const Eigen::VectorXd> details(found.details.data(),
                                                    static_cast<Eigen::Index>(found.details.size()));
    for (std::size_t r = 0; r < kDeformations; ++r) {
      const std::vector<double> rows = norm_of_details(model, r, {});
      const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> norm(
          rows.data(), static_cast<Eigen::Index>(rows.size() / found.details.size()), details.size());
      EXPECT_NEAR((norm * details).norm(), found.responses[r], 1e-13) << r;
    }
    EXPECT_TRUE(norm_of_details(model, kDeformations, {}).empty());
  });
}

INSTANTIATE_TEST_SUITE_P(Isa, EveryUnbranchedKernel, testing::ValuesIn(test::kEveryIsa), test::isa_name);

/// The condition number of the matrix that maps passive joints to displacements of the platform's points, compared in
/// pairs of limbs. Its columns are normalised; it is computed by finite differences.
double condition_by_differences(const AssemblyModel& model) {
  const std::vector<double> q = model.joint_displacements({});
  const Transform platform = model.at({}).bodies[kPlatform];
  std::vector<Eigen::MatrixXd> moved;  // for each limb: [3 points x passive joints]
  Eigen::Index joints = 0;
  std::size_t first = 0;
  for (const Limb& limb : model.assembly.limbs) {
    const auto begin = q.begin() + static_cast<std::ptrdiff_t>(first);
    first += limb.chain.joints.size();
    const Eigen::MatrixXd twists =
        columns_of(limb.chain, limb.chain.home, {begin, q.begin() + static_cast<std::ptrdiff_t>(first)});
    Eigen::MatrixXd& rows = moved.emplace_back(0, twists.cols());
    for (const Vector3& point : model.assembly.points) {
      const Vector3 in_base = platform.R * point + platform.p;
      rows.conservativeResize(rows.rows() + 3, Eigen::NoChange);
      rows.bottomRows<3>() = twists.bottomRows<3>() - lie::hat<double>(in_base) * twists.topRows<3>();
    }
    joints += twists.cols();
  }
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(model.assembly.points.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows * static_cast<Eigen::Index>(model.pairs.size()), joints);
  for (std::size_t n = 0; n < model.pairs.size(); ++n) {
    Eigen::Index column = 0;
    for (std::size_t e = 0; e < moved.size(); ++e) {
      const double sign = e == model.pairs[n].k ? 1.0 : e == model.pairs[n].i ? -1.0 : 0.0;
      all.block(rows * static_cast<Eigen::Index>(n), column, rows, moved[e].cols()) = sign * moved[e];
      column += moved[e].cols();
    }
  }
  all.colwise().normalize();
  const Eigen::VectorXd values = all.jacobiSvd().singularValues();
  return values.maxCoeff() / values.minCoeff();
}

TEST(ConditionOfAnAssembly, IsOfItsPointsAndPairs) {
  std::mt19937_64 engine(15);
  std::size_t compared = 0;
  for (int n = 0; n < 10; ++n) {
    for (const PassiveJoints kind : {PassiveJoints::revolute, PassiveJoints::mixed}) {
      for (const std::vector<std::size_t>& joints : limbs_of_random_assemblies()) {
        const AssemblyModel model = random_assembly(joints, kind, engine);
        const double expected = condition_by_differences(model);
        if (expected > 1e4) continue;  // beyond the digits of finite differences
        ++compared;
        EXPECT_NEAR(condition(model, {}) / expected, 1.0, 1e-5) << expected;
      }
    }
  }
  EXPECT_GT(compared, 60u);
}

TEST(ConditionOfAnAssembly, IsInfiniteWithCollinearJoints) {
  std::mt19937_64 engine(13);
  AssemblyModel model = random_assembly({4, 4, 4}, PassiveJoints::revolute, engine);
  chain::Limb& limb = model.assembly.limbs[1].chain;
  const std::vector<double> q = model.joint_displacements({});
  limb.joints[2] = limb.joints[3] = {chain::JointType::revolute, false};
  limb.home[3] = Transform{};
  EXPECT_EQ(condition(model, {}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace poesy::assembly
