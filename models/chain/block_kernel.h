#pragma once

#include "models/chain/block_kernel_passes.h"
#include "models/chain/block_kernel_platform.h"

namespace poesy::chain {

/// Calls work(KernelClass<Kernel>()), where Kernel is the most specialised kernel that fits the chain.
template <class T, class Work>
void with_kernel(const KernelChain& chain, Work work) {
  ThreeLimbs<3>::fits(chain) ? work(KernelClass<BlockKernel<T, ThreeLimbs<3>>>())
                             : work(KernelClass<BlockKernel<T, AnyShape>>());
}

/// Solves a block of samples; see KernelSolve.
template <class T>
void solve_block(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
                 const KernelOptions& options, const KernelOutcome& outcome, double* scratch) {
  with_kernel<T>(chain, [&](auto kernel) {
    typename decltype(kernel)::Type(chain, samples, start, options, outcome, scratch).solve();
  });
}

/// Computes residuals and responses of a block of samples to first order, by a linear map; see KernelMapBlock.
template <class T>
void map_block(const KernelChain& chain, const KernelSamples& samples, const KernelMap& map,
               const KernelOutcome& outcome, double* scratch) {
  with_kernel<T>(
      chain, [&](auto kernel) { typename decltype(kernel)::Type(chain, samples, {}, {}, outcome, scratch).map(map); });
}

/// Finds the motion of the platform for a block of samples; see KernelMovePlatform.
template <class T>
void move_platform_block(const KernelChain& chain, const KernelSamples& samples, const KernelPlatform& platform,
                         const KernelOutcome& outcome, double* scratch) {
  with_kernel<T>(chain, [&](auto kernel) {
    typename decltype(kernel)::Type(chain, samples, {}, {}, outcome, scratch).move_platform(platform);
  });
}

}  // namespace poesy::chain
