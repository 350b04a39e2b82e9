#include "models/chain/normal_equations.h"

#include <cmath>
#include <limits>

#include "engine/linalg/decompositions.h"

namespace poesy::chain {

NormalEquations::NormalEquations(const ParallelChain& chain)
    : pairs_(chain.pairs),
      limbs_(chain.limbs.size()),
      size_(chain.passive_joints()),
      idle_freedoms_(chain.idle),
      reach_(chain.reach()) {
  coupling_.assign(limbs_ * limbs_, 0.0);
  for (const LimbPair& pair : pairs_) {
    coupling_[pair.i * limbs_ + pair.i] += 1.0;
    coupling_[pair.k * limbs_ + pair.k] += 1.0;
    coupling_[pair.i * limbs_ + pair.k] -= 1.0;
    coupling_[pair.k * limbs_ + pair.i] -= 1.0;
  }
  for (std::size_t limb = 0; limb < limbs_; ++limb) {
    limb_of_.insert(limb_of_.end(), chain.limbs[limb].passive_joints(), limb);
  }
  matrix_.assign(size_ * size_, 0.0);
  pull_.resize(limbs_);
  solution_.assign(size_, 0.0);
}

bool NormalEquations::solve(std::span<const lie::Screw<double>> columns, std::span<const double> delta_mu,
                            const lie::Matrix6<double>* W, double damping) {
  weigh(columns, W);
  assemble_matrix(columns);
  for (std::size_t row = 0; row < size_; ++row) matrix_[row * size_ + row] *= 1.0 + damping;
  assemble_right_side(delta_mu);
  if (!factor()) return false;
  substitute();
  return true;
}

Eigen::MatrixXd NormalEquations::matrix(std::span<const lie::Screw<double>> columns, const lie::Matrix6<double>* W) {
  weigh(columns, W);
  assemble_matrix(columns);
  const auto size = static_cast<Eigen::Index>(size_);
  Eigen::MatrixXd all(size, size);
  for (Eigen::Index row = 0; row < size; ++row) {
    for (Eigen::Index column = 0; column <= row; ++column) {
      all(row, column) = all(column, row) = matrix_[static_cast<std::size_t>(row * size + column)];
    }
  }
  return all;
}

void NormalEquations::solve_again(std::span<const double> delta_mu) {
  assemble_right_side(delta_mu);
  substitute();
}

void NormalEquations::solve_for(std::span<const double> right_side) {
  solution_.assign(right_side.begin(), right_side.end());
  substitute();
}

void NormalEquations::weigh(std::span<const lie::Screw<double>> columns, const lie::Matrix6<double>* W) {
  weighted_.assign(columns.begin(), columns.end());
  if (W == nullptr) return;
  for (auto& column : weighted_) column = *W * column;
}

void NormalEquations::assemble_matrix(std::span<const lie::Screw<double>> columns) {
  for (std::size_t row = 0; row < size_; ++row) {
    const double* coupling = coupling_.data() + limb_of_[row] * limbs_;
    for (std::size_t column = 0; column <= row; ++column) {
      matrix_[row * size_ + column] = coupling[limb_of_[column]] * weighted_[row].dot(columns[column]);
      for (std::size_t n = 0; n < idle_.size(); n += size_) {
        matrix_[row * size_ + column] += idle_[n + row] * idle_[n + column];
      }
    }
  }
}

void NormalEquations::hold_idle(std::span<const lie::Screw<double>> columns, const lie::Matrix6<double>* W) {
  idle_.clear();
  if (idle_freedoms_ == 0) return;
  // The Jacobian of the motions of each limb's end relative to that of the first limb, with lengths in units of the
  // reach.
  const auto size = static_cast<Eigen::Index>(size_);
  Eigen::MatrixXd loops = Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(limbs_ - 1), size);
  for (Eigen::Index column = 0; column < size; ++column) {
    const auto at = static_cast<std::size_t>(column);
    lie::Screw<double> screw = columns[at];
    if (!screw.head<3>().isZero(0.0)) screw.tail<3>() /= reach_;
    for (std::size_t limb = 1; limb < limbs_; ++limb) {
      const auto row = 6 * static_cast<Eigen::Index>(limb - 1);
      if (limb_of_[at] == limb) loops.block<6, 1>(row, column) = screw;
      if (limb_of_[at] == 0) loops.block<6, 1>(row, column) = -screw;
    }
  }
  weigh(columns, W);
  double diagonal = 0.0;
  for (std::size_t a = 0; a < size_; ++a) diagonal += weighted_[a].dot(columns[a]) / static_cast<double>(size_);
  const Eigen::MatrixXd V = linalg::right_singular_vectors(loops).V;
  for (Eigen::Index n = size - static_cast<Eigen::Index>(idle_freedoms_); n < size; ++n) {
    for (Eigen::Index a = 0; a < size; ++a) idle_.push_back(std::sqrt(diagonal) * V(a, n));
  }
}

void NormalEquations::assemble_right_side(std::span<const double> delta_mu) {
  for (auto& pull : pull_) pull.setZero();
  for (std::size_t n = 0; n < pairs_.size(); ++n) {
    const Eigen::Map<const lie::Screw<double>> residual(delta_mu.data() + 6 * n);
    pull_[pairs_[n].i] += residual;
    pull_[pairs_[n].k] -= residual;
  }
  for (std::size_t row = 0; row < size_; ++row) solution_[row] = weighted_[row].dot(pull_[limb_of_[row]]);
}

// Factorises the matrix as L D L^T without pivoting, row by row. The matrix is positive semidefinite by construction.
bool NormalEquations::factor() {
  const double smallest_ratio = 4.0 * static_cast<double>(size_) * std::numeric_limits<double>::epsilon();
  for (std::size_t row = 0; row < size_; ++row) {
    double* a = matrix_.data() + row * size_;
    for (std::size_t column = 0; column < row; ++column) {
      const double* b = matrix_.data() + column * size_;
      double sum = a[column];
      for (std::size_t k = 0; k < column; ++k) sum -= a[k] * b[k];
      a[column] = sum;  // entry of L D; the loop over k below divides it by D
    }
    const double diagonal = a[row];
    double pivot = diagonal;
    for (std::size_t k = 0; k < row; ++k) {
      const double scaled = a[k] * matrix_[k * size_ + k];
      pivot -= a[k] * scaled;
      a[k] = scaled;
    }
    if (!(pivot > smallest_ratio * diagonal)) return false;
    a[row] = 1.0 / pivot;
  }
  return true;
}

void NormalEquations::substitute() {
  for (std::size_t row = 0; row < size_; ++row) {
    for (std::size_t k = 0; k < row; ++k) solution_[row] -= matrix_[row * size_ + k] * solution_[k];
  }
  for (std::size_t row = size_; row-- > 0;) {
    solution_[row] *= matrix_[row * size_ + row];
    for (std::size_t k = row + 1; k < size_; ++k) solution_[row] -= matrix_[k * size_ + row] * solution_[k];
  }
}

}  // namespace poesy::chain
