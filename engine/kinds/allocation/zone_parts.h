#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/kinds/allocation/drawn_part.h"
#include "engine/kinds/allocation/result.h"
#include "engine/model/model.h"
#include "engine/optimise/least_cost.h"

/// Zones of a drawing as parts. The mean squares of a feature's errors are linear in the squares of its tolerances. Let
/// T be the width of the zone of location, T_o that of the zone of orientation, and k the number of standard deviations
/// in half a zone. With a zone of orientation, each error of the middle has the mean square (T^2 - T_o^2) / (4 k^2),
/// and each error of the tilt has a multiple of T_o^2. Without a zone of orientation, middle and tilt share the zone of
/// location.
namespace poesy::allocation {

/// Whether the part is a zone of orientation. Precondition: the part is a zone.
bool is_orientation(const AllocatedPart& part, const ModelDescription& model);

/// The feature of a zone, in the first limb that has it. Precondition: the part is a zone.
const Feature& feature_of(const AllocatedPart& part, const ModelDescription& model);

/// The zone as the drawing states it. Precondition: the part is a zone.
const Zone& zone_of(const AllocatedPart& part, const ModelDescription& model);

/// The limbs that share a zone, in words: "1-3", or "1, 3".
std::string limbs_of(const AllocatedPart& part, const ModelDescription& model);

/// The shape of a zone: "cylinder", "sphere", "planes", or "interval" for a distance. Precondition: the part is a zone.
std::string_view shape_of(const AllocatedPart& part, const ModelDescription& model);

/// The errors that depend on the tolerance T of a zone, and how their mean squares grow with T^2. factors: the errors
/// that vary; the result refers to positions in this list.
DrawnPart drawn_zone(const AllocatedPart& part, const ModelDescription& model, std::span<const FactorIndex> factors);

/// The pairs of a zone of orientation and the zone of location of the same features, in the order of the locations. The
/// drawing may leave out an orientation whose tolerance is chosen. An orientation whose tolerance is given is left out
/// only if the location is so fine that the orientation does not limit the feature further.
std::vector<Within> zone_pairs(std::span<const AllocatedPart> parts, const ModelDescription& model);

}  // namespace poesy::allocation
