#pragma once

#include "models/file/mechanism.h"
#include "models/file/numbers.h"

namespace poesy::file {

/// Sets the errors of a mechanism whose limbs are complete: the members `factors`, `terms`, `features`,
/// `feature_places`, `sets` and `each`. Errors of frames come first, in the order in which the file names them, or else
/// limb by limb and frame by frame, epsilon before delta. Errors of features follow, then errors with their own names.
/// Throws InputError if a pattern matches no error, or if two errors have the same name.
void add_factors(const Numbers& numbers, Mechanism& mechanism);

/// Adds an error to the mechanism. name: name in the file, for messages. Throws InputError if another error has the
/// factor's name.
void add_error(Factor factor, chain::ErrorTerms terms, const Reference& name, Mechanism& mechanism);

}  // namespace poesy::file
