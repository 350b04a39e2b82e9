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

/// Zones of a drawing as parts. Mean squares of a feature's errors are linear in the squares of its tolerances: with a
/// zone of orientation, the middle has (T^2 - T_o^2) / 4 k^2 and the tilt a multiple of T_o^2; without one, the
/// location shares its zone among both.
namespace poesy {

/// Whether the part is a zone that limits how a feature is turned. Precondition: it is a zone.
bool is_orientation(const AllocatedPart& part, const ModelDescription& model);

/// The feature of the first limb that has this zone. Precondition: it is a zone.
const Feature& feature_of(const AllocatedPart& part, const ModelDescription& model);

/// The zone as the drawing states it. Precondition: it is a zone.
const Zone& zone_of(const AllocatedPart& part, const ModelDescription& model);

/// The features of a zone in words: "1-3", or "1, 3".
std::string limbs_of(const AllocatedPart& part, const ModelDescription& model);

/// "cylinder", "sphere", "planes", or "interval" for a distance. Precondition: it is a zone.
std::string_view shape_of(const AllocatedPart& part, const ModelDescription& model);

/// What one unit of T^2 of a zone adds to mean squares. factors: those that vary, of which errors are positions.
DrawnPart drawn_zone(const AllocatedPart& part, const ModelDescription& model, std::span<const FactorIndex> factors);

/// The pairs of a zone of orientation and the zone of location of the same features, in the order of the latter. An
/// orientation whose tolerance is chosen may be left out; a given one is void only where the location is too fine.
std::vector<Within> zone_pairs(std::span<const AllocatedPart> parts, const ModelDescription& model);

}  // namespace poesy
