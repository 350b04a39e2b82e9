#pragma once

#include <span>

#include "models/file/mechanism.h"

namespace poesy::file {

/// Fills factors, slots, sets and each of a mechanism whose limbs are complete: errors of frames in the order in which
/// the file names them, or limb by limb, frame by frame, epsilon before delta; then errors with names of their own.
/// Throws InputError for patterns that fit no error, and for names that two errors have.
void add_factors(const MechanismFile& file, std::span<const double> geometry, Mechanism& mechanism);

}  // namespace poesy::file
