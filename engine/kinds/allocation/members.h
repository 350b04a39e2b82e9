#pragma once

#include <vector>

#include "engine/base/index.h"
#include "engine/study/study_kind.h"

/// Reads which errors each block [[analysis.parts]] of a study file joins into parts.
namespace poesy::allocation {

using PartMembers = std::vector<FactorIndex>;  ///< The errors of a part (at least one), which share one tolerance.

using Limbs = std::vector<std::size_t>;  ///< Numbers of limbs, counted from 1 as in study files.

/// Reads a list of at least two different limbs that have errors. Throws InputError at the value if the list is not of
/// this form.
Limbs read_limbs(const StudyValue& value, const ModelDescription& model);

/// Throws InputError at the value if the tolerance of one of these errors cannot be chosen: if the error is measured or
/// correlated, has a mean that is not zero, is drawn together with the other errors of its feature, or is drawn anew at
/// each pose.
void check_distributions(const StudyValue& value, const PartMembers& members, const Study& study);

/// The errors of each part of a block. Without `each = true`, a block is one part. With `each = true`, every error is a
/// part, but corresponding errors of identical limbs form one part. No error is in two parts of the block. Throws
/// InputError for an error that does not exist, that the study does not vary, or that check_distributions() refuses.
std::vector<PartMembers> read_members(const StudySection& block, const Study& study);

/// Whether the block states `each = true`, so that every error is a part unless identical limbs share it.
bool is_each(const StudySection& block);

}  // namespace poesy::allocation
