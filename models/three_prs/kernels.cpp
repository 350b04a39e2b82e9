#include "models/three_prs/kernels.h"

#include "models/simd/isa.h"

namespace poesy::three_prs {

Kernels selected_kernels() {
  switch (simd::selected_isa()) {
#ifdef POESY_KERNELS_X86
    case simd::Isa::avx512:
      return avx512_kernels();
    case simd::Isa::avx2:
      return avx2_kernels();
#endif
#ifdef POESY_KERNELS_ARM
    case simd::Isa::neon:
      return neon_kernels();
#endif
    default:
      return plain_kernels();
  }
}

}  // namespace poesy::three_prs
