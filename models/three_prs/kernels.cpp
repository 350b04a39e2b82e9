// This file is compiled once for each instruction set.
#include "models/three_prs/kernels.h"

#include "models/simd/lanes.h"
#include "models/three_prs/closure_kernel.h"
#include "models/three_prs/first_order_kernel.h"

namespace poesy::three_prs {

template <>
Kernels kernels<simd::Isa::POESY_KERNEL_ISA>() {
  return {map_tile<simd::Lanes>, close_tile<simd::Lanes>};
}

}  // namespace poesy::three_prs
