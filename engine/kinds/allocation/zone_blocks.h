#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/kinds/allocation/members.h"
#include "engine/kinds/allocation/result.h"
#include "engine/study/study_kind.h"

/// Reads and writes which zones of a drawing a block [[analysis.parts]] makes parts.
namespace poesy {

/// The parts of a block with `zones`, without cost and choice: one for each zone that it names, where zones of
/// identical limbs share a part. A location beside an orientation has the errors of the middle alone. taken: the names
/// of other parts. Throws InputError at the place. Precondition: the block has `zones`.
std::vector<AllocatedPart> read_zones(const StudySection& block, const Study& study,
                                      std::span<const std::string_view> taken);

/// Adds the orientations that the drawing gives to locations among these parts, as parts with that tolerance. value:
/// the list of blocks. Throws InputError for an orientation whose location is in no part or shared by other limbs.
void complete_zones(const StudyValue& value, const Study& study, std::vector<AllocatedPart>& parts);

/// The keys of a block that read back to this part. Precondition: it is a zone.
std::string zones_text(const AllocatedPart& part, const ModelDescription& model);

}  // namespace poesy
