#include "engine/linalg/decompositions.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace poesy::linalg {
namespace {

using Jacobi = Eigen::JacobiSVD<Matrix>;

/// The columns of Q [size x size] from `first` on.
Matrix last_columns(const auto& Q, Eigen::Index size, Eigen::Index first) {
  Matrix base = Matrix::Zero(size, size - first);
  base.bottomRows(size - first).setIdentity();
  base.applyOnTheLeft(Q);
  return base;
}

}  // namespace

Vector singular_values(const ConstMatrix& A) { return Jacobi(A).singularValues(); }

SingularValueDecomposition right_singular_vectors(const ConstMatrix& A) {
  const Jacobi svd(A, Eigen::ComputeFullV);
  return {{}, svd.singularValues(), svd.matrixV()};
}

SingularValueDecomposition singular_value_decomposition(const ConstMatrix& A) {
  const Jacobi svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

double determinant(const ConstMatrix& A) { return A.size() == 0 ? 1.0 : A.partialPivLu().determinant(); }

std::size_t rank(const ConstMatrix& A, double threshold) {
  if (A.cols() == 0) return 0;
  Jacobi svd(A);
  svd.setThreshold(threshold);
  return static_cast<std::size_t>(svd.rank());
}

Vector least_squares(const ConstMatrix& A, const ConstVector& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Matrix> factors;
  factors.setThreshold(threshold);
  return factors.compute(A).solve(b);
}

Matrix least_squares(const ConstMatrix& A, const ConstMatrix& B) { return Eigen::HouseholderQR<Matrix>(A).solve(B); }

Matrix pseudo_inverse(const ConstMatrix& A) { return A.completeOrthogonalDecomposition().pseudoInverse(); }

Matrix orthogonal_complement(const ConstMatrix& A, double threshold) {
  if (A.cols() == 0) return Matrix::Identity(A.rows(), A.rows());
  Eigen::ColPivHouseholderQR<Matrix> qr(A);
  qr.setThreshold(threshold);
  return last_columns(qr.householderQ(), A.rows(), qr.rank());
}

Matrix orthogonal_complement(const ConstMatrix& A) {
  return last_columns(Eigen::HouseholderQR<Matrix>(A).householderQ(), A.rows(), A.cols());
}

RangeAndComplement range_and_complement(const ConstMatrix& A, std::size_t rank) {
  if (A.cols() == 0) return {Matrix(A.rows(), 0), Matrix::Identity(A.rows(), A.rows())};
  const Matrix Q = Eigen::ColPivHouseholderQR<Matrix>(A).householderQ();
  const auto first = static_cast<Eigen::Index>(rank);
  return {Q.leftCols(first), Q.rightCols(A.rows() - first)};
}

Matrix upper_triangle(const ConstMatrix& A) {
  const Eigen::HouseholderQR<Matrix> qr(A);
  const Eigen::Index rows = std::min(A.rows(), A.cols());
  Matrix R = Matrix::Zero(A.cols(), A.cols());
  R.topRows(rows) = qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
  return R;
}

Matrix cholesky_root(const ConstMatrix& W) { return W.llt().matrixU(); }

std::optional<Vector> solve_positive_definite(const ConstMatrix& A, const ConstVector& b) {
  const Eigen::LLT<Matrix> factors(A);
  if (factors.info() != Eigen::Success) return std::nullopt;
  return factors.solve(b);
}

EigenDecomposition eigen_decomposition(const ConstMatrix& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Vector eigenvalues(const ConstMatrix& A) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

LuFactors6::LuFactors6(const Matrix6& A) {
  const Eigen::PartialPivLU<Matrix6> lu(A);
  factors_ = lu.matrixLU();
  places_ = lu.permutationP().indices();
  sign_ = static_cast<int>(lu.permutationP().determinant());
}

LuFactors6::Vector6 LuFactors6::solve(const Vector6& b) const {
  Vector6 x = Eigen::PermutationMatrix<6>(places_) * b;
  factors_.triangularView<Eigen::UnitLower>().solveInPlace(x);
  factors_.triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

LuFactors6::Matrix6 LuFactors6::inverse() const {
  Matrix6 inverse;
  for (Eigen::Index column = 0; column < 6; ++column) inverse.col(column) = solve(Matrix6::Identity().col(column));
  return inverse;
}

double LuFactors6::determinant() const { return static_cast<double>(sign_) * factors_.diagonal().prod(); }

Matrix solve(const ConstMatrix& A, const ConstMatrix& B) { return Eigen::PartialPivLU<Matrix>(A).solve(B); }

Matrix inverse(const ConstMatrix& A) { return solve(A, Matrix::Identity(A.rows(), A.cols())); }

}  // namespace poesy::linalg
