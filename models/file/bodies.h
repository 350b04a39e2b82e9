#pragma once

#include <optional>
#include <vector>

#include "models/file/numbers.h"

/// Bodies of a mechanism file, and which of them limbs name.
namespace poesy::file {

/// Base, platform and the others with their copies, at home. Throws InputError where two have one name.
std::vector<assembly::Body> bodies_of(const Numbers& numbers, const Transform& platform);

/// The position of the body that a limb names, for its k-th copy; `usual` where it names none. Throws InputError where
/// there is none of that name, or where copies do not go with each other.
std::size_t body_of(const MechanismFile& file, const LimbLines& limb, const std::optional<Reference>& reference,
                    std::size_t usual, std::size_t copy);

/// Throws InputError where limbs and bodies are not as they must be: a limb from the base leads to every body, none
/// ends at the base or where it begins, and no label is there twice.
void check_branches(const MechanismFile& file, const Mechanism& made);

}  // namespace poesy::file
