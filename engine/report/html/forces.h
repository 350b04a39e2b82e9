#pragma once

#include "engine/report/html/parts.h"

namespace poesy {

/// Adds to the section pictures of the mechanism with limbs coloured by the forces that the errors cause, and with
/// arrows along the drives. Forces are root mean squares over the errors. The pictures show the poses at which the
/// largest force is largest and smallest. Adds nothing if the result has no forces of limbs, or if its mechanism cannot
/// be built again.
void add_forces(const ReportKind& kind, const ReportedResult& reported, Section& section);

}  // namespace poesy
