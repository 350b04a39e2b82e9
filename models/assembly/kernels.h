#pragma once

#include "models/assembly/kernel_problem.h"
#include "models/simd/isa.h"

namespace poesy::assembly {

/// The kernel of one instruction set. Each is a translation unit of its own, kernels.cpp compiled for that set; see
/// simd::for_selected_isa().
template <simd::Isa isa>
KernelSolve kernel();
/// Specialisations.
/// @{
template <>
KernelSolve kernel<simd::Isa::plain>();
template <>
KernelSolve kernel<simd::Isa::avx2>();
template <>
KernelSolve kernel<simd::Isa::avx512>();
template <>
KernelSolve kernel<simd::Isa::neon>();
/// @}

}  // namespace poesy::assembly
