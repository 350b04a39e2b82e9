#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/kinds/allocation/members.h"
#include "engine/kinds/allocation/result.h"
#include "engine/study/study_kind.h"

/// Reads and writes those blocks [[analysis.parts]] of a study file whose parts are zones of a drawing.
namespace poesy::allocation {

/// The parts of a block with the key `zones`; their cost and their possible tolerances are not set. Each named zone is
/// a part, but zones of identical limbs share one. The part of a zone of location has all errors of the feature, or
/// only those of its middle if the feature also has a zone of orientation. taken: names of the parts of other
/// blocks. Throws InputError if the zones cannot be parts. Precondition: the block has `zones`.
std::vector<AllocatedPart> read_zones(const StudySection& block, const Study& study,
                                      std::span<const std::string_view> taken);

/// If one of these parts is a zone of location, and the drawing gives its feature a zone of orientation that is not a
/// part, adds that zone as a part with the tolerance of the drawing. Throws InputError at `value`, the list of blocks,
/// if a part is a zone of orientation whose features also have a zone of location, but no part is that zone of location
/// in the same limbs.
void complete_zones(const StudyValue& value, const Study& study, std::vector<AllocatedPart>& parts);

/// The text of the keys of a block that reads back as this part. Precondition: the part is a zone.
std::string zones_text(const AllocatedPart& part, const ModelDescription& model);

}  // namespace poesy::allocation
