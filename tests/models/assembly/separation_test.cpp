#include "models/assembly/separation.h"

#include <gtest/gtest.h>

#include "tests/models/assembly/random_assembly.h"

namespace poesy::assembly {
namespace {

constexpr double kScale = 1000.0;

/// The same assembly with lengths in mm instead of m, in another base frame.
AssemblyModel in_other_words(const AssemblyModel& model, const Transform& base) {
  AssemblyModel made = model;
  std::vector<double> q = model.joint_displacements({});
  std::size_t joint = 0;
  for (Limb& limb : made.assembly.limbs) {
    for (const chain::Joint& each : limb.chain.joints) {
      q[joint++] *= each.type == chain::JointType::prismatic ? kScale : 1.0;
    }
    for (Transform& frame : limb.chain.home) frame.p *= kScale;
    limb.chain.home[0] = Transform{base.R, kScale * base.p} * limb.chain.home[0];
  }
  for (Vector3& point : made.assembly.points) point *= kScale;
  made.assembly.reach *= kScale;
  made.joint_displacements = [q](std::span<const double>) { return q; };
  return made;
}

/// Effects of length errors stay the same; effects of angle errors are lengths per angle and become 1000 times larger.
TEST(AssemblySeparation, DependsOnNoUnitAndNoBaseFrame) {
  std::mt19937_64 engine(43);
  for (const std::vector<std::size_t>& joints : limbs_of_random_assemblies()) {
    const AssemblyModel model = random_assembly(joints, chain::PassiveJoints::mixed, engine);
    const Separation wanted = separation(model, {});
    const Separation found = separation(in_other_words(model, lie::exp(lie::random_screw(2.0, engine))), {});
    for (const auto part : {&Separation::drive, &Separation::constraint, &Separation::effect, &Separation::residual}) {
      for (std::size_t f = 0; f < model.terms.size(); ++f) {
        if (model.terms[f].front().frame == 0) continue;  // these errors are along the base's axes
        const double scale = model.terms[f].front().component < 3 ? kScale : 1.0;
        const double expected = scale * (wanted.*part)[f];
        EXPECT_NEAR((found.*part)[f], expected, 1e-9 * (scale * wanted.effect[f] + expected)) << f;
      }
    }
  }
}

}  // namespace
}  // namespace poesy::assembly
