#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "models/three_prs/closure.h"
#include "models/three_prs/kernels.h"
#include "models/three_prs/tiles.h"

namespace poesy::three_prs {

/// Closes the limbs of blocks of samples with the fastest kernel this machine has; what a kernel gives up, close_limbs
/// solves. Owns the scratch of one thread.
class ClosureSolver {
 public:
  /// For one thread.
  ClosureSolver(const Geometry& geometry, const SolverOptions& options);

  /// Responses, status and iterations of a block at its nominal configuration; no details.
  void solve(const Configuration& nominal, const SampleBlock& samples, const OutcomeBlock& outcomes);

 private:
  void prepare(const Configuration& nominal, const SampleBlock& samples, const ClosureStart& start);

  Geometry geometry_;
  SolverOptions options_;
  Kernels kernels_;
  Tiles tiles_;
  ClosurePose pose_{};
  ClosureOptions kernel_options_{};
  std::vector<double> scratch_;
};

/// Solves one sample of a block by close_limbs; no details.
void close_sample(const Geometry& geometry, const Configuration& nominal, const SampleBlock& samples,
                  std::size_t sample, const ClosureStart& start, const SolverOptions& options,
                  const OutcomeBlock& outcomes, const ClosureObserver& observe = {});

/// Limbs of one sample of a block.
std::array<LimbWithErrors, kLimbs> limbs_of_sample(const Geometry& geometry, const Configuration& nominal,
                                                   const SampleBlock& samples, std::size_t sample);

}  // namespace poesy::three_prs
