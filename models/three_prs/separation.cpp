#include "models/three_prs/separation.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <numbers>

#include "models/three_prs/error_mapping.h"

namespace poesy::three_prs {
namespace {

using Matrix6 = lie::Matrix6<double>;
/// Displacements of the three spherical joints over sqrt(3): the norm of a column is the measure of its twist.
template <int Columns>
using Displacements = Eigen::Matrix<double, 3 * static_cast<int>(kLimbs), Columns>;

/// From [theta; dr] to the displacements of the spherical joints, over sqrt(3).
Displacements<6> joint_displacements(const Configuration& nominal) {
  Displacements<6> map;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    map.middleRows<3>(3 * static_cast<Eigen::Index>(i)) << -lie::hat<double>(nominal.limbs[i].c),
        lie::Matrix3<double>::Identity();
  }
  return map * std::numbers::inv_sqrt3;
}

std::vector<double> column_norms(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  std::vector<double> norms;
  for (Eigen::Index f = 0; f < matrix.cols(); ++f) norms.push_back(matrix.col(f).norm());
  return norms;
}

}  // namespace

Separation separation(const Geometry& geometry, const Configuration& nominal) {
  constexpr int kAll = static_cast<int>(kFactors);
  const ErrorMapping G = error_mapping(geometry, nominal);
  const Displacements<6> by_rows = joint_displacements(nominal) * velocity_jacobian(nominal).inverse();
  const Displacements<3> by_drive = by_rows.leftCols<3>();
  const Displacements<kAll> drive = by_drive * G.topRows<3>();
  const Displacements<kAll> constraint = by_rows.rightCols<3>() * G.bottomRows<3>();
  const Displacements<kAll> effect = drive + constraint;
  // Least squares: with by_drive = Q R, corrections reach the first three rows of Q^T effect and no other. The drive
  // part is in the span of by_drive, so the other rows are those of the constraint part.
  const Displacements<kAll> turned = by_drive.householderQr().householderQ().adjoint() * constraint;
  return {column_norms(drive), column_norms(constraint), column_norms(effect), column_norms(turned.bottomRows<6>())};
}

SeparationDescription separation_description() {
  return {"root mean square displacement of the platform's three spherical joints", published_classes()};
}

}  // namespace poesy::three_prs
