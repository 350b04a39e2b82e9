#pragma once

#include <cstddef>

/// The largest number of lanes (numbers in one vector register) for which kernels are compiled. It is 1 if kernels
/// compute one number at a time, as on a GPU.
#ifndef POESY_MOST_LANES
#define POESY_MOST_LANES 8
#endif

namespace poesy::simd {

/// The largest number of lanes of any instruction set. The arrays with one number for each sample are padded to
/// multiples of this number.
inline constexpr std::size_t kMostLanes = POESY_MOST_LANES;

/// Instruction sets that kernels are compiled for.
enum class Isa {
  plain,   ///< one double at a time, on every computer
  avx2,    ///< 4 lanes, with fused multiply-add
  avx512,  ///< 8 lanes
  neon     ///< 2 lanes
};

/// The best instruction set that this computer supports, or the one named by the environment variable POESY_ISA (plain,
/// avx2, avx512, neon). Throws InputError if the variable names anything else, or a set that this computer does not
/// support.
Isa selected_isa();

/// Calls choose.operator()<isa>() for selected_isa(). Uses Isa::plain if this build has no kernels for that set.
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
