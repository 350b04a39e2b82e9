#include "models/three_prs/error_mapping.h"

#include <cmath>
#include <numbers>

#include "engine/linalg/decompositions.h"

namespace poesy::three_prs {
namespace {

using RowVector3 = Eigen::RowVector3d;
using Matrix = linalg::Matrix;

/// One row of a mapping, restricted to the columns of one limb's error sources.
class LimbRow {
 public:
  template <class Mapping>
  LimbRow(Mapping& mapping, std::size_t row, std::size_t limb)
      : first_(mapping.row(static_cast<Eigen::Index>(row)).data() + factor_of(limb, Source::a)) {}

  void set(Source source, const RowVector3& entries) {
    Eigen::Map<RowVector3>(first_ + static_cast<std::size_t>(source)) = entries;
  }
  void set(Source source, double entry) { first_[static_cast<std::size_t>(source)] = entry; }

 private:
  double* first_;
};

void set_drive_row(LimbRow row, const LimbConfiguration& limb, const RowVector3& w_in_platform_limb) {
  const double tangent = std::tan(limb.swing);
  const double secant = 1.0 / std::cos(limb.swing);
  row.set(Source::a, {tangent, 0.0, 1.0});
  row.set(Source::q, 1.0);
  row.set(Source::theta_A, {0.0, limb.q * tangent, 0.0});
  row.set(Source::b, {tangent, 0.0, 1.0});
  row.set(Source::l, secant);
  row.set(Source::c, -secant * w_in_platform_limb);
}

void set_constraint_row(LimbRow row, const LimbConfiguration& limb, double l, const RowVector3& v_in_platform_limb) {
  const double down = l * std::cos(limb.swing);
  const double outwards = l * std::sin(limb.swing);
  row.set(Source::a, {0.0, 1.0, 0.0});
  row.set(Source::theta_A, {-(limb.q + down), 0.0, outwards});
  row.set(Source::b, {0.0, 1.0, 0.0});
  row.set(Source::theta_B, {-down, 0.0, outwards});
  row.set(Source::theta_Bp, {-l, 0.0, 0.0});
  row.set(Source::c, -v_in_platform_limb);
}

/// Sets the effects of a limb's errors on the swing of its rod while the platform does not move. d_in_platform_limb:
/// unit direction in which the end of the rod swings, in the limb's frame on the platform.
void set_swing_row(LimbRow row, const LimbConfiguration& limb, double l, const RowVector3& d_in_platform_limb) {
  const double cosine = std::cos(limb.swing);
  const double sine = std::sin(limb.swing);
  row.set(Source::a, {-cosine / l, 0.0, sine / l});
  row.set(Source::q, sine / l);
  row.set(Source::theta_A, {0.0, -1.0 - limb.q * cosine / l, 0.0});
  row.set(Source::b, {-cosine / l, 0.0, sine / l});
  row.set(Source::theta_B, {0.0, -1.0, 0.0});
  row.set(Source::theta_Bp, {0.0, -1.0, 0.0});
  row.set(Source::c, d_in_platform_limb / l);
}

/// [9 x 6] The matrix from a twist [theta; dr] to the displacements of the three spherical joints divided by sqrt(3).
/// The length of the product with a twist is the norm of the twist in separation().
Matrix joint_displacements(const Configuration& nominal) {
  Matrix map(3 * kLimbs, 6);
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

ErrorMapping error_mapping(const Geometry& geometry, const Configuration& nominal) {
  ErrorMapping G = ErrorMapping::Zero();
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const LimbConfiguration& limb = nominal.limbs[i];
    const lie::Matrix3<double> base_R_platform_limb = nominal.platform.R * base_R_limb(i);
    set_drive_row({G, i, i}, limb, limb.w.transpose() * base_R_platform_limb);
    set_constraint_row({G, i + 3, i}, limb, geometry.l, limb.v.transpose() * base_R_platform_limb);
  }
  return G;
}

Effects first_order_effects(const Geometry& geometry, const Configuration& nominal) {
  Effects effects = Effects::Zero();
  const ErrorMapping motion = linalg::solve(velocity_jacobian(nominal), error_mapping(geometry, nominal));
  effects.topRows<6>() = motion;
  const lie::Matrix3<double> tool_hat = lie::hat<double>(tool(geometry, nominal.platform.R));
  effects.middleRows<3>(kTip) = motion.bottomRows<3>() - tool_hat * motion.topRows<3>();
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const LimbConfiguration& limb = nominal.limbs[i];
    const lie::Vector3<double> d = limb.v.cross(limb.w);
    set_swing_row({effects, kSwing + i, i}, limb, geometry.l, d.transpose() * nominal.platform.R * base_R_limb(i));
    const auto row = kSwing + static_cast<Eigen::Index>(i);
    effects.row(row) +=
        (limb.c.cross(d).transpose() * motion.topRows<3>() + d.transpose() * motion.bottomRows<3>()) / geometry.l;
  }
  return effects;
}

Separation separation(const Geometry& geometry, const Configuration& nominal) {
  const ErrorMapping G = error_mapping(geometry, nominal);
  const Matrix by_rows = joint_displacements(nominal) * linalg::inverse(velocity_jacobian(nominal));
  const Matrix by_drive = by_rows.leftCols<3>();
  const Matrix drive = by_drive * G.topRows<3>();
  const Matrix constraint = by_rows.rightCols<3>() * G.bottomRows<3>();
  const Matrix effect = drive + constraint;
  // This is the residual of a least-squares problem: corrections can reach the whole span of by_drive, which contains
  // the drive part, and nothing perpendicular to this span.
  const Matrix residual = linalg::orthogonal_complement(by_drive).transpose() * constraint;
  return {column_norms(drive), column_norms(constraint), column_norms(effect), column_norms(residual)};
}

Corrections corrections(const Geometry& geometry, const Configuration& nominal) {
  const Effects effects = first_order_effects(geometry, nominal);
  Corrections found;
  // The correction of a carriage has the same effect as an error of the carriage's initial position.
  for (std::size_t i = 0; i < kLimbs; ++i) {
    found.motions.col(static_cast<Eigen::Index>(i)) = effects.col(static_cast<Eigen::Index>(factor_of(i, Source::q)));
  }
  const Matrix displacements = joint_displacements(nominal);
  found.best = linalg::least_squares(displacements * found.motions.topRows<6>(), displacements);
  return found;
}

SeparationDescription separation_description() {
  return {"root mean square displacement of the platform's three spherical joints", published_classes()};
}

}  // namespace poesy::three_prs
