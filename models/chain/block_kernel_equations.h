#pragma once

#include "models/chain/block_kernel_geometry.h"

namespace poesy::chain {

/// f = J^T delta_mu, from each limb's signed sum of the residuals it takes part in.
template <class T>
void BlockKernel<T>::gradient() {
  for (std::size_t i = 0; i < chain_.limbs; ++i) {
    for (int k = 0; k < 3; ++k) pull_[i].w[k] = pull_[i].v[k] = T(0.0);
  }
  for (std::size_t n = 0; n < chain_.pairs; ++n) {
    Screw& plus = pull_[chain_.pair[n].i];
    Screw& minus = pull_[chain_.pair[n].k];
    for (int k = 0; k < 3; ++k) {
      plus.w[k] = plus.w[k] + mu_[n].w[k];
      plus.v[k] = plus.v[k] + mu_[n].v[k];
      minus.w[k] = minus.w[k] - mu_[n].w[k];
      minus.v[k] = minus.v[k] - mu_[n].v[k];
    }
  }
  for (std::size_t i = 0; i < chain_.limbs; ++i) {
    const KernelLimb& limb = chain_.limb[i];
    for (std::size_t a = limb.first_joint; a < limb.first_joint + limb.joints; ++a) {
      f_[a] = kernel::dot(column_[a], pull_[i]);
    }
  }
}

/// N = J^T J, all of it.
template <class T>
void BlockKernel<T>::gauss_newton_matrix() {
  const std::size_t size = chain_.joints;
  for (std::size_t n = 0; n < size * size; ++n) n_[n] = T(0.0);
  for (std::size_t i = 0; i < chain_.limbs; ++i) {
    double meetings = 0.0;
    for (std::size_t n = 0; n < chain_.pairs; ++n) {
      if (chain_.pair[n].i == i || chain_.pair[n].k == i) meetings += 1.0;
    }
    const KernelLimb& limb = chain_.limb[i];
    for (std::size_t a = limb.first_joint; a < limb.first_joint + limb.joints; ++a) {
      for (std::size_t b = limb.first_joint; b <= a; ++b) {
        n_[a * size + b] = n_[b * size + a] = T(meetings) * kernel::dot(column_[a], column_[b]);
      }
    }
  }
  for (std::size_t n = 0; n < chain_.pairs; ++n) {
    const KernelLimb& one = chain_.limb[chain_.pair[n].i];
    const KernelLimb& other = chain_.limb[chain_.pair[n].k];
    for (std::size_t a = one.first_joint; a < one.first_joint + one.joints; ++a) {
      for (std::size_t b = other.first_joint; b < other.first_joint + other.joints; ++b) {
        const T product = n_[a * size + b] - kernel::dot(column_[a], column_[b]);
        n_[a * size + b] = n_[b * size + a] = product;
      }
    }
  }
}

/// M = N + how the logarithm bends - how the columns turn.
template <class T>
void BlockKernel<T>::newton_matrix() {
  const std::size_t size = chain_.joints;
  for (std::size_t n = 0; n < size * size; ++n) m_[n] = n_[n];
  for (std::size_t n = 0; n < chain_.pairs; ++n) {
    const std::size_t sides[2] = {chain_.pair[n].i, chain_.pair[n].k};
    for (int s = 0; s < 2; ++s) {
      const KernelLimb& own = chain_.limb[sides[s]];
      const KernelLimb& other = chain_.limb[sides[1 - s]];
      for (std::size_t b = own.first_joint; b < own.first_joint + own.joints; ++b) {
        // d delta_mu / d q_b = -sign_b (1 + ad^2/12) column_b - ad/2 column_b, with sign + in limb i and - in limb k;
        // row a takes it with -sign_a.
        const Screw once = kernel::bracket(mu_[n], column_[b]);
        const Screw twice = kernel::bracket(mu_[n], once);
        const T half(s == 0 ? 0.5 : -0.5);
        const T twelfth(1.0 / 12.0);
        Screw bend;
        for (int k = 0; k < 3; ++k) {
          bend.w[k] = madd(half, once.w[k], twelfth * twice.w[k]);
          bend.v[k] = madd(half, once.v[k], twelfth * twice.v[k]);
        }
        for (std::size_t a = own.first_joint; a < own.first_joint + own.joints; ++a) {
          m_[a * size + b] = m_[a * size + b] + kernel::dot(column_[a], bend);
        }
        for (std::size_t a = other.first_joint; a < other.first_joint + other.joints; ++a) {
          m_[a * size + b] = m_[a * size + b] - kernel::dot(column_[a], bend);
        }
      }
    }
  }
  for (std::size_t i = 0; i < chain_.limbs; ++i) {
    const KernelLimb& limb = chain_.limb[i];
    for (std::size_t a = limb.first_joint; a < limb.first_joint + limb.joints; ++a) {
      for (std::size_t b = limb.first_joint; b < a; ++b) {
        m_[a * size + b] = m_[a * size + b] - kernel::dot(kernel::bracket(column_[b], column_[a]), pull_[i]);
      }
    }
  }
}

/// L D L^T of a symmetric matrix whose entry (a, b), b <= a, is entry(a, b). Leaves L D below the diagonal of work_,
/// L^T above it and 1 / D behind it; returns the smallest of pivot - ratio x diagonal entry.
template <class T>
template <class Entry>
T BlockKernel<T>::factor(Entry entry, double ratio) {
  const std::size_t size = chain_.joints;
  T* l = work_;
  T* inverse = work_ + size * size;
  T margin(1.0);
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      T sum = entry(a, b);
      for (std::size_t k = 0; k < b; ++k) sum = nmadd(l[a * size + k], l[k * size + b], sum);
      l[a * size + b] = sum;
    }
    const T diagonal = entry(a, a);
    T pivot = diagonal;
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

/// Where 2 N - M is positive definite, so that Gauss-Newton contracts here.
template <class T>
typename T::MaskType BlockKernel<T>::contracts() {
  const std::size_t size = chain_.joints;
  const auto entry = [&](std::size_t a, std::size_t b) {
    return nmadd(T(0.5), m_[a * size + b] + m_[b * size + a], n_[a * size + b] + n_[a * size + b]);
  };
  return factor(entry, 0.0) > T(0.0);
}

/// Solves N x = f; lanes are true where no pivot falls to rounding.
template <class T>
typename T::MaskType BlockKernel<T>::gauss_newton_step(T* x) {
  const std::size_t size = chain_.joints;
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

/// Solves M x = f by elimination without pivoting; M is destroyed. Lanes are true where all pivots are safely positive.
template <class T>
typename T::MaskType BlockKernel<T>::newton_step(T* x) {
  const std::size_t size = chain_.joints;
  T margin(1.0);
  for (std::size_t a = 0; a < size; ++a) x[a] = f_[a];
  for (std::size_t k = 0; k < size; ++k) {
    const T* pivot_row = m_ + k * size;
    const T inverse = T(1.0) / pivot_row[k];
    margin = min(margin, nmadd(T(kSafePivot), n_[k * size + k], pivot_row[k]));
    work_[k] = inverse;
    for (std::size_t a = k + 1; a < size; ++a) {
      T* row = m_ + a * size;
      const T factor = row[k] * inverse;
      for (std::size_t b = k + 1; b < size; ++b) row[b] = nmadd(factor, pivot_row[b], row[b]);
      x[a] = nmadd(factor, x[k], x[a]);
    }
  }
  for (std::size_t a = size; a-- > 0;) {
    T value = x[a];
    for (std::size_t b = a + 1; b < size; ++b) value = nmadd(m_[a * size + b], x[b], value);
    x[a] = value * work_[a];
  }
  return margin > T(0.0);
}

/// The residual of these lanes after the step x, to first order: V_k - V_i - ad/2 (V_k + V_i) + ad^2/12 (V_k - V_i),
/// with V the limbs' motions.
template <class T>
void BlockKernel<T>::carry_residual(const T* x, typename T::MaskType lanes) {
  for (std::size_t i = 0; i < chain_.limbs; ++i) {
    const KernelLimb& limb = chain_.limb[i];
    Screw motion;
    for (int k = 0; k < 3; ++k) motion.w[k] = motion.v[k] = T(0.0);
    for (std::size_t a = limb.first_joint; a < limb.first_joint + limb.joints; ++a) {
      for (int k = 0; k < 3; ++k) {
        motion.w[k] = madd(x[a], column_[a].w[k], motion.w[k]);
        motion.v[k] = madd(x[a], column_[a].v[k], motion.v[k]);
      }
    }
    pull_[i] = motion;
  }
  const T half(0.5), twelfth(1.0 / 12.0);
  for (std::size_t n = 0; n < chain_.pairs; ++n) {
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
