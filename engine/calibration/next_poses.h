#pragma once

#include <cstddef>
#include <vector>

#include "engine/linalg/decompositions.h"

namespace poesy::calibration {

/// A pose that is worth measuring.
struct NextPose {
  std::size_t candidate;  ///< index in the list of candidates
  /// Information about the fitted numbers, in bits, in addition to that of the poses chosen before.
  double gain;
};

/// Chooses candidates one after the other. Each time it takes the candidate with the largest gain, or the first of
/// several equal ones. The gain of a candidate with derivatives a is half the binary logarithm of det(Q + a^T a) / det
/// Q. Here Q is the information about the `fitted` first numbers after all other numbers were fitted (the Schur
/// complement). information: [(k + places) x (k + places)], positive definite, for k = fitted. rows: for each
/// candidate, the derivatives of its values [values x (k + places)] over their standard deviations.
std::vector<NextPose> next_poses(linalg::Matrix information, const std::vector<linalg::Matrix>& rows,
                                 std::size_t fitted, std::size_t count);

}  // namespace poesy::calibration
