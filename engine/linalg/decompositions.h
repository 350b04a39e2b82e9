#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

/// Decompositions of small dense matrices as plain functions. Only this folder instantiates Eigen's templates for
/// decompositions, because each of them takes seconds to compile. Matrices of fixed size are passed without a copy if
/// they are column-major.
namespace poesy::linalg {

using Matrix = Eigen::MatrixXd;                ///< a matrix of any size
using Vector = Eigen::VectorXd;                ///< a vector of any size
using ConstMatrix = Eigen::Ref<const Matrix>;  ///< a matrix, or a block of one, as an argument that is only read
using ConstVector = Eigen::Ref<const Vector>;  ///< a vector, or a segment of one, as an argument that is only read

/// The decomposition A = U diag(values) V^T with orthogonal U [rows x rows] and V [columns x columns]. If A has more
/// columns than rows, the last columns of V belong to singular values of zero.
struct SingularValueDecomposition {
  Matrix U;       ///< left singular vectors; empty unless computed
  Vector values;  ///< [min(rows, columns)] singular values, the largest first
  Matrix V;       ///< right singular vectors; empty unless computed
};

/// The singular value decomposition of A by Jacobi rotations, or only parts of it. Precondition: A has at least one row
/// and one column.
/// @{
Vector singular_values(const ConstMatrix& A);
SingularValueDecomposition right_singular_vectors(const ConstMatrix& A);  ///< values and V; U is empty
SingularValueDecomposition singular_value_decomposition(const ConstMatrix& A);
/// @}

double determinant(const ConstMatrix& A);  ///< The determinant of a square matrix; 1 for an empty one.
/// The rank: the number of singular values above threshold times the largest one; 0 for a matrix without columns.
std::size_t rank(const ConstMatrix& A, double threshold);

/// The x with the smallest norm that minimises |A x - b|. Pivots below threshold times the largest count as 0.
Vector least_squares(const ConstMatrix& A, const ConstVector& b, double threshold);

/// The matrix X whose columns x minimise |A x - b| for the columns b of B. Precondition: the columns of A are
/// independent.
Matrix least_squares(const ConstMatrix& A, const ConstMatrix& B);

/// The Moore-Penrose inverse [columns x rows] of A. Pivots that are not above rounding error, relative to the largest
/// one, count as 0.
Matrix pseudo_inverse(const ConstMatrix& A);

/// An orthonormal basis [rows x (rows - rank)] of the space orthogonal to all columns of A. Pivots below threshold
/// times the largest count as 0.
Matrix orthogonal_complement(const ConstMatrix& A, double threshold);

/// An orthonormal basis [rows x (rows - columns)] of the space orthogonal to all columns of A, computed without
/// pivoting. Precondition: the columns of A are independent.
Matrix orthogonal_complement(const ConstMatrix& A);

/// Orthonormal bases of the range of A and of its orthogonal complement.
struct RangeAndComplement {
  Matrix range;       ///< [rows x rank]
  Matrix complement;  ///< [rows x (rows - rank)]
};

/// Orthonormal bases of the range of A and of its complement, for a matrix whose rank is known. Pivots after the first
/// `rank` ones count as 0.
RangeAndComplement range_and_complement(const ConstMatrix& A, std::size_t rank);

/// The upper triangular matrix R [columns x columns] with |R y| = |A y| for every vector y. If A has fewer rows than
/// columns, the last rows of R are 0.
Matrix upper_triangle(const ConstMatrix& A);

/// The upper triangular U with U^T U = W. Precondition: W is symmetric and positive definite.
Matrix cholesky_root(const ConstMatrix& W);

/// The solution of A x = b; none if the symmetric A is not positive definite.
std::optional<Vector> solve_positive_definite(const ConstMatrix& A, const ConstVector& b);

/// Eigenvalues and eigenvectors of a symmetric matrix, the smallest value first.
struct EigenDecomposition {
  Vector values;   ///< eigenvalues
  Matrix vectors;  ///< orthonormal columns, in the order of the values
};

/// The eigenvalues and eigenvectors of A, or only the eigenvalues. Precondition: A is symmetric.
/// @{
EigenDecomposition eigen_decomposition(const ConstMatrix& A);
Vector eigenvalues(const ConstMatrix& A);  ///< The eigenvalues, smallest first.
/// @}

/// The factors P A = L U of a [6 x 6] matrix, with row pivoting. No memory is allocated, so a solver may use them for
/// each sample.
class LuFactors6 {
 public:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;  ///< type of the matrix
  using Vector6 = Eigen::Matrix<double, 6, 1>;  ///< type of a right-hand side or a solution
  using Places = Eigen::Matrix<int, 6, 1>;      ///< type of a list of row numbers, counted from 0

  explicit LuFactors6(const Matrix6& A);  ///< Factors A, which may be singular.

  Vector6 solve(const Vector6& b) const;  ///< The solution x of A x = b. Precondition: A is not singular.
  Matrix6 inverse() const;                ///< The inverse of A. Precondition: A is not singular.
  double determinant() const;             ///< The determinant of A.
  Vector6 pivots() const { return factors_.diagonal(); }  ///< The diagonal of U.
  const Places& row_places() const { return places_; }    ///< For each row of A, the row to which P moves it.

 private:
  Matrix6 factors_;  ///< L below the diagonal (the diagonal of L is 1), and U on and above it
  Places places_;
  int sign_;  ///< determinant of P, +1 or -1
};

/// The solution X of A X = B for a square A, with row pivoting. Precondition: A is not singular.
Matrix solve(const ConstMatrix& A, const ConstMatrix& B);
Matrix inverse(const ConstMatrix& A);  ///< The inverse of A. Precondition: A is square and not singular.

}  // namespace poesy::linalg
