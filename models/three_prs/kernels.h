#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/model/status.h"
#include "models/simd/isa.h"
#include "models/three_prs/sources.h"

// The kernels, and the plain data that goes into and comes out of them. Nothing but pointers and numbers: this header
// is also read by translation units compiled for one instruction set, which must not share inline functions.

namespace poesy::three_prs {

/// No instruction set has more lanes.
inline constexpr std::size_t kMostLanes = 8;
/// Samples that a kernel takes at once: what they need stays in the nearest cache.
inline constexpr std::size_t kTile = 64;

inline constexpr std::size_t kVectorRows = 9;     ///< theta, dr, displacement of the tip
inline constexpr std::size_t kResponseRows = 12;  ///< and their norms
inline constexpr std::size_t kDetailRows = 3;     ///< swings

/// At most kTile samples, in rows: entry (v, b) at v * stride + b. Rows can be read and written up to the next multiple
/// of kMostLanes; what stands behind the last sample is overwritten.
struct Tile {
  std::size_t count;            ///< samples
  const double* values;         ///< [varied x stride]
  std::size_t values_stride;    ///< distance between rows of values, in numbers
  double* responses;            ///< [kResponseRows x stride]
  double* details;              ///< [kDetailRows x stride], or null
  std::size_t outcomes_stride;  ///< distance between rows of responses and details, in numbers
  SolveStatus* status;          ///< [count]
  std::uint32_t* iterations;    ///< [count]
};

/// What errors do to first order.
struct FirstOrderMap {
  std::size_t varied;      ///< V
  const double* effects;   ///< [varied x rows]: rows are kVectorRows, then kDetailRows
  const double* constant;  ///< [rows]: of the errors that do not vary
};
inline constexpr std::size_t kMapRows = kVectorRows + kDetailRows;

/// One limb at a nominal pose; matrices by rows.
struct ClosureLimb {
  double cosine;                   ///< of the angle about z from the base frame to the limb's
  double sine;                     ///< likewise
  double base_R_platform_limb[9];  ///< R R_i
  double joint[3];                 ///< from P to C_i, base frame
  double q;                        ///< of the carriage, nominal
  double error[kSources];          ///< as ordered by Source; the constant part
  int varied_row[kSources];        ///< row of Tile::values that stands there instead; -1 where it is constant
  bool varies;                     ///< whether any does
};

/// The mechanism at a nominal pose. The six equations are those of close_limbs: three of rods, three of joints.
struct ClosurePose {
  ClosureLimb limb[kLimbs];  ///< at that pose
  double a;                  ///< radius of the rails' circle
  double l;                  ///< length of the rods
  double r[3];               ///< P, base frame
  double tool[3];            ///< from P to the tip, base frame
  double start[36];          ///< [delta; dr] from the equations' values without motion, where a solve starts
  std::size_t row[6];        ///< where each equation stands in the elimination, whose columns are [dr; delta]
  double pivot_sign;         ///< of the product of the pivots without errors, as 1.0 or -1.0; 0 at a singular pose
};

/// How the iteration ends.
struct ClosureOptions {
  double tolerance;              ///< on the change of [delta; dr]
  double rounding;               ///< below which a change may be rounding
  std::uint32_t max_iterations;  ///< after which a sample is given up
};

/// Doubles of scratch for close_tile, for any instruction set.
inline constexpr std::size_t kClosureScratch = 48 * kTile;

/// The kernels of one instruction set. Each set is a translation unit of its own, kernels.cpp compiled for that set.
struct Kernels {
  /// Responses, status and iterations of errors to first order; details where they are asked for.
  void (*map_tile)(const FirstOrderMap& map, const Tile& tile);
  /// Responses, status and iterations of solves by Newton; no details. Returns how many samples it gave up because they
  /// need more care than it takes: those have no iterations. scratch: [kClosureScratch], aligned to 64 bytes.
  std::size_t (*close_tile)(const ClosurePose& pose, const ClosureOptions& options, const Tile& tile, double* scratch);
};

/// Of one instruction set; see simd::for_selected_isa().
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
