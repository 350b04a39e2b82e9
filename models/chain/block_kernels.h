#pragma once

#include "models/chain/block_problem.h"
#include "models/simd/isa.h"

namespace poesy::chain {

/// The kernels of one instruction set.
struct Kernels {
  KernelSolve solve;                 ///< solves a block of samples
  KernelMapBlock map;                ///< computes a block of samples to first order
  KernelMovePlatform move_platform;  ///< finds the motion of the platform for a block of samples
};

/// The kernels of one instruction set. Each set has its own translation unit, block_kernels.cpp compiled for that set;
/// see simd::for_selected_isa().
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
