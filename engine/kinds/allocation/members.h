#pragma once

#include <vector>

#include "engine/base/index.h"
#include "engine/study/study_kind.h"

/// Reads which errors each block [[analysis.parts]] of a study file joins into parts.
namespace poesy {

using PartMembers = std::vector<FactorIndex>;  ///< The errors of a part, which share one tolerance; at least one.

using Limbs = std::vector<std::size_t>;  ///< Numbers of limbs, counted from 1 as in study files.

/// Reads a list of limbs: at least two, none twice. Throws InputError at a value that is not a limb of the model.
Limbs read_limbs(const StudyValue& value, const ModelDescription& model);

/// Throws InputError at the value if an error's tolerance cannot be chosen: if the error is measured, correlated, has a
/// stated mean, or is drawn anew at each pose.
void check_distributions(const StudyValue& value, const PartMembers& members, const Study& study);

/// The errors of each part of a block. A block is one part. With the key `each`, every error is a part, but
/// corresponding errors of identical limbs share one. No error is in two parts of the block. Throws InputError for an
/// error that cannot be in a part: unknown, fixed, measured or correlated.
std::vector<PartMembers> read_members(const StudySection& block, const Study& study);

/// Whether the block has the key `each`, with which every error is a part of its own.
bool is_each(const StudySection& block);

}  // namespace poesy
