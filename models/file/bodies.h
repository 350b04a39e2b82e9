#pragma once

#include <optional>
#include <vector>

#include "models/file/numbers.h"

/// The bodies of a mechanism file, and the bodies that limbs name.
namespace poesy::file {

/// Base, platform and the other bodies with their copies, at home. Throws InputError if two have the same name.
std::vector<assembly::Body> bodies_of(const Numbers& numbers, const Transform& platform);

/// The position of the body that a limb names, for the limb's k-th copy; `usual` if it names none. Throws InputError if
/// no body has that name, or if the copies of limb and body do not match.
std::size_t body_of(const MechanismFile& file, const LimbLines& limb, const std::optional<Reference>& reference,
                    std::size_t usual, std::size_t copy);

/// Throws InputError unless limbs from the base lead to every body, no limb ends at the base or where it begins, and
/// all labels differ.
void check_branches(const MechanismFile& file, const Mechanism& made);

}  // namespace poesy::file
