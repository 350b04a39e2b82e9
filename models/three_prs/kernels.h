#pragma once

#include "models/simd/isa.h"
#include "models/three_prs/kernel_data.h"

namespace poesy::three_prs {

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
