#pragma once

// The number type of the instruction set for which a kernel's source is being compiled (models/CMakeLists.txt).

#ifdef POESY_KERNEL_OF_NUMBERS
#include "models/simd/number.h"

namespace poesy::simd {

/// Kernels compute with one number at a time.
using Lanes = Number;

}  // namespace poesy::simd
#else
#include "models/simd/pack.h"

namespace poesy::simd {

/// Kernels compute with a batch of numbers at a time.
using Lanes = HWY_NAMESPACE::Pack;

}  // namespace poesy::simd
#endif
