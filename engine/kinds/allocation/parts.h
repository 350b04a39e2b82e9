#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/kinds/allocation/result.h"
#include "engine/study/study_kind.h"

/// Reads and writes the parts of a drawing in study files: [[analysis.parts]].
namespace poesy {

StudyTables part_tables();  ///< The keys of a part.

/// The number of standard deviations in a tolerance, by `sigmas` or `cpk` of a section; none if it has neither. Throws
/// InputError if it has both.
std::optional<double> read_sigmas(const StudySection& section);

/// Reads one block: a part, or with `each` several. usual_sigmas: the value of a block that states none. taken: the
/// names of other parts. The study must already have its errors and the factors that vary. Throws InputError at the
/// place of what is wrong, but does not compare with the errors of other blocks.
std::vector<AllocatedPart> read_part_block(const StudySection& block, const Study& study,
                                           std::optional<double> usual_sigmas, std::span<const std::string_view> taken);

/// The part as a TOML block that lists its factors one by one and reads back to the same part.
std::string part_text(const AllocatedPart& part, const ModelDescription& model);

/// Throws InputError at the place for a tolerance of this part that is not smaller than the dimension whose error it is
/// (Model::error_bound).
void check_part_sizes(const StudySection& block, const AllocatedPart& part, const Model& model);

bool has_cost(const AllocatedPart& part);  ///< Whether it, or a process of it, has a cost.

/// The dimension of its errors.
Dimension dimension_of(const AllocatedPart& part, const ModelDescription& model);

}  // namespace poesy
