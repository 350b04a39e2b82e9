#include "models/simd/number.h"
#include "models/three_prs/closure_kernel.h"
#include "models/three_prs/first_order_kernel.h"
#include "models/three_prs/kernels.h"

namespace poesy::three_prs {

Kernels plain_kernels() { return {map_tile<simd::Number>, close_tile<simd::Number>}; }

}  // namespace poesy::three_prs
