#pragma once

namespace poesy::simd {

/// Instruction sets that kernels are compiled for.
enum class Isa {
  plain,   ///< one double at a time, on any machine
  avx2,    ///< 4 lanes, with FMA
  avx512,  ///< 8 lanes
  neon     ///< 2 lanes
};

/// The best set this machine has, or the one that the environment variable POESY_ISA names (plain, avx2, avx512,
/// neon). Throws InputError when that is none of them, or not on this machine.
Isa selected_isa();

}  // namespace poesy::simd
