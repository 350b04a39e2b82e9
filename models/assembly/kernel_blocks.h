#pragma once

// This header belongs to kernels.cpp alone, which is compiled once for each instruction set.

#include <type_traits>
#include <vector>

#include "models/assembly/kernel_problem.h"

namespace poesy::assembly {

/// Calls work() with the number of passive joints as a compile-time constant. Precondition: passive <= kMostOwnJoints.
template <class Work>
void with_passive(std::size_t passive, Work work) {
  switch (passive) {
    case 0:
      return work(std::integral_constant<std::size_t, 0>());
    case 1:
      return work(std::integral_constant<std::size_t, 1>());
    case 2:
      return work(std::integral_constant<std::size_t, 2>());
    case 3:
      return work(std::integral_constant<std::size_t, 3>());
    case 4:
      return work(std::integral_constant<std::size_t, 4>());
    case 5:
      return work(std::integral_constant<std::size_t, 5>());
    default:
      return work(std::integral_constant<std::size_t, kMostOwnJoints>());
  }
}

/// The matrix of the bodies' equations. It has a block [6 x 6] for each pair of bodies other than the base. Blocks that
/// neither limbs nor the elimination fill stay zero and are skipped. The platform is eliminated last, because most
/// limbs connect other bodies with it.
template <class T>
class BodyMatrix {
 public:
  using Mask = typename T::MaskType;  ///< a truth value for each lane

  /// Finds which blocks may be nonzero. safe: a pivot below this share of its diagonal entry is not safe.
  BodyMatrix(const KernelProblem& problem, double safe)
      : count_(problem.bodies.size() - 1),
        safe_(safe),
        is_filled_(count_ * count_),
        blocks_(36 * count_ * count_),
        pivots_(6 * count_) {
    for (std::size_t i = 0; i < count_; ++i) is_filled_[count_ * i + i] = true;
    for (const KernelLimb& limb : problem.limbs) {
      if (limb.from == 0 || limb.to == 0) continue;
      is_filled_[count_ * place(limb.from) + place(limb.to)] = true;
      is_filled_[count_ * place(limb.to) + place(limb.from)] = true;
    }
    for (std::size_t k = 0; k < count_; ++k) {
      for (std::size_t i = k + 1; i < count_; ++i) {
        for (std::size_t j = k + 1; j < count_; ++j) {
          if (is_filled_[count_ * i + k] && is_filled_[count_ * k + j]) is_filled_[count_ * i + j] = true;
        }
      }
    }
  }

  void clear() {  ///< Sets all entries to 0.
    for (T& entry : blocks_) entry = T(0.0);
  }

  /// Adds sign x block [6 x 6] to the matrix, in the rows of one body and the columns of another.
  void add(std::size_t row, std::size_t column, const T* block, double sign) {
    T* to = at(place(row), place(column));
    for (int k = 0; k < 36; ++k) to[k] = madd(T(sign), block[k], to[k]);
  }

  /// Computes the triangular factors L and U of the matrix without row exchanges. Returns the lanes in which all pivots
  /// are safe.
  Mask factor() {
    Mask safe = T(0.0) < T(1.0);
    T diagonal[6];
    for (std::size_t k = 0; k < count_; ++k) {
      T* pivot = at(k, k);
      for (int m = 0; m < 6; ++m) diagonal[m] = pivot[7 * m];
      factor_block(pivot, &pivots_[6 * k]);
      for (int m = 0; m < 6; ++m) {
        safe = safe & (pivot[7 * m] > T(safe_) * diagonal[m]) & (diagonal[m] > T(0.0));
      }
      for (std::size_t j = k + 1; j < count_; ++j) {
        if (is_filled_[count_ * k + j]) lower_solve(pivot, at(k, j), 6);
      }
      for (std::size_t i = k + 1; i < count_; ++i) {
        if (!is_filled_[count_ * i + k]) continue;
        upper_divide(pivot, &pivots_[6 * k], at(i, k));
        for (std::size_t j = k + 1; j < count_; ++j) {
          if (is_filled_[count_ * k + j]) subtract_product(at(i, k), at(k, j), at(i, j));
        }
      }
    }
    return safe;
  }

  /// Solves the equations after factor(). twists: [6 x bodies], including the base; the right side on entry, the
  /// solution on return.
  void solve(std::vector<T>& twists) const {
    for (std::size_t k = 0; k < count_; ++k) {
      T* x = &twists[6 * body(k)];
      for (std::size_t j = 0; j < k; ++j) subtract_times(k, j, twists, x);
      for (int row = 1; row < 6; ++row) {
        for (int m = 0; m < row; ++m) x[row] = nmadd(at(k, k)[6 * row + m], x[m], x[row]);
      }
    }
    for (std::size_t k = count_; k-- > 0;) {
      T* x = &twists[6 * body(k)];
      for (std::size_t j = k + 1; j < count_; ++j) subtract_times(k, j, twists, x);
      for (int row = 5; row >= 0; --row) {
        for (int m = row + 1; m < 6; ++m) x[row] = nmadd(at(k, k)[6 * row + m], x[m], x[row]);
        x[row] = x[row] * pivots_[6 * k + static_cast<std::size_t>(row)];
      }
    }
  }

 private:
  std::size_t place(std::size_t body) const { return body == 1 ? count_ - 1 : body - 2; }
  std::size_t body(std::size_t place) const { return place + 1 == count_ ? 1 : place + 2; }
  T* at(std::size_t row, std::size_t column) { return &blocks_[36 * (count_ * row + column)]; }
  const T* at(std::size_t row, std::size_t column) const { return &blocks_[36 * (count_ * row + column)]; }

  static void factor_block(T* a, T* pivots) {
    for (int k = 0; k < 6; ++k) {
      pivots[k] = T(1.0) / a[7 * k];
      for (int i = k + 1; i < 6; ++i) {
        const T factor = a[6 * i + k] * pivots[k];
        a[6 * i + k] = factor;
        for (int j = k + 1; j < 6; ++j) a[6 * i + j] = nmadd(factor, a[6 * k + j], a[6 * i + j]);
      }
    }
  }

  /// Replaces b by L^-1 b, with the lower triangle L of the factors `a`.
  static void lower_solve(const T* a, T* b, int columns) {
    for (int row = 1; row < 6; ++row) {
      for (int m = 0; m < row; ++m) {
        for (int j = 0; j < columns; ++j) b[6 * row + j] = nmadd(a[6 * row + m], b[6 * m + j], b[6 * row + j]);
      }
    }
  }

  /// Replaces b by b U^-1, with the upper triangle U of the factors `a`.
  static void upper_divide(const T* a, const T* pivots, T* b) {
    for (int row = 0; row < 6; ++row) {
      T* of = b + 6 * row;
      for (int j = 0; j < 6; ++j) {
        for (int m = 0; m < j; ++m) of[j] = nmadd(of[m], a[6 * m + j], of[j]);
        of[j] = of[j] * pivots[j];
      }
    }
  }

  /// Replaces c by c - a b.
  static void subtract_product(const T* a, const T* b, T* c) {
    for (int row = 0; row < 6; ++row) {
      for (int m = 0; m < 6; ++m) {
        for (int j = 0; j < 6; ++j) c[6 * row + j] = nmadd(a[6 * row + m], b[6 * m + j], c[6 * row + j]);
      }
    }
  }

  /// Subtracts from x the product of block(row, column) and the twist of the column's body.
  void subtract_times(std::size_t row, std::size_t column, const std::vector<T>& twists, T* x) const {
    if (!is_filled_[count_ * row + column]) return;
    const T* block = at(row, column);
    const T* twist = &twists[6 * body(column)];
    for (int k = 0; k < 6; ++k) {
      for (int m = 0; m < 6; ++m) x[k] = nmadd(block[6 * k + m], twist[m], x[k]);
    }
  }

  std::size_t count_;            ///< number of bodies without the base
  double safe_;                  ///< smallest safe pivot as a share of the diagonal
  std::vector<bool> is_filled_;  ///< [count x count] true for each block that may be nonzero
  std::vector<T> blocks_;        ///< [count x count] blocks, row by row
  std::vector<T> pivots_;        ///< reciprocal pivots
};

}  // namespace poesy::assembly
