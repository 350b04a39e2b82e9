#pragma once

#include <cstddef>
#include <vector>

#include "engine/linalg/decompositions.h"

namespace poesy::calibration {

/// A pose that is worth measuring.
struct NextPose {
  std::size_t candidate;  ///< position among the candidates
  double gain;            ///< information about the fitted numbers, in bits, beyond that of the poses before it
};

/// The candidates with the largest gains, one after the other; the first of equals. The gain of a candidate with the
/// rows a is half the binary logarithm of det(Q + a^T a) / det Q, where Q is the information about the fitted numbers
/// that is left after the other columns were fitted (the Schur complement). information: [(k + places) x (k + places)],
/// positive definite. rows: of each candidate [values x (k + places)], over standard deviations.
std::vector<NextPose> next_poses(linalg::Matrix information, const std::vector<linalg::Matrix>& rows,
                                 std::size_t fitted, std::size_t count);

}  // namespace poesy::calibration
