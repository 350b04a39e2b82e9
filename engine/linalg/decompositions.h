#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

/// Decompositions of small dense matrices as plain functions. Their templates take the compiler seconds each, so this
/// room alone instantiates them. Matrices of fixed size are taken without a copy where they are stored by columns.
namespace poesy::linalg {

using Matrix = Eigen::MatrixXd;                ///< of any size
using Vector = Eigen::VectorXd;                ///< of any size
using ConstMatrix = Eigen::Ref<const Matrix>;  ///< a matrix, or a part of one, that is only read
using ConstVector = Eigen::Ref<const Vector>;  ///< a vector, or a part of one, that is only read

/// A = U diag(values) V^T with U [rows x rows] and V [columns x columns] orthogonal. The last columns of V belong to
/// singular values of zero where A has more columns than rows.
struct SingularValueDecomposition {
  Matrix U;       ///< empty unless it was asked for
  Vector values;  ///< [min(rows, columns)] the largest first
  Matrix V;       ///< empty unless it was asked for
};

/// Of a matrix with at least one row and one column, by Jacobi rotations.
/// @{
Vector singular_values(const ConstMatrix& A);
SingularValueDecomposition right_singular_vectors(const ConstMatrix& A);  ///< Without U.
SingularValueDecomposition singular_value_decomposition(const ConstMatrix& A);
/// @}

/// The number of singular values above threshold times the largest; 0 for a matrix without columns.
std::size_t rank(const ConstMatrix& A, double threshold);

/// The x of the least norm among those with the least |A x - b|. Pivots below threshold times the largest count as 0.
Vector least_squares(const ConstMatrix& A, const ConstVector& b, double threshold);

/// The X whose columns have the least |A x - b|. Precondition: the columns of A are independent.
Matrix least_squares(const ConstMatrix& A, const ConstMatrix& B);

/// Moore and Penrose's inverse [columns x rows]. Pivots below the rounding of the largest count as 0.
Matrix pseudo_inverse(const ConstMatrix& A);

/// An orthonormal base [rows x (rows - rank)] of what is at right angles to all columns of A. Pivots below threshold
/// times the largest count as 0.
Matrix orthogonal_complement(const ConstMatrix& A, double threshold);

/// The same where the columns are known to be independent: [rows x (rows - columns)], without pivoting.
Matrix orthogonal_complement(const ConstMatrix& A);

/// Orthonormal bases of what the columns of A span and of what is at right angles to it.
struct RangeAndComplement {
  Matrix range;       ///< [rows x rank]
  Matrix complement;  ///< [rows x (rows - rank)]
};

/// Of a matrix of known rank: pivots behind that many count as 0.
RangeAndComplement range_and_complement(const ConstMatrix& A, std::size_t rank);

/// The upper triangle R [columns x columns] with |R y| = |A y| for every y. Rows beyond those of A are 0.
Matrix upper_triangle(const ConstMatrix& A);

/// U, upper triangular, with U^T U = W. Precondition: W is symmetric and positive definite.
Matrix cholesky_root(const ConstMatrix& W);

/// The solution of A x = b, or nothing where the symmetric A is not positive definite.
std::optional<Vector> solve_positive_definite(const ConstMatrix& A, const ConstVector& b);

/// Eigenvalues and eigenvectors of a symmetric matrix, the smallest value first.
struct EigenDecomposition {
  Vector values;   ///< eigenvalues
  Matrix vectors;  ///< orthonormal columns, in the order of the values
};

/// Of a symmetric matrix.
/// @{
EigenDecomposition eigen_decomposition(const ConstMatrix& A);
Vector eigenvalues(const ConstMatrix& A);  ///< The smallest first.
/// @}

/// P A = L U of a [6 x 6] matrix, with row pivots. It allocates nothing, so it may be called for each sample.
class LuFactors6 {
 public:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;  ///< what is factored
  using Vector6 = Eigen::Matrix<double, 6, 1>;  ///< a right side or a solution
  using Places = Eigen::Matrix<int, 6, 1>;      ///< of rows, counted from 0

  explicit LuFactors6(const Matrix6& A);  ///< Factors A, which may be singular.

  Vector6 solve(const Vector6& b) const;                  ///< x of A x = b. Precondition: A is not singular.
  Matrix6 inverse() const;                                ///< Precondition: A is not singular.
  double determinant() const;                             ///< Of A.
  Vector6 pivots() const { return factors_.diagonal(); }  ///< diagonal of U
  const Places& row_places() const { return places_; }    ///< where P moves each row of A

 private:
  Matrix6 factors_;  ///< L below the diagonal, whose own diagonal is 1, and U
  Places places_;
  int sign_;  ///< determinant of P
};

/// X of A X = B, the square A with row pivots. Precondition: A is not singular.
Matrix solve(const ConstMatrix& A, const ConstMatrix& B);
Matrix inverse(const ConstMatrix& A);  ///< Precondition: A is square and not singular.

}  // namespace poesy::linalg
