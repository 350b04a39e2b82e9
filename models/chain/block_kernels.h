#pragma once

#include "models/chain/block_problem.h"
#include "models/simd/isa.h"

namespace poesy::chain {

/// What there is for an instruction set.
struct Kernels {
  KernelSolve solve;                 ///< of a block
  KernelMapBlock map;                ///< of a block
  KernelMovePlatform move_platform;  ///< of a block
};

/// Of one instruction set. Each is a translation unit of its own, block_kernels.cpp compiled for that set; see
/// simd::for_selected_isa().
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

}  // namespace poesy::chain
