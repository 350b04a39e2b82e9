#pragma once

#include <span>

#include "models/file/mobility.h"

namespace poesy::file {

/// That the limbs do not fit each other, and the joint whose axis or point, if it were another one, would leave the
/// least of it, with that axis or point. mechanism: with a precision by which the poses were reached; poses: at least
/// one.
InputError misfit(const Mechanism& mechanism, std::span<const PoseMobility> poses);

}  // namespace poesy::file
