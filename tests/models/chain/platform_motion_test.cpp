#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "models/chain/deformation_model.h"
#include "models/chain/deformation_solver.h"
#include "tests/models/chain/closed_chain.h"
#include "tests/support/isa.h"

namespace poesy::chain {
namespace {

using Vector3 = lie::Vector3<double>;

/// A random chain with helical joints. All six errors of each frame are errors of the model.
struct Example {
  std::vector<double> q;
  DeformationModel model;
};

Example example(const std::vector<std::size_t>& joints, std::mt19937_64& engine) {
  std::size_t all = 0;
  for (const std::size_t n : joints) all += n;
  Example one{random_displacements(all, 0.4, engine), {}};
  one.model.chain = closed_chain(joints, PassiveJoints::mixed, one.q, engine);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    // The first passive joint becomes a helical joint with displacement zero, so the chain stays closed.
    Limb& limb = one.model.chain.limbs[i];
    const std::size_t first =
        static_cast<std::size_t>(std::ranges::find(limb.joints, false, &Joint::actuated) - limb.joints.begin());
    lie::Transform<double> there;
    const double at = one.q[(i == 0 ? 0 : joints[0] * i) + first];
    move_joint({limb.joints[first].type, false}, at, there);
    limb.home[first] = limb.home[first] * there;
    one.q[joints[0] * i + first] = 0.0;
    limb.joints[first] = {JointType::revolute, false, 0.01};
    for (std::size_t frame = 0; frame < limb.frames(); ++frame) {
      for (std::size_t c = 0; c < 6; ++c) one.model.terms.push_back({{i, frame, c}});
    }
  }
  one.model.joint_displacements = [q = one.q](std::span<const double>) { return q; };
  one.model.platform = PlatformReport{Vector3(0.1, -0.2, 0.3)};
  return one;
}

/// The expected responses x, y, z, theta, position, rotation and displacement of the tool, from the plain solver and
/// the definitions with log and exp.
std::vector<double> truth_of(const Example& one, std::span<const double> errors) {
  const ParallelChain& chain = one.model.chain;
  std::vector<lie::Transform<double>> frames;
  std::size_t f = 0;
  for (const Limb& limb : chain.limbs) {
    for (std::size_t j = 0; j < limb.frames(); ++j, f += 6) {
      const Eigen::Map<const lie::Screw<double>> error(errors.data() + f);
      frames.push_back(frame_with_error<double>(limb, j, error));
    }
  }
  std::vector<double> q = one.q;
  std::vector<double> delta_mu(6 * chain.pairs.size());
  DeformationSolver({chain}, {.tolerance = 1e-15, .max_iterations = 400}).solve(frames, q, delta_mu);
  const lie::Transform<double> nominal = one.model.platform_points(one.q)->platform;
  lie::Screw<double> mean = lie::Screw<double>::Zero();
  std::size_t frame = 0, joint = 0;
  for (const Limb& limb : chain.limbs) {
    const auto pose = platform_pose(limb, std::span(frames).subspan(frame, limb.frames()),
                                    std::span<const double>(q).subspan(joint, limb.joints.size()));
    mean += lie::log(pose * nominal.inverse()) / static_cast<double>(chain.limbs.size());
    frame += limb.frames();
    joint += limb.joints.size();
  }
  const lie::Transform<double> D = lie::exp(mean);
  const auto moved = [&](const Vector3& p) -> Vector3 { return D.R * p + D.p - p; };
  const Vector3 origin = moved(nominal.p);
  const Vector3 tip = moved(nominal.R * *one.model.platform->tool + nominal.p);
  const Vector3 theta = mean.head<3>();
  return {origin.x(),    origin.y(),   origin.z(), theta.x(), theta.y(), theta.z(),
          origin.norm(), theta.norm(), tip.x(),    tip.y(),   tip.z(),   tip.norm()};
}

constexpr std::size_t kDeformations = 3;  ///< number of responses before those of the platform

struct Outcome {
  std::vector<double> responses;
  std::vector<SolveStatus> status;
};

Outcome evaluate(const Example& one, std::span<const double> values, std::size_t count, Fidelity fidelity) {
  const std::size_t factors = one.model.terms.size();
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < factors; ++f) varied.emplace_back(f);
  Outcome outcome{std::vector<double>((kDeformations + 12) * count), std::vector<SolveStatus>(count)};
  std::vector<std::uint32_t> iterations(count);
  const std::vector<double> zeros(factors, 0.0);
  deformation_evaluator(one.model, {}, fidelity)
      ->evaluate({{}, zeros, varied, values, count}, {outcome.responses, outcome.status, iterations, {}});
  return outcome;
}

class PlatformMotion : public test::WithIsa {};

TEST_P(PlatformMotion, IsTheMeanOfTheLimbs) {
  std::mt19937_64 engine(7);
  constexpr std::size_t kSets = 11;
  std::size_t compared = 0;
  for (const std::vector<std::size_t>& joints :
       {std::vector<std::size_t>{4, 4, 4}, {3, 3}, {4, 4, 4, 4}, {5, 5, 5, 5}}) {
    const Example one = example(joints, engine);
    const std::size_t factors = one.model.terms.size();
    const std::vector<double> values = random_displacements(factors * kSets, 1e-3, engine);
    const Outcome found = evaluate(one, values, kSets, Fidelity::exact);
    for (std::size_t b = 0; b < kSets; ++b) {
      if (!solved(found.status[b])) continue;
      ++compared;
      std::vector<double> errors;
      for (std::size_t f = 0; f < factors; ++f) errors.push_back(values[f * kSets + b]);
      const std::vector<double> truth = truth_of(one, errors);
      for (std::size_t r = 0; r < truth.size(); ++r) {
        EXPECT_NEAR(found.responses[(kDeformations + r) * kSets + b], truth[r], 1e-11) << r;
      }
    }
  }
  EXPECT_EQ(compared, 44u);
}

TEST_P(PlatformMotion, ToFirstOrderIsTheLimitOfSmallErrors) {
  std::mt19937_64 engine(8);
  const Example one = example({4, 4, 4}, engine);
  const std::size_t factors = one.model.terms.size();
  const std::vector<double> values = random_displacements(factors, 1e-6, engine);
  const Outcome exact = evaluate(one, values, 1, Fidelity::exact);
  const Outcome linear = evaluate(one, values, 1, Fidelity::first_order);
  for (std::size_t r = kDeformations; r < kDeformations + 12; ++r)
    EXPECT_NEAR(linear.responses[r], exact.responses[r], 1e-9) << r;
}

INSTANTIATE_TEST_SUITE_P(Isa, PlatformMotion, testing::ValuesIn(test::kEveryIsa), test::isa_name);

}  // namespace
}  // namespace poesy::chain
