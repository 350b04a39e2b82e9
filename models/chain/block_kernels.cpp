// This file is compiled once for each instruction set.
#include "models/chain/block_kernels.h"

#include "models/chain/block_kernel.h"
#include "models/simd/lanes.h"

namespace poesy::chain {

template <>
Kernels kernels<simd::Isa::POESY_KERNEL_ISA>() {
  return {solve_block<simd::Lanes>, map_block<simd::Lanes>, move_platform_block<simd::Lanes>};
}

}  // namespace poesy::chain
