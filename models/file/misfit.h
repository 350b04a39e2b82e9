#pragma once

#include <span>

#include "models/file/mobility.h"

namespace poesy::file {

/// Makes the error message that the limbs do not fit each other. It names the joint whose corrected axis or point would
/// reduce the mismatch most, with the corrected value. mechanism: its precision must be the one with which the poses
/// were reached. poses: at least one.
InputError misfit(const Mechanism& mechanism, std::span<const PoseMobility> poses);

}  // namespace poesy::file
