#pragma once

#include "models/file/mechanism.h"
#include "models/file/numbers.h"

namespace poesy::file {

/// Sets factors, terms, features, sets and each of a mechanism whose limbs are complete. Errors of frames come in the
/// order in which the file names them, or limb by limb, frame by frame, epsilon before delta; those of features and
/// errors with their own names follow. Throws InputError if a pattern matches no error, or if two errors have the same
/// name.
void add_factors(const Numbers& numbers, Mechanism& mechanism);

/// Adds an error. name: of its table. Throws InputError if another error has the factor's name.
void add_error(Factor factor, chain::ErrorTerms terms, const Reference& name, Mechanism& mechanism);

}  // namespace poesy::file
