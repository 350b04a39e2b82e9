#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/kinds/allocation/result.h"
#include "engine/study/study_kind.h"

/// The parts of a drawing, as a study file states them: [[analysis.parts]].
namespace poesy {

StudyTables part_tables();  ///< Their keys.

/// How many standard deviations a tolerance is, by `sigmas` or `cpk` of a section; none where it has neither. Throws
/// InputError where it has both.
std::optional<double> read_sigmas(const StudySection& section);

/// Reads one block: a part, or with `each` several. usual_sigmas: where the block says nothing. taken: names that other
/// parts have. The study must have its errors and the factors that vary. Throws InputError at its place for what is
/// wrong, but looks at no other block's errors.
std::vector<AllocatedPart> read_part_block(const StudySection& block, const Study& study,
                                           std::optional<double> usual_sigmas, std::span<const std::string_view> taken);

/// A block of TOML, with the part's factors one by one, that reads back to the same part.
std::string part_text(const AllocatedPart& part, const ModelDescription& model);

/// Throws InputError at its place for a tolerance of this part, of this block, that is no smaller than what it is an
/// error of (Model::error_bound).
void check_part_sizes(const StudySection& block, const AllocatedPart& part, const Model& model);

bool has_cost(const AllocatedPart& part);  ///< Whether it, or a process of it, has a cost.

/// The dimension of its errors.
Dimension dimension_of(const AllocatedPart& part, const ModelDescription& model);

}  // namespace poesy
