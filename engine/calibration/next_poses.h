#pragma once

#include <cstddef>
#include <vector>

#include "engine/linalg/decompositions.h"

namespace poesy::calibration {

/// A candidate pose that was chosen for a measurement.
struct NextPose {
  std::size_t candidate;  ///< index in the list of candidates
  /// Information about the fitted numbers that the pose adds to that of the poses chosen before, in bits.
  double gain;
};

/// Chooses candidates one after the other. Each time it takes the candidate with the largest gain, or the first of
/// several equal ones. The gain is half the binary logarithm of the ratio of det Q with and without the candidate. Q
/// [fitted x fitted] is the information about the first `fitted` numbers after all other numbers were fitted (Schur
/// complement). information: the information matrix of all numbers, positive definite. rows: [values x all numbers] for
/// each candidate, the derivatives a of its values divided by their standard deviations; the candidate adds a^T a to
/// the information.
std::vector<NextPose> next_poses(linalg::Matrix information, const std::vector<linalg::Matrix>& rows,
                                 std::size_t fitted, std::size_t count);

}  // namespace poesy::calibration
