#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/kinds/limited_vectors.h"
#include "engine/kinds/what_if/machines.h"

/// Machines of a study, solved at the poses from which the yield at other sizes of the errors is predicted.
namespace poesy {

/// A limit on a limited vector, whose components are consecutive rows of WhatIfMachines::Rows. The limit is on the norm
/// of the vector, or on the value if there is only one row. The ends of the limit are divided by `scale`.
struct ScaledLimit {
  std::size_t first;  ///< position of the row with the first component
  std::size_t rows;   ///< number of components
  double scale;  ///< divisor, SI: half the distance between the ends of the limit, or the magnitude of its only end
  double low;    ///< lower end divided by the scale; minus infinity if there is none
  double high;   ///< upper end divided by the scale; infinity if there is none
};

/// Machines with the study's sizes of errors, solved at some poses, and the derivatives of their limited vectors.
struct TriedMachines {
  std::vector<std::size_t> poses;  ///< [poses] positions of the poses in the study
  /// [poses] The limited vectors of each machine, reduced to as few components as possible.
  std::vector<WhatIfMachines::Rows> rows;
  std::vector<WhatIfMachines::Slopes> slopes;  ///< [poses] derivatives of the vectors in `rows`
  std::vector<ScaledLimit> limits;             ///< limits on the vectors in `rows`
  /// The same limits for the vectors that WhatIfMachines::solve() returns. Those vectors have the same norms as the
  /// vectors in `rows`, but may have more components.
  std::vector<ScaledLimit> solved_limits;
};

/// Solves the machines at these poses, and computes the derivatives and the scaled limits.
TriedMachines tried_machines(std::vector<std::size_t> poses, const Plan& plan, const LimitedVectors& vectors,
                             WhatIfMachines& machines);

/// [machines] By how much each machine exceeds its worst limit at a pose, as a share of the limit's scale; negative if
/// the machine is within all limits, infinite if it is not solved.
std::vector<double> badness(const WhatIfMachines::Rows& rows, std::span<const ScaledLimit> limits);

/// The limited vectors of each machine at pose k of `tried`, to first order, if the deviations of the errors from their
/// means are multiplied by the factors `sizes` [errors].
WhatIfMachines::Rows changed(const TriedMachines& tried, const WhatIfMachines& machines, std::size_t k,
                             std::span<const double> sizes);

}  // namespace poesy
