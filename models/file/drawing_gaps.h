#pragma once

#include <string>
#include <vector>

#include "models/file/mechanism.h"

/// What a drawing leaves open, as clauses for people.
namespace poesy::file {

/// The directions of each part's error twist that act on a body, or press limbs against each other, to first order at
/// home or at one of 20 poses of the workspace, although no error of the part covers them. An error of a feature counts
/// if a zone limits it; stated errors count as well. Between the axes of a spherical or cylindrical joint there is no
/// part. A clause: "limbs 1 to 3, between q and B (frame 2): displacement along y has no tolerance", in the axes of the
/// part's frame. Empty without features.
std::vector<std::string> uncovered_directions(const Mechanism& mechanism);

/// Zones that say less than they seem to: a location or an orientation without datums, and an orientation that is as
/// wide as its location allows.
std::vector<std::string> doubtful_zones(const Mechanism& mechanism);

}  // namespace poesy::file
