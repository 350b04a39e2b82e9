#pragma once

#include <vector>

#include "engine/base/index.h"
#include "engine/study/study_kind.h"

/// Reads which errors a block [[analysis.parts]] joins into parts.
namespace poesy {

using PartMembers = std::vector<FactorIndex>;  ///< Errors that share one tolerance, at least one.

using Limbs = std::vector<std::size_t>;  ///< Numbers of limbs, as files count them.

/// The limbs of a list, at least two and each once. Throws InputError at a value that names none of the model's.
Limbs read_limbs(const StudyValue& value, const ModelDescription& model);

/// Throws InputError at the value for errors whose tolerance cannot be chosen: measured, correlated, about a mean, or
/// drawn anew at each pose.
void check_distributions(const StudyValue& value, const PartMembers& members, const Study& study);

/// The errors of each part of one block: a single part, or with `each` a part for each error, where corresponding
/// errors of identical limbs share a part. An error is in one part of the block. Throws InputError at the place for
/// errors that a part cannot have: unknown or fixed ones, and those whose distribution is measured or correlated.
std::vector<PartMembers> read_members(const StudySection& block, const Study& study);

/// Whether every error of the block is a part of its own.
bool is_each(const StudySection& block);

}  // namespace poesy
