#pragma once

#include "models/chain/block_kernel_geometry.h"

namespace poesy::chain {

/// Computes f = J^T delta_mu. The residuals delta_mu of the pairs that contain a limb are first summed for each limb,
/// with the sign + if the limb is limb i of the pair, and - if it is limb k.
template <class T, class Shape>
void BlockKernel<T, Shape>::gradient() {
  for (std::size_t i = 0; i < limbs(); ++i) {
    for (int k = 0; k < 3; ++k) pull_[i].w[k] = pull_[i].v[k] = T(0.0);
  }
  for (std::size_t n = 0; n < pairs(); ++n) {
    Screw& plus = pull_[chain_.pair[n].i];
    Screw& minus = pull_[chain_.pair[n].k];
    for (int k = 0; k < 3; ++k) {
      plus.w[k] = plus.w[k] + mu_[n].w[k];
      plus.v[k] = plus.v[k] + mu_[n].v[k];
      minus.w[k] = minus.w[k] - mu_[n].w[k];
      minus.v[k] = minus.v[k] - mu_[n].v[k];
    }
  }
  for (std::size_t i = 0; i < limbs(); ++i) {
    for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) {
      f_[a] = kernel::dot(column_[a], pull_[i]);
    }
  }
}

/// Computes all entries of the Gauss-Newton matrix N = J^T J, [joints x joints], plus a term for each idle freedom (a
/// motion of passive joints that does not move the platform), without which N would be singular.
template <class T, class Shape>
void BlockKernel<T, Shape>::gauss_newton_matrix() {
  const std::size_t size = joints();
  T* __restrict matrix = n_;
  const Screw* column = column_;
  if constexpr (!Shape::kEveryPairOnce) {
    for (std::size_t n = 0; n < size * size; ++n) matrix[n] = T(0.0);
  }
  for (std::size_t i = 0; i < limbs(); ++i) {
    const T meetings(chain_.limb[i].meetings);
    const std::size_t first = first_joint(i);
    for (std::size_t a = first; a < first_joint(i + 1); ++a) {
      for (std::size_t b = first; b <= a; ++b) {
        matrix[a * size + b] = matrix[b * size + a] = meetings * kernel::dot(column[a], column[b]);
      }
    }
  }
  for (std::size_t n = 0; n < pairs(); ++n) {
    const std::size_t i = chain_.pair[n].i, k = chain_.pair[n].k;
    for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) {
      for (std::size_t b = first_joint(k); b < first_joint(k + 1); ++b) {
        T product = -kernel::dot(column[a], column[b]);
        if constexpr (!Shape::kEveryPairOnce) product = product + matrix[a * size + b];
        matrix[a * size + b] = matrix[b * size + a] = product;
      }
    }
  }
  for (std::size_t n = 0; n < chain_.idle_freedoms; ++n) {
    const double* idle = chain_.idle + n * size;
    for (std::size_t a = 0; a < size; ++a) {
      for (std::size_t b = 0; b < size; ++b) matrix[a * size + b] = matrix[a * size + b] + T(idle[a] * idle[b]);
    }
  }
}

/// Computes Newton's matrix M = N + C - R [joints x joints] for the equations J^T delta_mu = 0, with N = J^T J. C comes
/// from the derivative of the logarithm in delta_mu. R comes from the change of J, because a joint moves the axes of
/// the joints after it in its limb.
template <class T, class Shape>
void BlockKernel<T, Shape>::newton_matrix() {
  const std::size_t size = joints();
  T* __restrict matrix = m_;
  const T* __restrict symmetric = n_;
  const Screw* column = column_;
  const Screw* __restrict mu = mu_;
  // If each entry of the matrix changes only once, it is read from the Gauss-Newton matrix N and written to Newton's
  // matrix M. Otherwise M starts as a copy of N.
  const T* __restrict source = symmetric;
  if constexpr (!Shape::kEveryPairOnce) {
    for (std::size_t n = 0; n < size * size; ++n) matrix[n] = symmetric[n];
    source = matrix;
  }
  for (std::size_t b_limb = 0; b_limb < limbs(); ++b_limb) {
    for (std::size_t b = first_joint(b_limb); b < first_joint(b_limb + 1); ++b) {
      Screw own;
      for (int k = 0; k < 3; ++k) own.w[k] = own.v[k] = T(0.0);
      for (std::size_t n = 0; n < pairs(); ++n) {
        const bool is_i = chain_.pair[n].i == b_limb;
        if (!is_i && chain_.pair[n].k != b_limb) continue;
        // The derivative of delta_mu by q_b is -sign_b (1 + ad^2/12) column_b - ad/2 column_b, with sign + in limb i
        // and - in limb k. Row a of M is the product of this derivative with -sign_a column_a.
        const Screw once = kernel::bracket(mu[n], column[b]);
        const T half(is_i ? 0.5 : -0.5);
        const T twelfth(1.0 / 12.0);
        Screw inner;
        for (int k = 0; k < 3; ++k) {
          inner.w[k] = madd(twelfth, once.w[k], half * column[b].w[k]);
          inner.v[k] = madd(twelfth, once.v[k], half * column[b].v[k]);
        }
        const Screw bend = kernel::bracket(mu[n], inner);
        for (int k = 0; k < 3; ++k) {
          own.w[k] = own.w[k] + bend.w[k];
          own.v[k] = own.v[k] + bend.v[k];
        }
        const std::size_t other = is_i ? chain_.pair[n].k : chain_.pair[n].i;
        for (std::size_t a = first_joint(other); a < first_joint(other + 1); ++a) {
          matrix[a * size + b] = source[a * size + b] - kernel::dot(column[a], bend);
        }
      }
      for (std::size_t a = first_joint(b_limb); a < first_joint(b_limb + 1); ++a) {
        T entry = source[a * size + b] + kernel::dot(column[a], own);
        if (a > b) entry = entry - kernel::dot(kernel::bracket(column[b], column[a]), pull_[b_limb]);
        matrix[a * size + b] = entry;
      }
    }
  }
}

/// Factorises the symmetric matrix with the entries entry(a, b), b <= a, as L D L^T. Stores L D below the diagonal of
/// work_, L^T above it and 1 / D behind the matrix. Returns the smallest difference pivot - ratio x diagonal entry, or
/// 1 if all these differences are larger than 1.
template <class T, class Shape>
template <class Entry>
T BlockKernel<T, Shape>::factor(Entry entry, double ratio) {
  const std::size_t size = joints();
  T* __restrict l = work_;
  T* __restrict inverse = work_ + size * size;
  T margin(1.0);
#pragma GCC unroll 9
  for (std::size_t a = 0; a < size; ++a) {
#pragma GCC unroll 9
    for (std::size_t b = 0; b < a; ++b) {
      T sum = entry(a, b);
#pragma GCC unroll 9
      for (std::size_t k = 0; k < b; ++k) sum = nmadd(l[a * size + k], l[k * size + b], sum);
      l[a * size + b] = sum;
    }
    const T diagonal = entry(a, a);
    T pivot = diagonal;
#pragma GCC unroll 9
    for (std::size_t k = 0; k < a; ++k) {
      const T scaled = l[a * size + k] * inverse[k];
      pivot = nmadd(l[a * size + k], scaled, pivot);
      l[k * size + a] = scaled;
    }
    margin = min(margin, nmadd(T(ratio), diagonal, pivot));
    inverse[a] = T(1.0) / pivot;
  }
  return margin;
}

/// The lanes in which of_n N - of_m M is positive definite, with the Gauss-Newton matrix N and Newton's matrix M.
template <class T, class Shape>
typename T::MaskType BlockKernel<T, Shape>::is_positive(double of_n, double of_m) {
  const std::size_t size = joints();
  const auto entry = [&](std::size_t a, std::size_t b) {
    return nmadd(T(0.5 * of_m), m_[a * size + b] + m_[b * size + a], T(of_n) * n_[a * size + b]);
  };
  return factor(entry, 0.0) > T(0.0);
}

/// The lanes in which Gauss-Newton contracts, because 2 N - M is positive definite (N: Gauss-Newton matrix, M: Newton's
/// matrix).
template <class T, class Shape>
typename T::MaskType BlockKernel<T, Shape>::contracts() {
  return is_positive(2.0, 1.0);
}

/// Solves N x = f for the Gauss-Newton step x. Returns the lanes in which all pivots are above rounding.
template <class T, class Shape>
typename T::MaskType BlockKernel<T, Shape>::gauss_newton_step(T* __restrict x) {
  const std::size_t size = joints();
  const double rounding = 4.0 * static_cast<double>(size) * 2.220446049250313e-16;
  const T margin = factor([&](std::size_t a, std::size_t b) { return n_[a * size + b]; }, rounding);
  const T* l = work_;
  const T* inverse = work_ + size * size;
  for (std::size_t a = 0; a < size; ++a) {
    T value = f_[a];
    for (std::size_t k = 0; k < a; ++k) value = nmadd(l[k * size + a], x[k], value);
    x[a] = value;
  }
  for (std::size_t a = size; a-- > 0;) {
    T value = x[a] * inverse[a];
    for (std::size_t k = a + 1; k < size; ++k) value = nmadd(l[a * size + k], x[k], value);
    x[a] = value;
  }
  return margin > T(0.0);
}

/// Solves M x = f for the Newton step x by elimination without pivoting, and overwrites Newton's matrix M with its
/// factors. Returns the lanes in which all pivots are safely positive.
template <class T, class Shape>
typename T::MaskType BlockKernel<T, Shape>::newton_step(T* __restrict x) {
  const std::size_t size = joints();
  T* __restrict m = m_;
  T* __restrict inverse = pivot_;
  T margin(1.0);
  for (std::size_t a = 0; a < size; ++a) x[a] = f_[a];
#pragma GCC unroll 9
  for (std::size_t k = 0; k < size; ++k) {
    const T pivot = m[k * size + k];
    margin = min(margin, nmadd(T(kSafePivot), n_[k * size + k], pivot));
    inverse[k] = T(1.0) / pivot;
#pragma GCC unroll 9
    for (std::size_t a = k + 1; a < size; ++a) {
      const T factor = m[a * size + k] * inverse[k];
#pragma GCC unroll 9
      for (std::size_t b = k + 1; b < size; ++b) m[a * size + b] = nmadd(factor, m[k * size + b], m[a * size + b]);
      x[a] = nmadd(factor, x[k], x[a]);
    }
  }
  for (std::size_t a = size; a-- > 0;) {
    T value = x[a];
    for (std::size_t b = a + 1; b < size; ++b) value = nmadd(m[a * size + b], x[b], value);
    x[a] = value * inverse[a];
  }
  return margin > T(0.0);
}

/// Updates the residual delta_mu of these lanes for the step x, to first order in x: the residual of pair (k, i)
/// changes by V_k - V_i - ad/2 (V_k + V_i) + ad^2/12 (V_k - V_i). V_i is the motion of the platform's end of limb i by
/// the step, and ad = ad(delta_mu).
template <class T, class Shape>
void BlockKernel<T, Shape>::carry_residual(const T* x, typename T::MaskType lanes) {
  for (std::size_t i = 0; i < limbs(); ++i) {
    Screw motion;
    for (int k = 0; k < 3; ++k) motion.w[k] = motion.v[k] = T(0.0);
    for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) {
      for (int k = 0; k < 3; ++k) {
        motion.w[k] = madd(x[a], column_[a].w[k], motion.w[k]);
        motion.v[k] = madd(x[a], column_[a].v[k], motion.v[k]);
      }
    }
    pull_[i] = motion;
  }
  const T half(0.5), twelfth(1.0 / 12.0);
  for (std::size_t n = 0; n < pairs(); ++n) {
    const Screw& k_motion = pull_[chain_.pair[n].k];
    const Screw& i_motion = pull_[chain_.pair[n].i];
    Screw apart, together;
    for (int k = 0; k < 3; ++k) {
      apart.w[k] = k_motion.w[k] - i_motion.w[k];
      apart.v[k] = k_motion.v[k] - i_motion.v[k];
      together.w[k] = k_motion.w[k] + i_motion.w[k];
      together.v[k] = k_motion.v[k] + i_motion.v[k];
    }
    const Screw once = kernel::bracket(mu_[n], together);
    const Screw twice = kernel::bracket(mu_[n], kernel::bracket(mu_[n], apart));
    for (int k = 0; k < 3; ++k) {
      const T w = mu_[n].w[k] + madd(twelfth, twice.w[k], nmadd(half, once.w[k], apart.w[k]));
      const T v = mu_[n].v[k] + madd(twelfth, twice.v[k], nmadd(half, once.v[k], apart.v[k]));
      mu_[n].w[k] = select(lanes, w, mu_[n].w[k]);
      mu_[n].v[k] = select(lanes, v, mu_[n].v[k]);
    }
  }
}

}  // namespace poesy::chain
