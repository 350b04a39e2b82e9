#include <gtest/gtest.h>

#include <numeric>

#include "tests/models/assembly/made.h"

// Tests that the effects of errors do not depend on the unit of length, the base frame and the order of the limbs.
namespace poesy::assembly {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Calls check(case, metric, fidelity) for all combinations.
template <class Check>
void for_each_way(Check check) {
  for (const Case& one : cases()) {
    for (const Metric metric : kMetrics) {
      for (const chain::Fidelity fidelity : {kExact, kFirstOrder}) {
        SCOPED_TRACE(std::string(one.name) + (metric == Metric::stiffness ? ", stiffness" : ", platform") +
                     (fidelity == kExact ? ", exact" : ", first order"));
        check(one, metric, fidelity);
      }
    }
  }
}

// ---- unit of length

/// The mechanism file with m instead of mm, and with stiffness per length divided by 1000, so that all forces stay the
/// same.
std::string in_metres(const std::string& text) {
  return replaced(replaced(replaced(replaced(text, " mm", " m"), "N/um", "N/mm"), " N m/rad", " kN m/rad"), "GPa",
                  "kPa");
}

/// The factor by which a quantity of this dimension then grows.
double factor_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
    case Dimension::moment:
    case Dimension::energy:
      return 1000.0;
    default:
      return 1.0;
  }
}

TEST(AssemblyProperties, TheUnitOfLengthChangesNothing) {
  for_each_way([](const Case& one, Metric metric, chain::Fidelity fidelity) {
    const AssemblyModel small = made(one.text(), metric);
    const AssemblyModel large = made(in_metres(one.text()), metric);
    std::vector<double> errors = random_errors(small, 0.1, 1);
    std::vector<double> pose = one.pose;
    Answers wanted = answers(small, pose, errors, fidelity);
    for (std::size_t f = 0; f < errors.size(); ++f) errors[f] *= small.terms[f].front().component < 3 ? 1.0 : 1000.0;
    const file::MechanismFile read = file::read_mechanism_file(one.text(), "m.toml");
    for (std::size_t c = 0; c < pose.size(); ++c) {
      pose[c] *= read.platform.coordinates[c].component.size() == 1 ? 1000.0 : 1.0;
    }
    wanted.reach *= 1000.0;
    for (std::size_t r = 0; r < wanted.values.size(); ++r) {
      wanted.values[r] *= factor_of(wanted.responses[r].dimension);
    }
    EXPECT_EQ(expect_same(answers(large, pose, errors, fidelity), wanted, 1e-11), wanted.values.size());
  });
}

// ---- base frame

/// The same assembly described in another base frame: everything is moved by `motion`.
AssemblyModel moved(AssemblyModel model, const Transform& motion) {
  for (Limb& limb : model.assembly.limbs) {
    if (limb.from == kBase) limb.chain.home.front() = motion * limb.chain.home.front();
  }
  for (std::size_t b = kPlatform; b < model.assembly.bodies.size(); ++b) {
    model.assembly.bodies[b].home = motion * model.assembly.bodies[b].home;
  }
  Load& load = model.assembly.load;
  for (Vector3* vector : {&load.gravity, &load.force, &load.moment}) *vector = motion.R * *vector;
  return model;
}

/// Rotates the components of displacements back by R^T.
void turn_back(const lie::Matrix3<double>& R, Answers& found) {
  for (const Response& norm : found.responses) {
    if (norm.components.size() != 3) continue;
    Vector3 vector;
    for (Eigen::Index k = 0; k < 3; ++k) vector[k] = found.values[norm.components[static_cast<std::size_t>(k)]];
    vector = R.transpose() * vector;
    for (Eigen::Index k = 0; k < 3; ++k) found.values[norm.components[static_cast<std::size_t>(k)]] = vector[k];
  }
}

TEST(AssemblyProperties, TheBaseFrameChangesNothing) {
  const Transform motion{lie::exp<double>(Vector3(0.4, -0.7, 1.1)), {0.3, -0.2, 0.5}};
  for_each_way([&](const Case& one, Metric metric, chain::Fidelity fidelity) {
    const AssemblyModel model = made(one.text(), metric);
    std::vector<double> errors = random_errors(model, 0.1, 2);
    for (std::size_t f = 0; f < errors.size(); ++f) {  // these errors are along the base's axes, which differ
      const chain::ErrorTerm& term = model.terms[f].front();
      if (term.frame == 0 && model.assembly.limbs[term.limb].from == kBase) errors[f] = 0.0;
    }
    const Answers wanted = answers(model, one.pose, errors, fidelity);
    Answers found = answers(moved(model, motion), one.pose, errors, fidelity);
    turn_back(motion.R, found);
    EXPECT_EQ(expect_same(found, wanted, 1e-11), wanted.values.size());
  });
}

// ---- order of limbs

/// The same assembly with its limbs in this order.
AssemblyModel in_order(const AssemblyModel& model, const std::vector<std::size_t>& order) {
  AssemblyModel made = model;
  std::vector<std::size_t> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    place[order[k]] = k;
    made.assembly.limbs[k] = model.assembly.limbs[order[k]];
    made.ranks[k] = model.ranks[order[k]];
  }
  for (chain::ErrorTerms& terms : made.terms) terms.front().limb = place[terms.front().limb];
  for (ReportedJoint& joint : made.report.drives) joint.limb = place[joint.limb];
  for (ReportedJoint& joint : made.report.reactions) joint.limb = place[joint.limb];
  made.joint_displacements = [&model, order](std::span<const double> pose) {
    const std::vector<double> all = model.joint_displacements(pose);
    std::vector<double> reordered;
    for (const std::size_t e : order) {
      const auto first = all.begin() + static_cast<std::ptrdiff_t>(model.assembly.first_joint(e));
      reordered.insert(reordered.end(), first,
                       first + static_cast<std::ptrdiff_t>(model.assembly.limbs[e].chain.joints.size()));
    }
    return reordered;
  };
  return made;
}

TEST(AssemblyProperties, TheOrderOfLimbsChangesNothing) {
  for_each_way([](const Case& one, Metric metric, chain::Fidelity fidelity) {
    const AssemblyModel model = made(one.text(), metric);
    const std::vector<double> errors = random_errors(model, 0.1, 3);
    const Answers wanted = answers(model, one.pose, errors, fidelity);
    std::vector<std::size_t> order(model.assembly.limbs.size());
    std::iota(order.rbegin(), order.rend(), std::size_t{0});
    EXPECT_EQ(expect_same(answers(in_order(model, order), one.pose, errors, fidelity), wanted, 1e-11),
              wanted.values.size());
    std::ranges::shuffle(order, std::mt19937(4));
    expect_same(answers(in_order(model, order), one.pose, errors, fidelity), wanted, 1e-11);
  });
}

}  // namespace
}  // namespace poesy::assembly
