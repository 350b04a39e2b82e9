#pragma once

#include <vector>

#include "models/file/numbers.h"

/// Stiffness and loads of a mechanism file.
namespace poesy::file {

/// Sets the compliances of the bearings, of the links and of the whole limb. The joints of the limb must be set
/// already. turn: the motion from the first copy of the limb to this one. Throws InputError if a stiffness, a modulus
/// or a dimension of a section is out of range, if a link passes a joint whose axis is not on the link's line, or if a
/// compliance is not symmetric or has a negative eigenvalue.
void add_stiffness(const Numbers& numbers, const LimbLines& lines, const Transform& turn,
                   const std::vector<assembly::Body>& bodies, Limb& limb);

/// The loads of the file that act on the bodies of a mechanism.
assembly::Load load_of(const Numbers& numbers, const Mechanism& made);

}  // namespace poesy::file
