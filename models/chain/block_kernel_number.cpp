#include "models/chain/block_kernel.h"
#include "models/chain/block_kernels.h"
#include "models/simd/number.h"

namespace poesy::chain {

void solve_block_plain(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
                       const KernelOptions& options, const KernelOutcome& outcome, double* scratch) {
  solve_block<simd::Number>(chain, samples, start, options, outcome, scratch);
}

void map_block_plain(const KernelChain& chain, const KernelSamples& samples, const KernelMap& map,
                     const KernelOutcome& outcome, double* scratch) {
  map_block<simd::Number>(chain, samples, map, outcome, scratch);
}

}  // namespace poesy::chain
