#pragma once

#include "models/chain/block_kernel_passes.h"

namespace poesy::chain {

/// Solves a block with the kernel that fits the chain best.
template <class T>
void solve_block(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
                 const KernelOptions& options, const KernelOutcome& outcome, double* scratch) {
  if (ThreeLimbs<3>::fits(chain)) {
    BlockKernel<T, ThreeLimbs<3>>(chain, samples, start, options, outcome, scratch).solve();
  } else {
    BlockKernel<T, AnyShape>(chain, samples, start, options, outcome, scratch).solve();
  }
}

}  // namespace poesy::chain
