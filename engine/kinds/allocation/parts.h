#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/units.h"
#include "engine/kinds/allocation/result.h"
#include "engine/study/study_kind.h"

/// Reads and writes the parts of a drawing, [[analysis.parts]], in study files.
namespace poesy::allocation {

StudyTables part_tables();  ///< The keys of a part and of its cost and processes.

/// Reads from `sigmas` or `cpk` of a section how many standard deviations a tolerance is; none if the section has
/// neither. Throws InputError if it has both.
std::optional<double> read_sigmas(const StudySection& section);

/// Reads one block: one part, or several with the key `each`. usual_sigmas: standard deviations in a tolerance, for a
/// block that states neither `sigmas` nor `cpk`. taken: names of the parts of other blocks. Precondition: the study
/// already has its errors and the factors that vary. Throws InputError, but does not check whether another block has
/// the same errors.
std::vector<AllocatedPart> read_part_block(const StudySection& block, const Study& study,
                                           std::optional<double> usual_sigmas, std::span<const std::string_view> taken);

/// The part as a TOML block that names each of its errors or zones and reads back as the same part.
std::string part_text(const AllocatedPart& part, const ModelDescription& model);

/// Throws InputError if the largest tolerance of this part, or one of its possible values, is not smaller than the
/// dimension of the mechanism that one of its errors changes (Model::error_bound).
void check_part_sizes(const StudySection& block, const AllocatedPart& part, const Model& model);

bool has_cost(const AllocatedPart& part);  ///< Whether the part, or one of its processes, has a cost.

using poesy::dimension_of;  // the overload for a unit, which the next function would hide

/// The dimension of the part's errors.
Dimension dimension_of(const AllocatedPart& part, const ModelDescription& model);

}  // namespace poesy::allocation
