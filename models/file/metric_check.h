#pragma once

#include "models/file/mechanism.h"
#include "models/file/mechanism_file.h"

namespace poesy::file {

/// Throws InputError if the platform's points define no metric. The message proposes points whose coordinates have the
/// order of magnitude of the mechanism's reach.
void check_metric(const MechanismFile& file, const Mechanism& made);

}  // namespace poesy::file
