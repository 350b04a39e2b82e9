#pragma once

#include <span>

#include "models/file/mechanism.h"

namespace poesy::file {

/// Sets factors, slots, sets and each of a mechanism whose limbs are complete. Errors of frames come in the order in
/// which the file names them, or limb by limb, frame by frame, epsilon before delta; errors with their own names
/// follow. Throws InputError if a pattern matches no error, or if two errors have the same name.
void add_factors(const MechanismFile& file, std::span<const double> geometry, Mechanism& mechanism);

}  // namespace poesy::file
