#include "models/simd/pack.h"
#include "models/three_prs/closure_kernel.h"
#include "models/three_prs/first_order_kernel.h"
#include "models/three_prs/kernels.h"

namespace poesy::three_prs {

Kernels avx512_kernels() { return {map_tile<simd::HWY_NAMESPACE::Pack>, close_tile<simd::HWY_NAMESPACE::Pack>}; }

}  // namespace poesy::three_prs
