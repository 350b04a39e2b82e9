#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/model/status.h"
#include "models/simd/isa.h"
#include "models/three_prs/sources.h"

// The kernels, and the plain data that goes into and comes out of them: nothing but pointers and numbers. This header
// is also read by translation units compiled for one instruction set, which must not share inline functions.

namespace poesy::three_prs {

/// The largest number of lanes of any instruction set.
inline constexpr std::size_t kMostLanes = 8;
/// Number of samples in a tile, so small that their data stays in the first-level cache.
inline constexpr std::size_t kTile = 64;

inline constexpr std::size_t kVectorRows = 9;     ///< theta, dr, displacement of the tool tip
inline constexpr std::size_t kResponseRows = 12;  ///< the vectors and their norms
inline constexpr std::size_t kDetailRows = 3;     ///< swings

/// At most kTile samples, in rows: entry (v, b) is at v * stride + b. Rows can be read and written up to the next
/// multiple of kMostLanes; entries behind the last sample are overwritten.
struct Tile {
  std::size_t count;            ///< number of samples
  const double* values;         ///< [varied x stride]
  std::size_t values_stride;    ///< distance between rows of values, in numbers
  double* responses;            ///< [kResponseRows x stride]
  double* details;              ///< [kDetailRows x stride], or null
  std::size_t outcomes_stride;  ///< distance between rows of responses and details, in numbers
  SolveStatus* status;          ///< [count]
  std::uint32_t* iterations;    ///< [count]
};

/// The first-order effects of errors.
struct FirstOrderMap {
  std::size_t varied;      ///< V
  const double* effects;   ///< [varied x rows] with kVectorRows, then kDetailRows rows
  const double* constant;  ///< [rows] effects of the errors that do not vary
};
inline constexpr std::size_t kMapRows = kVectorRows + kDetailRows;

/// One limb at a nominal pose; matrices by rows.
struct ClosureLimb {
  double cosine;                   ///< of the angle about z from the base frame to the limb's
  double sine;                     ///< of the same angle
  double base_R_platform_limb[9];  ///< R R_i
  double joint[3];                 ///< from P to C_i, base frame
  double q;                        ///< nominal position of the carriage (m)
  double error[kSources];          ///< constant part of each error, ordered as Source
  int varied_row[kSources];        ///< row of Tile::values that replaces the error; -1 if it is constant
  bool varies;                     ///< whether any error varies
};

/// The mechanism at a nominal pose. The six equations are those of close_limbs(): three of rods, three of joints.
/// Lengths in m.
struct ClosurePose {
  ClosureLimb limb[kLimbs];  ///< the limbs at that pose
  double a;                  ///< radius of the rails' circle
  double l;                  ///< length of the rods
  double r[3];               ///< P, base frame
  double tool[3];            ///< from P to the tip, base frame
  double start[36];          ///< matrix from the values of the equations without motion to the start [delta; dr]
  std::size_t row[6];        ///< position of each equation in the elimination, whose columns are [dr; delta]
  double pivot_sign;         ///< sign of the product of the pivots without errors, as 1.0 or -1.0; 0 at a singular pose
};

/// The stopping rule of the iteration.
struct ClosureOptions {
  double tolerance;              ///< on the change of [delta; dr]
  double rounding;               ///< smaller changes may be rounding
  std::uint32_t max_iterations;  ///< a sample that needs more is given up
};

/// Doubles of scratch that close_tile needs with any instruction set.
inline constexpr std::size_t kClosureScratch = 48 * kTile;

/// The kernels of one instruction set. Each set has its own translation unit: kernels.cpp, compiled for that set.
struct Kernels {
  /// Computes first-order responses, status and iterations, and details if wanted.
  void (*map_tile)(const FirstOrderMap& map, const Tile& tile);
  /// Computes responses, status and iterations by Newton, but no details. Returns the number of samples that it gave up
  /// because they need close_limbs(); these have no iterations. scratch: [kClosureScratch], aligned to 64 bytes.
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
