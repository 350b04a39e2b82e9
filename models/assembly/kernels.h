#pragma once

#include "models/assembly/kernel_problem.h"
#include "models/simd/isa.h"

namespace poesy::assembly {

/// The kernels of one instruction set. Each set has its own translation unit, kernels.cpp compiled for that set; see
/// simd::for_selected_isa().
template <simd::Isa isa>
Kernels kernels();
/// The kernels of each instruction set.
/// @{
template <>
Kernels kernels<simd::Isa::plain>();
template <>
Kernels kernels<simd::Isa::avx2>();
template <>
Kernels kernels<simd::Isa::avx512>();
template <>
Kernels kernels<simd::Isa::neon>();
/// @}

}  // namespace poesy::assembly
