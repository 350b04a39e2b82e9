#include "engine/linalg/decompositions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace poesy::linalg {
namespace {

constexpr double kTolerance = 1e-13;
constexpr double kThreshold = 1e-9;

/// A matrix of full rank with irregular entries between -1 and 1.
Matrix irregular(Eigen::Index rows, Eigen::Index cols) {
  Matrix A(rows, cols);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < cols; ++j) A(i, j) = std::sin(static_cast<double>(3 * i * i + 7 * j + 5 * i * j + 1));
  }
  return A;
}

Matrix of_rank(Eigen::Index rows, Eigen::Index cols, Eigen::Index rank) {
  return irregular(rows, rank) * irregular(rank, cols);
}

void expect_near(const Matrix& a, const Matrix& b) {
  ASSERT_EQ(a.rows(), b.rows());
  ASSERT_EQ(a.cols(), b.cols());
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), kTolerance) << a << "\n\n" << b;
}

void expect_orthonormal(const Matrix& Q) { expect_near(Q.transpose() * Q, Matrix::Identity(Q.cols(), Q.cols())); }

TEST(SingularValues, MakeTheMatrixAgain) {
  for (const auto& [rows, cols] : {std::pair{7, 4}, {4, 7}, {5, 5}}) {
    const Matrix A = irregular(rows, cols);
    const auto [U, values, V] = singular_value_decomposition(A);
    expect_orthonormal(U);
    expect_orthonormal(V);
    Matrix S = Matrix::Zero(rows, cols);
    S.diagonal() = values;
    expect_near(U * S * V.transpose(), A);
    EXPECT_TRUE(std::ranges::is_sorted(values, std::greater()));
    expect_near(singular_values(A), values);
    const SingularValueDecomposition right = right_singular_vectors(A);
    expect_near(right.values, values);
    expect_near((A * right.V).colwise().norm().head(values.size()).transpose(), values);
  }
}

TEST(SingularValues, LastRightVectorsAreMappedToZero) {
  const Matrix V = right_singular_vectors(irregular(4, 7)).V;
  expect_near(irregular(4, 7) * V.rightCols(3), Matrix::Zero(4, 3));
}

TEST(Rank, CountsWhatIsAboveTheThreshold) {
  EXPECT_EQ(rank(of_rank(8, 6, 4), kThreshold), 4U);
  EXPECT_EQ(rank(Matrix(6, 0), kThreshold), 0U);
  const Matrix nearly = Vector{{1.0, 1e-8, 1e-10}}.asDiagonal();
  EXPECT_EQ(rank(nearly, kThreshold), 2U);
}

TEST(LeastSquares, IsTheShortestSolution) {
  const Matrix A = of_rank(8, 6, 4);
  const Vector b = irregular(8, 1);
  const Vector x = least_squares(A, b, kThreshold);
  expect_near(A.transpose() * (A * x - b), Vector::Zero(6));
  expect_near(pseudo_inverse(A) * b, x);
  // The shortest solution has no component in the null space of A.
  expect_near(right_singular_vectors(A).V.rightCols(2).transpose() * x, Vector::Zero(2));
}

TEST(LeastSquares, OfIndependentColumnsTakesSeveralRightSides) {
  const Matrix A = irregular(9, 3);
  const Matrix B = irregular(9, 4);
  expect_near(A.transpose() * (A * least_squares(A, B) - B), Matrix::Zero(3, 4));
}

TEST(PseudoInverse, KeepsMooreAndPenrosesConditions) {
  const Matrix A = of_rank(5, 7, 3);
  const Matrix X = pseudo_inverse(A);
  expect_near(A * X * A, A);
  expect_near(X * A * X, X);
  expect_near((A * X).transpose(), A * X);
  expect_near((X * A).transpose(), X * A);
}

TEST(OrthogonalComplement, IsAtRightAnglesAndWhole) {
  const Matrix A = of_rank(6, 5, 3);
  const Matrix rest = orthogonal_complement(A, kThreshold);
  EXPECT_EQ(rest.cols(), 3);
  expect_orthonormal(rest);
  expect_near(rest.transpose() * A, Matrix::Zero(3, 5));
  expect_near(orthogonal_complement(Matrix(6, 0), kThreshold), Matrix::Identity(6, 6));
  const Matrix independent = irregular(9, 4);
  const Matrix base = orthogonal_complement(independent);
  EXPECT_EQ(base.cols(), 5);
  expect_orthonormal(base);
  expect_near(base.transpose() * independent, Matrix::Zero(5, 4));
}

TEST(UpperTriangle, KeepsLengths) {
  for (const auto& [rows, cols] : {std::pair{9, 4}, {3, 5}}) {
    const Matrix A = irregular(rows, cols);
    const Matrix R = upper_triangle(A);
    EXPECT_TRUE(R.isUpperTriangular(0.0));
    expect_near(R.transpose() * R, A.transpose() * A);
  }
}

TEST(Cholesky, RootAndSolution) {
  const Matrix W = irregular(8, 6).transpose() * irregular(8, 6);
  const Matrix U = cholesky_root(W);
  EXPECT_TRUE(U.isUpperTriangular(0.0));
  expect_near(U.transpose() * U, W);
  const Vector b = irregular(6, 1);
  const std::optional<Vector> x = solve_positive_definite(W, b);
  ASSERT_TRUE(x);
  expect_near(W * *x, b);
  EXPECT_FALSE(solve_positive_definite(W - 100.0 * Matrix::Identity(6, 6), b));
}

TEST(Eigenvalues, OfASymmetricMatrix) {
  const Matrix A = irregular(5, 5) + irregular(5, 5).transpose();
  const auto [values, vectors] = eigen_decomposition(A);
  expect_orthonormal(vectors);
  expect_near(A * vectors, vectors * values.asDiagonal());
  EXPECT_TRUE(std::ranges::is_sorted(values));
  expect_near(eigenvalues(A), values);
}

TEST(LuFactors6, SolveInvertAndHaveTheDeterminant) {
  const LuFactors6::Matrix6 A = irregular(6, 6);
  const LuFactors6 factors(A);
  const LuFactors6::Vector6 b = irregular(6, 1);
  expect_near(A * factors.solve(b), b);
  expect_near(A * factors.inverse(), Matrix::Identity(6, 6));
  EXPECT_NEAR(std::abs(factors.determinant()), singular_values(A).prod(), kTolerance);
  // Exchanging two rows changes only the sign of the determinant.
  LuFactors6::Matrix6 exchanged = A;
  exchanged.row(1).swap(exchanged.row(4));
  EXPECT_NEAR(LuFactors6(exchanged).determinant(), -factors.determinant(), kTolerance);
}

TEST(LuFactors6, SayWhereEachRowIs) {
  // Each row of A has a single non-zero entry, so U = P A is diagonal.
  const LuFactors6::Places rows{2, 0, 1, 5, 3, 4};
  LuFactors6::Matrix6 A = LuFactors6::Matrix6::Zero();
  for (Eigen::Index row = 0; row < 6; ++row) A(row, rows[row]) = 1.0 + static_cast<double>(row);
  const LuFactors6 factors(A);
  EXPECT_EQ(factors.row_places(), rows);
  for (Eigen::Index row = 0; row < 6; ++row) EXPECT_EQ(factors.pivots()[rows[row]], 1.0 + static_cast<double>(row));
}

TEST(Solve, SquareMatrices) {
  const Matrix A = irregular(6, 6);
  const Matrix B = irregular(6, 3);
  expect_near(A * solve(A, B), B);
  expect_near(A * inverse(A), Matrix::Identity(6, 6));
}

}  // namespace
}  // namespace poesy::linalg
