#include "engine/calibration/next_poses.h"

#include <numbers>

namespace poesy::calibration {
namespace {

using linalg::Matrix;

constexpr double kTie = 1e-9;  // two gains count as equal if their relative difference is below this

double log_determinant(const Matrix& positive) {
  if (positive.rows() == 0) return 0.0;
  return 2.0 * linalg::cholesky_root(positive).diagonal().array().log().sum();
}

/// The logarithm of the determinant of the information about the first `fitted` numbers, after all other numbers were
/// fitted (Schur complement).
double log_information(const Matrix& information, Eigen::Index fitted) {
  const Eigen::Index others = information.rows() - fitted;
  return log_determinant(information) - log_determinant(information.bottomRightCorner(others, others));
}

}  // namespace

std::vector<NextPose> next_poses(Matrix information, const std::vector<Matrix>& rows, std::size_t fitted,
                                 std::size_t count) {
  std::vector<NextPose> list;
  const auto k = static_cast<Eigen::Index>(fitted);
  while (list.size() < count && !rows.empty()) {
    const double before = log_information(information, k);
    NextPose best{0, -1.0};
    for (std::size_t c = 0; c < rows.size(); ++c) {
      const double after = log_information(information + rows[c].transpose() * rows[c], k);
      const double gain = 0.5 * (after - before) / std::numbers::ln2;
      if (gain > best.gain * (1.0 + kTie)) best = {c, gain};
    }
    information += rows[best.candidate].transpose() * rows[best.candidate];
    list.push_back(best);
  }
  return list;
}

}  // namespace poesy::calibration
