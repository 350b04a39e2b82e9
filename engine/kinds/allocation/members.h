#pragma once

#include <vector>

#include "engine/base/index.h"
#include "engine/study/study_kind.h"

/// Whose tolerance a part is: the errors of a block [[analysis.parts]].
namespace poesy {

using PartMembers = std::vector<FactorIndex>;  ///< Errors that share one tolerance, at least one.

/// The errors of one block, in parts: one part, or with `each` one for each error, where errors of identical limbs
/// share theirs. Throws InputError at its place for errors that cannot be a part's: unknown ones, such as do not vary,
/// and those whose distribution is measured or correlated. An error is in one part of the block.
std::vector<PartMembers> read_members(const StudySection& block, const Study& study);

/// Whether every error of the block is a part of its own.
bool is_each(const StudySection& block);

}  // namespace poesy
