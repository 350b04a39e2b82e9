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

/// choose.operator()<isa>() for selected_isa(), where this build has kernels for it; else for plain.
template <class Choose>
auto for_selected_isa(Choose choose) {
  switch (selected_isa()) {
#ifdef POESY_KERNELS_X86
    case Isa::avx512:
      return choose.template operator()<Isa::avx512>();
    case Isa::avx2:
      return choose.template operator()<Isa::avx2>();
#endif
#ifdef POESY_KERNELS_ARM
    case Isa::neon:
      return choose.template operator()<Isa::neon>();
#endif
    default:
      return choose.template operator()<Isa::plain>();
  }
}

}  // namespace poesy::simd
