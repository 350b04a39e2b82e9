// This file is compiled once for each instruction set.
#include "models/assembly/kernels.h"

#include "models/assembly/kernel.h"
#include "models/simd/lanes.h"

namespace poesy::assembly {

template <>
Kernels kernels<simd::Isa::POESY_KERNEL_ISA>() {
  return {solve_assemblies<simd::Lanes>, map_assemblies<simd::Lanes>};
}

}  // namespace poesy::assembly
