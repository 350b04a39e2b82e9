#include "models/assembly/loops.h"

#include "engine/linalg/decompositions.h"
#include "tests/models/assembly/made.h"

// Compares the derivatives of N = B^T W B by errors and mismatches with finite differences.
namespace poesy::assembly {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// An assembly whose bodies and joints were moved from the nominal pose by x: displacements of the passive joints, then
/// twists of the bodies.
struct Moved {
  std::vector<Transform> bodies;
  std::vector<double> displacements;
  std::vector<LimbState> limbs;
};

Moved moved(const Assembly& assembly, const Nominal& pose, const std::vector<std::vector<Transform>>& frames,
            const Vector& x) {
  Moved made{pose.bodies, pose.displacements, {}};
  Index k = 0;
  std::size_t joint = 0;
  for (const Limb& limb : assembly.limbs) {
    for (const chain::Joint& one : limb.chain.joints) {
      if (!one.actuated) made.displacements[joint] += x[k++];
      ++joint;
    }
  }
  for (std::size_t b = kPlatform; b < made.bodies.size(); ++b, k += 6) {
    made.bodies[b] = lie::exp(Screw(x.segment<6>(k))) * made.bodies[b];
  }
  made.limbs = limb_states(assembly, made.bodies, frames, made.displacements);
  return made;
}

std::vector<Screw> mismatch(const Assembly& assembly, const Moved& at) {
  std::vector<Screw> all;
  for (std::size_t e = 0; e < at.limbs.size(); ++e) {
    all.push_back(lie::log(at.limbs[e].end * at.bodies[assembly.limbs[e].to].inverse()));
  }
  return all;
}

TEST(Loops, DeterminantChangesByItsSlopes) {
  for (const Case& one : cases()) {
    const AssemblyModel model = made(one.text(), Metric::platform);
    const Nominal pose = model.at(one.pose);
    const Loops loops(model.assembly, pose, model.idle);
    ASSERT_TRUE(loops.is_regular()) << one.name;
    const std::vector<std::vector<Screw>> slopes = loops.determinant_slopes();
    const Matrix6 root = linalg::cholesky_root(pose.W);
    const Matrix columns = motion_columns(model.assembly, pose.limbs, root) * loops.motions();
    const Matrix twists = error_twists(model, pose);
    ErrorFrames frames(model);
    for (std::size_t f = 0; f < model.terms.size(); ++f) {
      const chain::ErrorTerm& term = model.terms[f].front();
      const Screw twist = twists.block<6, 1>(6 * static_cast<Index>(term.limb), static_cast<Index>(f));
      Vector open = Vector::Zero(columns.rows());
      open.segment<6>(6 * static_cast<Index>(term.limb)) = root * twist;
      const Vector gives = loops.motions() * (columns.transpose() * open);
      const auto log_of_determinant = [&](double error) {
        std::vector<double> errors(model.terms.size(), 0.0);
        errors[f] = error;
        const Moved at = moved(model.assembly, pose, frames.with(errors, pose.displacements), error * gives);
        const Matrix B = motion_columns(model.assembly, at.limbs, root) * loops.motions();
        return std::log((B.transpose() * B).determinant());
      };
      constexpr double kStep = 1e-5;
      const double expected = (log_of_determinant(kStep) - log_of_determinant(-kStep)) / (2.0 * kStep);
      EXPECT_NEAR(slopes[term.limb][term.frame].dot(twist), expected, 1e-6 * (1.0 + std::abs(expected)))
          << one.name << ", error " << f;
    }
  }
}

TEST(Loops, MismatchBendsThem) {
  for (const Case& one : cases()) {
    const AssemblyModel model = made(one.text(), Metric::platform);
    const Nominal pose = model.at(one.pose);
    const Matrix6 root = linalg::cholesky_root(pose.W);
    ErrorFrames error_frames(model);
    const auto frames = error_frames.with(random_errors(model, 0.1, 5), pose.displacements);
    const Index size = motion_columns(model.assembly, pose.limbs, root).cols();
    const auto gradient = [&](const Vector& x) {
      const Moved at = moved(model.assembly, pose, frames, x);
      const std::vector<Screw> open = mismatch(model.assembly, at);
      Vector weighed(6 * static_cast<Index>(open.size()));
      for (std::size_t e = 0; e < open.size(); ++e) weighed.segment<6>(6 * static_cast<Index>(e)) = root * open[e];
      return Vector(-motion_columns(model.assembly, at.limbs, root).transpose() * weighed);
    };
    Matrix derivative(size, size);
    constexpr double kStep = 1e-5;
    for (Index k = 0; k < size; ++k) {
      derivative.col(k) = (gradient(kStep * Vector::Unit(size, k)) - gradient(-kStep * Vector::Unit(size, k))) / 2e-5;
    }
    const Moved at = moved(model.assembly, pose, frames, Vector::Zero(size));
    const Matrix B = motion_columns(model.assembly, at.limbs, root);
    const Matrix C = bend(model.assembly, at.limbs, mismatch(model.assembly, at), pose.W);
    const Matrix expected = 0.5 * (derivative + derivative.transpose()) - B.transpose() * B;
    EXPECT_LT((C - expected).norm(), 1e-6 * expected.norm()) << one.name;
  }
}

}  // namespace
}  // namespace poesy::assembly
