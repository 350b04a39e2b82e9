#pragma once

namespace poesy::simd {

/// Instruction sets that kernels are compiled for.
enum class Isa {
  plain,   ///< one double at a time, on every machine
  avx2,    ///< 4 lanes, with FMA
  avx512,  ///< 8 lanes
  neon     ///< 2 lanes
};

/// The best set that this machine supports, or the one in the environment variable POESY_ISA (plain, avx2, avx512,
/// neon). Throws InputError if that names another set, or one that this machine does not support.
Isa selected_isa();

/// Calls choose.operator()<isa>() for selected_isa() if this build has kernels for it, else for plain.
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
