#pragma once

#include <cstddef>
#include <cstdint>

#include "models/three_prs/kernel_data.h"

namespace poesy::three_prs {

/// Solves a tile of samples for the closure of all limbs, T::kLanes at a time, T being simd::Number or a SIMD batch:
/// equations, Newton steps, stopping rule and iteration counts are those of close_limbs. A lane that has ended keeps
/// its motion, and no operation mixes lanes.
///
/// The Jacobian is eliminated in an order of its rows that is the same for all samples of a pose. What that cannot do
/// is given up: pivots that differ by more than 1e6, steps that are large or not finite, attitude errors beyond 100
/// rad, and rotations by more than 120 deg in the end.
template <class T>
class ClosureKernel {
 public:
  /// Refers to all of it.
  ClosureKernel(const ClosurePose& pose, const ClosureOptions& options, const Tile& tile, double* scratch)
      : pose_(pose), options_(options), tile_(tile), group_(reinterpret_cast<Group*>(scratch)) {}

  /// Returns how many samples were given up.
  std::size_t solve();

 private:
  using Mask = typename T::MaskType;
  static constexpr std::size_t kLanes = T::kLanes;
  static constexpr unsigned kAllLanes = (1u << kLanes) - 1u;
  static constexpr double kPivotRatio = 1e-6;
  static constexpr double kLargestStep = 50.0;  ///< sum of magnitudes, rad and m
  static constexpr double kLargestAngle2 = 1e4;

  /// As LimbWithErrors.
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
    T smallest;  ///< change so far
    T active;    ///< 1 in lanes that go on, 0 in those that have ended
  };
  static_assert(sizeof(Group) <= 48 * kLanes * sizeof(double));

  struct Equations {
    T joint[kLimbs][3];  ///< from P to C_i
    T rod[kLimbs][3];
    T value[6];
  };

  // closure_kernel_equations.h
  Limb limb_with_errors(const ClosureLimb& limb, std::size_t at) const;
  void evaluate(const Group& group, Equations& equations) const;
  Mask first_step(const Group& group, T* step) const;
  Mask newton_step(const Group& group, T* step) const;
  static Mask eliminate(T (&m)[6][7], T* x);

  // closure_kernel.h: the loop over samples.
  void begin(std::size_t g);
  bool round(std::size_t g, std::uint32_t iteration);
  void move(Group& group, const T* step, Mask lanes) const;
  /// Writes down how these lanes ended, a bit each; without iterations where they are given up.
  void end(std::size_t g, unsigned lanes, SolveStatus status, std::uint32_t iterations) const;
  void store(std::size_t g);

  const ClosurePose& pose_;
  const ClosureOptions& options_;
  const Tile& tile_;
  Group* group_;
};

}  // namespace poesy::three_prs
