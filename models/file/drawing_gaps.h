#pragma once

#include <string>
#include <vector>

#include "models/file/mechanism.h"

/// Directions of errors that the tolerances of a drawing do not limit, errors without effect, and zones that limit
/// nothing, as clauses for messages.
namespace poesy::file {

/// Finds, for each part, directions of its error twist that matter but that no error of the part covers. A direction
/// matters if it moves a body or presses limbs against each other, to first order at home or at one of 20 poses of the
/// workspace. Errors of a feature cover directions if a zone limits them; errors with names of their own ([[error]])
/// cover directions as well. Both sides of a slide are one part for displacements along it. Between the axes of a
/// spherical or cylindrical joint there is no part. Each result is a clause such as "limbs 1 to 3, between q and B
/// (frame 2): displacement along y has no tolerance", in the axes of the part's frame. Empty without features.
std::vector<std::string> uncovered_directions(const Mechanism& mechanism);

/// A clause about the errors with names of their own ([[error]]) that are the only error of their parts and have no
/// effect to first order, at home and at 20 poses of the workspace: their direction may be a mistake. None if every
/// such error has an effect.
std::vector<std::string> errors_without_effect(const Mechanism& mechanism);

/// Clauses such as "rod_1 displaces 73 deg off ..." about errors with names of their own and errors of distances. In
/// the part of such an error, displacements have an effect to first order in only one direction, for example along a
/// rod between balls. The error displaces the part obliquely to this direction, and the errors of the part together
/// (for a distance, those of its distances) do not reach it. Such an error is often meant for the length of a rod, but
/// only a part of it counts.
std::vector<std::string> oblique_displacements(const Mechanism& mechanism);

/// Clauses about doubtful zones: a location or an orientation without datums, and an orientation zone so wide that it
/// has no effect beside the feature's location zone (drawing::widest_orientation()). There are also clauses about a
/// distance whose nominal size is less than half or more than twice the length of its part in that direction, about an
/// axis that is too long or too short for its part, and about zones above a fiftieth of the mechanism's reach.
std::vector<std::string> doubtful_zones(const Mechanism& mechanism);

/// A clause about the first clearance, if the mechanism is over-constrained; else no clause. The model lets a clearance
/// add to the mismatch between limbs, although the play of a real joint takes mismatch up.
std::vector<std::string> doubtful_clearances(const Mechanism& mechanism);

}  // namespace poesy::file
