#pragma once

#include "engine/report/html/parts.h"

namespace poesy {

/// Adds pictures of the mechanism to the section. Limbs are coloured by the forces that the errors cause in them, and
/// arrows along the drives show the forces of the drives. Forces are root mean squares over the errors. The pictures
/// show at most two poses: those at which the largest of the limbs' forces has its maximum and its minimum. Nothing is
/// added if the result has no forces of limbs or if all of them are zero, or if the result's mechanism cannot be built
/// again.
void add_forces(const ReportKind& kind, const ReportedResult& reported, Section& section);

}  // namespace poesy
