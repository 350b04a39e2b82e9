#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/model/status.h"
#include "models/simd/isa.h"
#include "models/three_prs/sources.h"

// The kernels, and the plain data that they read and write: only pointers and numbers. Translation units compiled for
// one instruction set also include this header. Translation units of different instruction sets must not share inline
// functions.

namespace poesy::three_prs {

using simd::kMostLanes;
/// Number of samples in a tile. It is so small that the data of a tile stays in the first-level cache.
inline constexpr std::size_t kTile = 64;

/// The number of components of three vectors: the platform's rotation, and the displacements of P and of the tool tip.
inline constexpr std::size_t kVectorRows = 9;
/// The number of responses: the nine components of kVectorRows, then the norms of the three vectors.
inline constexpr std::size_t kResponseRows = 12;
inline constexpr std::size_t kDetailRows = 3;  ///< number of additional outputs: swings of the three rods

/// A tile: the data of at most kTile samples. Each error or response has a row of numbers, one for each sample: row v
/// has the number of sample b at v * stride + b. Rows can be read and written up to the next multiple of kMostLanes;
/// the numbers behind the last sample are overwritten.
struct Tile {
  std::size_t count;            ///< number of samples
  const double* values;         ///< [varied x stride] values of the varied errors, SI
  std::size_t values_stride;    ///< distance between rows of values, in numbers
  double* responses;            ///< [kResponseRows x stride] responses (rad, m)
  double* details;              ///< [kDetailRows x stride] swings of the rods (rad), or null if they are not wanted
  std::size_t outcomes_stride;  ///< distance between rows of responses and of swings, in numbers
  SolveStatus* status;          ///< [count] status of each sample
  std::uint32_t* iterations;    ///< [count] iterations of each sample
};

/// The first-order effects of errors on the nine components of kVectorRows (rotation of the platform, displacements of
/// P and of the tool tip) and on the swings of the three rods.
struct FirstOrderMap {
  std::size_t varied;  ///< number of varied errors
  /// [varied x kMapRows] Effects of each varied error: kVectorRows rows, then kDetailRows rows.
  const double* effects;
  const double* constant;  ///< [kMapRows] effects of the errors that do not vary
};
inline constexpr std::size_t kMapRows = kVectorRows + kDetailRows;

/// One limb at a nominal pose, for the closure kernel. Matrices are stored row by row.
struct ClosureLimb {
  double cosine;                   ///< cosine of the angle about z from the base frame to the limb's frame
  double sine;                     ///< sine of that angle
  double base_R_platform_limb[9];  ///< rotation R R_i from the limb's frame on the platform (R_i) through the
                                   ///< platform's frame (R) to the base frame
  double joint[3];                 ///< from P to C_i, base frame (m)
  double q;                        ///< nominal displacement of the carriage (m)
  double error[kSources];          ///< constant part of each error (rad, m), in the order of Source
  int varied_row[kSources];        ///< row of Tile::values that replaces the error; -1 if it is constant
  bool varies;                     ///< true if any error of the limb varies
};

/// The mechanism at a nominal pose, for the closure kernel. The six equations are those of close_limbs(): three of
/// rods, then three of joints. Lengths are in m.
struct ClosurePose {
  ClosureLimb limb[kLimbs];  ///< the three limbs
  double a;                  ///< radius of the circle of the rails
  double l;                  ///< length of the rods
  double r[3];               ///< P, base frame
  double tool[3];            ///< from P to the tool tip, base frame
  /// Matrix from the values of the equations at zero displacement to the starting point [delta; dr] of the iteration:
  /// rotation of the platform (rad) and displacement of P (m).
  double start[36];
  /// [equations] Row (place in the order of elimination) of each equation. Unlike in `start`, dr is before delta in the
  /// columns of the kernel's Jacobian.
  std::size_t row[6];
  double pivot_sign;  ///< sign of the product of the pivots without errors: 1.0 or -1.0; 0 at a singular pose
};

/// The stopping rule of the iteration.
struct ClosureOptions {
  /// A solve has converged if every component of [delta; dr] (rad, m) changes by less than this.
  double tolerance;
  double rounding;               ///< a change below this (rad, m) may be rounding; see rounding_level()
  std::uint32_t max_iterations;  ///< largest number of iterations; then the status is iteration_cap
};

/// The number of doubles of scratch memory that close_tile needs with any instruction set.
inline constexpr std::size_t kClosureScratch = 48 * kTile;

/// The kernels of one instruction set. Each set has its own translation unit, kernels.cpp compiled for that set.
struct Kernels {
  /// Computes first-order responses, status and iterations, and the swings of the rods if Tile::details is not null.
  void (*map_tile)(const FirstOrderMap& map, const Tile& tile);
  /// Computes responses, status and iterations by Newton's method, but not the swings of the rods. Returns the number
  /// of samples that it gave up, which need close_limbs(); their iterations are 0. scratch: [kClosureScratch], aligned
  /// to 64 bytes.
  std::size_t (*close_tile)(const ClosurePose& pose, const ClosureOptions& options, const Tile& tile, double* scratch);
};

/// The kernels of one instruction set; see simd::for_selected_isa().
template <simd::Isa isa>
Kernels kernels();
template <>
Kernels kernels<simd::Isa::plain>();
template <>
Kernels kernels<simd::Isa::avx2>();
template <>
Kernels kernels<simd::Isa::avx512>();
template <>
Kernels kernels<simd::Isa::neon>();

}  // namespace poesy::three_prs
