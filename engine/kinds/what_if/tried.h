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
  double scale;       ///< divisor, SI: the limit itself, half the distance between its two ends, or its only end
  double low;         ///< lower end divided by the scale; minus infinity if there is none
  double high;        ///< upper end divided by the scale; infinity if there is none
};

/// Machines with the study's sizes of errors, solved at some poses, and the derivatives of their limited vectors.
struct TriedMachines {
  std::vector<std::size_t> poses;  ///< [poses] positions among those of the study
  /// [poses] The limited vectors of each machine, with as few components as possible.
  std::vector<WhatIfMachines::Rows> rows;
  std::vector<WhatIfMachines::Slopes> slopes;  ///< [poses] derivatives of the vectors
  std::vector<ScaledLimit> limits;             ///< limits on the vectors in `rows`
  /// These limits for the vectors that WhatIfMachines::solve() gives. The vectors in `rows` have fewer components than
  /// these, and equal norms.
  std::vector<ScaledLimit> solved_limits;
};

/// Solves the machines at these poses.
TriedMachines tried_machines(std::vector<std::size_t> poses, const Plan& plan, const LimitedVectors& vectors,
                             WhatIfMachines& machines);

/// [machines] By how much each machine exceeds its worst limit at a pose, divided by the limit's scale; negative if it
/// is within all limits. Infinite if it is not solved.
std::vector<double> badness(const WhatIfMachines::Rows& rows, std::span<const ScaledLimit> limits);

/// The limited vectors of each machine at pose k of `tried` if the deviations of its errors are multiplied by these
/// factors, to first order. sizes: [errors] factors.
WhatIfMachines::Rows changed(const TriedMachines& tried, const WhatIfMachines& machines, std::size_t k,
                             std::span<const double> sizes);

}  // namespace poesy
