#pragma once

#include <cstddef>
#include <cstdint>

#include "models/simd/rotation.h"
#include "models/three_prs/first_order_kernel.h"
#include "models/three_prs/kernels.h"

namespace poesy::three_prs {

/// Solves the closure of all limbs for a tile (at most kTile samples), T::kLanes samples at a time. T is simd::Number
/// or a SIMD batch. Equations, Newton steps, stopping rule and iteration counts are those of close_limbs(). A lane
/// whose solve has ended keeps its motion, and no operation mixes lanes.
///
/// The rows of the Jacobian are eliminated in the same order for all samples of a pose. The kernel gives up a sample if
/// the pivots of its Jacobian differ by a factor of more than 1e6, a step is large or not finite, an attitude error
/// exceeds 100 rad, or the final rotation exceeds 120 deg.
template <class T>
class ClosureKernel {
 public:
  /// Keeps references to pose, options and tile. scratch: [kClosureScratch], aligned to 64 bytes.
  ClosureKernel(const ClosurePose& pose, const ClosureOptions& options, const Tile& tile, double* scratch)
      : pose_(pose), options_(options), tile_(tile), group_(reinterpret_cast<Group*>(scratch)) {}

  /// Solves the tile. Returns the number of samples that it gave up.
  std::size_t solve();

 private:
  using Mask = typename T::MaskType;
  static constexpr std::size_t kLanes = T::kLanes;
  static constexpr unsigned kAllLanes = (1u << kLanes) - 1u;
  static constexpr double kPivotRatio = 1e-6;
  /// A sample is given up if the magnitudes of a step's components (rad, m) have a larger sum than this.
  static constexpr double kLargestStep = 50.0;
  static constexpr double kLargestAngle2 = 1e4;

  /// A limb with its errors, as LimbWithErrors.
  struct Limb {
    T carriage[3];
    T axis[3];
    T joint[3];
    T rod_y;
    T length2;
  };
  struct Group {
    Limb limb[kLimbs];
    T E[9];
    T dr[3];
    T smallest;  ///< smallest change of all iterations so far
    T active;    ///< 1 in lanes that continue, 0 in lanes that have ended
  };
  static_assert(sizeof(Group) <= 48 * kLanes * sizeof(double));

  struct Equations {
    T joint[kLimbs][3];  ///< vector from P to C_i
    T rod[kLimbs][3];
    T value[6];
  };

  // Functions for the equations and their steps.
  Limb limb_with_errors(const ClosureLimb& limb, std::size_t at) const;
  void evaluate(const Group& group, Equations& equations) const;
  Mask first_step(const Group& group, T* step) const;
  Mask newton_step(const Group& group, T* step, T& pivots) const;
  static Mask eliminate(T (&m)[6][7], T* x, T& pivots);

  // Functions for the loop over samples.
  void begin(std::size_t g);
  bool round(std::size_t g, std::uint32_t iteration);
  void move(Group& group, const T* step, Mask lanes) const;
  /// Stores status and iterations of the lanes whose bits are set in `lanes`. A lane that is given up has 0 iterations.
  void end(std::size_t g, unsigned lanes, SolveStatus status, std::uint32_t iterations) const;
  void store(std::size_t g);

  const ClosurePose& pose_;
  const ClosureOptions& options_;
  const Tile& tile_;
  Group* group_;
};

namespace kernel {

/// Rotates a vector x by the rotation vector w: exp(w) x.
template <class T>
inline void rotate(const T* w, const simd::ExpCoefficients<T>& c, T* x) {
  T once[3], twice[3];
  simd::cross(w, x, once);
  simd::cross(w, once, twice);
  for (int k = 0; k < 3; ++k) x[k] = madd(c.b, twice[k], madd(c.a, once[k], x[k]));
}

/// Sets x to the second column of the rotation matrix exp(w): the direction of the rotated y axis.
template <class T>
inline void second_column(const T* w, const simd::ExpCoefficients<T>& c, T* x) {
  const T scaled = c.b * w[1];
  x[0] = nmadd(c.a, w[2], scaled * w[0]);
  x[1] = nmadd(c.b, madd(w[2], w[2], w[0] * w[0]), T(1.0));
  x[2] = madd(c.a, w[0], scaled * w[2]);
}

/// Rotates x about the z axis by the angle that has this cosine and sine.
template <class T>
inline void turn(double cosine, double sine, T* x) {
  const T before = x[0];
  x[0] = nmadd(T(sine), x[1], T(cosine) * before);
  x[1] = madd(T(sine), before, T(cosine) * x[1]);
}

}  // namespace kernel

template <class T>
auto ClosureKernel<T>::limb_with_errors(const ClosureLimb& limb, std::size_t at) const -> Limb {
  T error[kSources];
  for (std::size_t n = 0; n < kSources; ++n) {
    const int row = limb.varied_row[n];
    error[n] =
        row < 0 ? T(limb.error[n]) : T::load(tile_.values + static_cast<std::size_t>(row) * tile_.values_stride + at);
  }
  const T* a = error + static_cast<std::size_t>(Source::a);
  const T* theta_A = error + static_cast<std::size_t>(Source::theta_A);
  const T* b = error + static_cast<std::size_t>(Source::b);
  const T* theta_B = error + static_cast<std::size_t>(Source::theta_B);
  const T* theta_Bp = error + static_cast<std::size_t>(Source::theta_Bp);
  const T* c = error + static_cast<std::size_t>(Source::c);
  const T angle2_A = simd::dot3(theta_A, theta_A);
  const T angle2_B = simd::dot3(theta_B, theta_B);
  const T angle2_Bp = simd::dot3(theta_Bp, theta_Bp);
  const auto exp_A = simd::exp_coefficients(angle2_A);
  const auto exp_B = simd::exp_coefficients(angle2_B);
  const auto exp_Bp = simd::exp_coefficients(angle2_Bp);

  Limb out;
  for (int k = 0; k < 3; ++k) {
    out.carriage[k] = b[k];
    const double* row = limb.base_R_platform_limb + 3 * k;
    out.joint[k] = madd(T(row[2]), c[2], madd(T(row[1]), c[1], madd(T(row[0]), c[0], T(limb.joint[k]))));
  }
  kernel::rotate(theta_B, exp_B, out.carriage);
  kernel::second_column(theta_B, exp_B, out.axis);
  out.carriage[2] = out.carriage[2] + (T(limb.q) + error[static_cast<std::size_t>(Source::q)]);
  kernel::rotate(theta_A, exp_A, out.carriage);
  kernel::rotate(theta_A, exp_A, out.axis);
  out.carriage[0] = out.carriage[0] + T(pose_.a);
  for (int k = 0; k < 3; ++k) out.carriage[k] = out.carriage[k] + a[k];
  kernel::turn(limb.cosine, limb.sine, out.carriage);
  kernel::turn(limb.cosine, limb.sine, out.axis);

  const T length = T(pose_.l) + error[static_cast<std::size_t>(Source::l)];
  out.rod_y = length * nmadd(exp_Bp.a, theta_Bp[0], exp_Bp.b * theta_Bp[1] * theta_Bp[2]);
  // The sine is not valid beyond 100 rad. A larger attitude error makes length2 NaN, so that the kernel gives up the
  // sample.
  const T largest = max(angle2_A, max(angle2_B, angle2_Bp));
  out.length2 = select(largest < T(kLargestAngle2), length * length, T(__builtin_nan("")));
  return out;
}

template <class T>
void ClosureKernel<T>::evaluate(const Group& group, Equations& equations) const {
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const Limb& limb = group.limb[i];
    T* joint = equations.joint[i];
    T* rod = equations.rod[i];
    for (int k = 0; k < 3; ++k) {
      joint[k] = simd::dot3(group.E + 3 * k, limb.joint);
      rod[k] = (T(pose_.r[k]) + group.dr[k]) + joint[k] - limb.carriage[k];
    }
    equations.value[i] = T(0.5) * (simd::dot3(rod, rod) - limb.length2);
    equations.value[i + 3] = simd::dot3(limb.axis, rod) - limb.rod_y;
  }
}

/// Computes the first step of a solve: a Newton step from zero displacement with the nominal Jacobian. Returns the
/// lanes in which the step is short enough to be used.
template <class T>
auto ClosureKernel<T>::first_step(const Group& group, T* step) const -> Mask {
  Equations equations;
  evaluate(group, equations);
  T size(0.0);
  for (int k = 0; k < 6; ++k) {
    const double* row = pose_.start + 6 * k;
    step[k] = T(row[0]) * equations.value[0];
    for (int n = 1; n < 6; ++n) step[k] = madd(T(row[n]), equations.value[n], step[k]);
    size = size + abs(step[k]);
  }
  return size < T(kLargestStep);
}

/// Solves A x = b for m = [A | b]. Returns the lanes in which no pivot is small relative to the others. Sets `pivots`
/// to the product of the pivots.
template <class T>
auto ClosureKernel<T>::eliminate(T (&m)[6][7], T* x, T& pivots) -> Mask {
  T inverse[6];
  T smallest = abs(m[0][0]), largest = smallest;
  pivots = T(1.0);
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    const T pivot = abs(m[k][k]);
    smallest = min(smallest, pivot);
    largest = max(largest, pivot);
    pivots = pivots * m[k][k];
    inverse[k] = T(1.0) / m[k][k];
#pragma GCC unroll 6
    for (int row = k + 1; row < 6; ++row) {
      const T factor = m[row][k] * inverse[k];
#pragma GCC unroll 7
      for (int column = k + 1; column < 7; ++column) {
        m[row][column] = nmadd(factor, m[k][column], m[row][column]);
      }
    }
  }
#pragma GCC unroll 6
  for (int k = 5; k >= 0; --k) {
    T sum = m[k][6];
#pragma GCC unroll 6
    for (int column = k + 1; column < 6; ++column) sum = nmadd(m[k][column], x[column], sum);
    x[k] = sum * inverse[k];
  }
  return smallest > T(kPivotRatio) * largest;
}

/// Computes a Newton step. Sets step to [delta; dr] and pivots to the product of the Jacobian's pivots. Returns the
/// lanes in which the step is usable.
template <class T>
auto ClosureKernel<T>::newton_step(const Group& group, T* step, T& pivots) const -> Mask {
  Equations equations;
  evaluate(group, equations);
  T m[6][7];
  for (std::size_t n = 0; n < 6; ++n) {
    const std::size_t i = n % 3;
    const T* direction = n < 3 ? equations.rod[i] : group.limb[i].axis;
    T* row = m[pose_.row[n]];
    for (int k = 0; k < 3; ++k) row[k] = direction[k];
    simd::cross(equations.joint[i], direction, row + 3);
    row[6] = -equations.value[n];
  }
  T x[6];
  const Mask regular = eliminate(m, x, pivots);
  T size(0.0);
  for (int k = 0; k < 6; ++k) {
    step[(k + 3) % 6] = x[k];
    size = size + abs(x[k]);
  }
  return regular & (size < T(kLargestStep));
}

template <class T>
void ClosureKernel<T>::begin(std::size_t g) {
  Group& group = group_[g];
  for (int k = 0; k < 9; ++k) group.E[k] = T(k % 4 == 0 ? 1.0 : 0.0);
  for (int k = 0; k < 3; ++k) group.dr[k] = T(0.0);
  T step[6];
  const Mask taken = first_step(group, step);
  move(group, step, taken);
  group.smallest = T(__builtin_inf());
  group.active = select(taken, T(1.0), T(0.0));
  end(g, kAllLanes, SolveStatus::non_finite, 0);
}

template <class T>
void ClosureKernel<T>::move(Group& group, const T* step, Mask lanes) const {
  const T angle2 = simd::dot3(step, step);
  T r[9], E[9];
  simd::rotation_matrix(step, angle2, simd::exp_coefficients(angle2), r);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      E[3 * row + column] = madd(r[3 * row + 2], group.E[6 + column],
                                 madd(r[3 * row + 1], group.E[3 + column], r[3 * row] * group.E[column]));
    }
  }
  for (int k = 0; k < 9; ++k) group.E[k] = select(lanes, E[k], group.E[k]);
  for (int k = 0; k < 3; ++k) group.dr[k] = select(lanes, group.dr[k] + step[3 + k], group.dr[k]);
}

/// Makes one iteration of a group of lanes. Returns true if any of its lanes continues.
template <class T>
bool ClosureKernel<T>::round(std::size_t g, std::uint32_t iteration) {
  Group& group = group_[g];
  T step[6], pivots;
  const Mask taken = (group.active > T(0.5)) & newton_step(group, step, pivots);
  move(group, step, taken);
  T change = abs(step[0]);
  for (int k = 1; k < 6; ++k) change = max(change, abs(step[k]));
  const Mask converged = taken & (change < T(options_.tolerance));
  const Mask falling = (change > T(options_.rounding)) | (change < group.smallest);
  const Mask on = taken & !(converged | !falling);
  const Mask stagnated = taken & !(converged | falling);
  group.smallest = min(group.smallest, change);
  group.active = select(on, T(1.0), T(0.0));
  end(g, bits(converged), SolveStatus::converged, iteration);
  end(g, bits(stagnated), SolveStatus::stagnated, iteration);
  // A root beyond a singular pose counts as singular; see close_limbs().
  const Mask beyond = T(pose_.pivot_sign) * pivots < T(0.0);
  end(g, bits((converged | stagnated) & beyond), SolveStatus::singular, iteration);
  return any(on);
}

template <class T>
void ClosureKernel<T>::end(std::size_t g, unsigned lanes, SolveStatus status, std::uint32_t iterations) const {
  if (lanes == 0) return;
  for (std::size_t lane = 0; lane < kLanes && g * kLanes + lane < tile_.count; ++lane) {
    if ((lanes >> lane & 1u) == 0) continue;
    tile_.status[g * kLanes + lane] = status;
    tile_.iterations[g * kLanes + lane] = iterations;
  }
}

template <class T>
void ClosureKernel<T>::store(std::size_t g) {
  const Group& group = group_[g];
  const auto log = simd::rotation_log(group.E);
  const T tool[3] = {T(pose_.tool[0]), T(pose_.tool[1]), T(pose_.tool[2])};
  T vectors[kVectorRows];
  for (int k = 0; k < 3; ++k) {
    vectors[k] = log.w[k];
    vectors[3 + k] = group.dr[k];
    vectors[6 + k] = group.dr[k] + (simd::dot3(group.E + 3 * k, tool) - tool[k]);
  }
  store_responses(vectors, tile_, g * kLanes);
  const Mask wide = !(group.E[0] + group.E[4] + group.E[8] > T(0.0));
  end(g, bits(wide), SolveStatus::non_finite, 0);
}

template <class T>
std::size_t ClosureKernel<T>::solve() {
  const std::size_t groups = (tile_.count + kLanes - 1) / kLanes;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    for (std::size_t g = 0; g < groups; ++g) {
      const bool known = g > 0 && !pose_.limb[i].varies;
      group_[g].limb[i] = known ? group_[0].limb[i] : limb_with_errors(pose_.limb[i], g * kLanes);
    }
  }
  std::size_t live[kTile];
  for (std::size_t g = 0; g < groups; ++g) {
    begin(g);
    live[g] = g;
  }
  std::size_t left = groups;
  for (std::uint32_t iteration = 1; iteration <= options_.max_iterations && left > 0; ++iteration) {
    std::size_t kept = 0;
    for (std::size_t n = 0; n < left; ++n) {
      if (round(live[n], iteration)) live[kept++] = live[n];
    }
    left = kept;
  }
  for (std::size_t n = 0; n < left; ++n) {
    end(live[n], bits(group_[live[n]].active > T(0.5)), SolveStatus::iteration_cap, options_.max_iterations);
  }
  for (std::size_t g = 0; g < groups; ++g) store(g);
  std::size_t given_up = 0;
  for (std::size_t b = 0; b < tile_.count; ++b) given_up += tile_.iterations[b] == 0 ? 1 : 0;
  return given_up;
}

template <class T>
std::size_t close_tile(const ClosurePose& pose, const ClosureOptions& options, const Tile& tile, double* scratch) {
  return ClosureKernel<T>(pose, options, tile, scratch).solve();
}

}  // namespace poesy::three_prs
