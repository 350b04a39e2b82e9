#pragma once

#include "models/chain/block_problem.h"

namespace poesy::chain {

// Two per instruction set, each set compiled in a translation unit of its own. See best_kernels().
void solve_block_plain(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
                       const KernelOptions& options, const KernelOutcome& outcome, double* scratch);
void solve_block_avx2(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
                      const KernelOptions& options, const KernelOutcome& outcome, double* scratch);
void solve_block_avx512(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
                        const KernelOptions& options, const KernelOutcome& outcome, double* scratch);
void solve_block_neon(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
                      const KernelOptions& options, const KernelOutcome& outcome, double* scratch);

void map_block_plain(const KernelChain& chain, const KernelSamples& samples, const KernelMap& map,
                     const KernelOutcome& outcome, double* scratch);
void map_block_avx2(const KernelChain& chain, const KernelSamples& samples, const KernelMap& map,
                    const KernelOutcome& outcome, double* scratch);
void map_block_avx512(const KernelChain& chain, const KernelSamples& samples, const KernelMap& map,
                      const KernelOutcome& outcome, double* scratch);
void map_block_neon(const KernelChain& chain, const KernelSamples& samples, const KernelMap& map,
                    const KernelOutcome& outcome, double* scratch);

}  // namespace poesy::chain
