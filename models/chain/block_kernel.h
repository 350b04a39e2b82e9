#pragma once

#include "models/chain/block_kernel_meeting.h"
#include "models/chain/block_kernel_metric.h"
#include "models/chain/block_kernel_passes.h"
#include "models/chain/block_kernel_platform.h"

namespace poesy::chain {

/// Calls work with the KernelClass that is specialised most for this chain.
template <class T, class Work>
void with_kernel(const KernelChain& chain, Work work) {
  const bool is_fixed = ThreeLimbs<3>::fits(chain);
  if (chain.metric == nullptr) {
    is_fixed ? work(KernelClass<BlockKernel<T, ThreeLimbs<3>, Published>>())
             : work(KernelClass<BlockKernel<T, AnyShape, Published>>());
  } else {
    is_fixed ? work(KernelClass<BlockKernel<T, ThreeLimbs<3>, Weighted>>())
             : work(KernelClass<BlockKernel<T, AnyShape, Weighted>>());
  }
}

/// Solves a block; see KernelSolve.
template <class T>
void solve_block(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
                 const KernelOptions& options, const KernelOutcome& outcome, double* scratch) {
  with_kernel<T>(chain, [&](auto kernel) {
    typename decltype(kernel)::Type(chain, samples, start, options, outcome, scratch).solve();
  });
}

/// Maps a block to first order; see KernelMapBlock.
template <class T>
void map_block(const KernelChain& chain, const KernelSamples& samples, const KernelMap& map,
               const KernelOutcome& outcome, double* scratch) {
  with_kernel<T>(
      chain, [&](auto kernel) { typename decltype(kernel)::Type(chain, samples, {}, {}, outcome, scratch).map(map); });
}

/// Finds the motion of the platform in a block; see KernelMovePlatform.
template <class T>
void move_platform_block(const KernelChain& chain, const KernelSamples& samples, const KernelPlatform& platform,
                         const KernelOutcome& outcome, double* scratch) {
  with_kernel<T>(chain, [&](auto kernel) {
    typename decltype(kernel)::Type(chain, samples, {}, {}, outcome, scratch).move_platform(platform);
  });
}

}  // namespace poesy::chain
