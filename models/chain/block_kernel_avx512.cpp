#include "models/chain/block_kernel.h"
#include "models/chain/block_kernels.h"
#include "models/simd/pack.h"

namespace poesy::chain {

void solve_block_avx512(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
                        const KernelOptions& options, const KernelOutcome& outcome, double* scratch) {
  solve_block<simd::HWY_NAMESPACE::Pack>(chain, samples, start, options, outcome, scratch);
}

}  // namespace poesy::chain
