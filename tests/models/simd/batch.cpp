// Compiled once per instruction set, with POESY_BATCH the name of its function.
#include "tests/models/simd/batch.h"
#include "models/simd/pack.h"

namespace poesy::simd {

Batch POESY_BATCH() { return {sin_cos_rows<HWY_NAMESPACE::Pack>, operate_rows<HWY_NAMESPACE::Pack>}; }

}  // namespace poesy::simd
