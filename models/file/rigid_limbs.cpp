#include "models/file/rigid_limbs.h"

#include <algorithm>
#include <string>
#include <vector>

#include "engine/linalg/decompositions.h"
#include "models/assembly/equilibrium.h"

namespace poesy::file {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;

/// A limb counts as strained by wrenches of norm 1 only if the strain is more than this share of the limb's largest
/// compliance.
constexpr double kRigid = 1e-12;
/// Two limbs load each other if |A B^T| exceeds this, where A and B are the rows of the two limbs in an orthonormal
/// basis of the wrenches.
constexpr double kNothing = 1e-6;

/// An orthonormal basis of a matrix's null space.
Matrix null_space(const Matrix& matrix, double threshold) {
  const linalg::SingularValueDecomposition svd = linalg::right_singular_vectors(matrix);
  const Index rank = (svd.values.array() > threshold * svd.values[0]).count();
  return svd.V.rightCols(matrix.cols() - rank);
}

/// A basis of the sets of limb wrenches that balance at every body and strain no limb. Such sets are null vectors of
/// the equations of the assembly, but not motions. Each column has a row for each lambda of the equations
/// (Equilibrium).
Matrix unstrained(const assembly::Equilibrium& equations, double rank_threshold) {
  const Matrix& matrix = equations.matrix();
  const Index wrenches = equations.first_wrenches().back();
  const Matrix balanced = null_space(matrix.bottomLeftCorner(matrix.rows() - wrenches, wrenches), rank_threshold);
  if (balanced.cols() == 0) return balanced;
  // Each limb is scaled by itself, because compliances may differ by many orders of magnitude.
  Matrix strain = matrix.topLeftCorner(wrenches, wrenches);
  for (std::size_t e = 0; e + 1 < equations.first_wrenches().size(); ++e) {
    const Index first = equations.first_wrenches()[e];
    const Index count = equations.first_wrenches()[e + 1] - first;
    const double largest = equations.compliance(e).cwiseAbs().maxCoeff();
    if (largest > 0.0) strain.middleRows(first, count) /= largest;
  }
  const linalg::SingularValueDecomposition svd = linalg::right_singular_vectors(strain * balanced);
  const Index strained = (svd.values.array() > kRigid).count();
  return balanced * svd.V.rightCols(balanced.cols() - strained);
}

/// The first limb that these wrenches load, and all limbs that these wrenches load together with it (kNothing).
std::vector<std::size_t> loaded_together(const Matrix& wrenches, const assembly::Equilibrium& equations) {
  const std::span<const Index> first = equations.first_wrenches();
  const auto rows = [&](std::size_t e) { return wrenches.middleRows(first[e], first[e + 1] - first[e]); };
  std::vector<std::size_t> limbs;
  for (std::size_t e = 0; e + 1 < first.size(); ++e) {
    const std::size_t with = limbs.empty() ? e : limbs.front();
    if ((rows(with) * rows(e).transpose()).norm() > kNothing) limbs.push_back(e);
  }
  return limbs;
}

/// Labels of limbs as text for messages: "limbs 1, 2 and left_3".
std::string labels_text(const Mechanism& mechanism, const std::vector<std::size_t>& limbs) {
  std::string text = limbs.size() == 1 ? "limb " : "limbs ";
  for (std::size_t k = 0; k < limbs.size(); ++k) {
    if (k > 0) text += k + 1 == limbs.size() ? " and " : ", ";
    text += mechanism.limbs[limbs[k]].label;
  }
  return text;
}

}  // namespace

void check_rigid_limbs(const Mechanism& mechanism, const assembly::AssemblyModel& model,
                       const assembly::Nominal& at_home) {
  assembly::Equilibrium equations(model.assembly, at_home);
  equations.set(at_home.limbs, model.ranks);
  const Matrix wrenches = unstrained(equations, mechanism.precision.rank_threshold);
  if (wrenches.cols() == 0) return;
  const std::vector<std::size_t> limbs = loaded_together(wrenches, equations);
  const bool gives_way =
      std::ranges::any_of(limbs, [&](std::size_t e) { return model.assembly.limbs[e].is_elastic(); });
  throw InputError(mechanism.limbs[limbs.front()].joints.front().place,
                   labels_text(mechanism, limbs) +
                       (gives_way ? " are rigid in some directions, in which they over-constrain each other"
                                  : " are rigid and over-constrain each other"),
                   "give links or joints stiffness, because rigid parts do not tell how large their forces are");
}

}  // namespace poesy::file
