#pragma once

#include <optional>
#include <vector>

#include "models/file/numbers.h"

/// The bodies of a mechanism file, and the search for the body to which a limb or a load refers.
namespace poesy::file {

/// The base, the platform and the other bodies at home, including copies (BodyLines::copies). platform: base_T_platform
/// at home. Throws InputError if two bodies have the same name.
std::vector<assembly::Body> bodies_of(const Numbers& numbers, const Transform& platform);

/// The index of the body that `reference` names; `usual` if there is no reference. If the body has copies, copy k of
/// the limb refers to copy k of the body (k: `copy`, from 0). Throws InputError if no body has that name, or if limb
/// and body have different copies.
std::size_t body_of(const MechanismFile& file, const LimbLines& limb, const std::optional<Reference>& reference,
                    std::size_t usual, std::size_t copy);

/// Checks how limbs connect the bodies. Throws InputError if limbs from the base do not lead to every body, if two
/// limbs have the same label, or if a limb ends at the base or at the body at which it begins.
void check_branches(const MechanismFile& file, const Mechanism& made);

}  // namespace poesy::file
