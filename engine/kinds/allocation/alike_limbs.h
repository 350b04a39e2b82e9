#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "engine/study/study.h"

/// Functions for the key identical_limbs. They compare the joints of limbs, because limbs with different joints are
/// probably not identical.
namespace poesy::allocation {

/// A line of a study template, commented out, that shows the key identical_limbs with two limbs as an example: the
/// first two limbs that have errors and the same joints. Empty if there are no such limbs.
std::string shown_identical_limbs(const Study& study);

/// A warning that these limbs do not all have the same joints. Empty if all have the same joints, or if the mechanism
/// has no joints to compare. limbs: numbers, counted from 1.
std::string unlike_limbs_text(std::span<const std::size_t> limbs, const Study& study);

}  // namespace poesy::allocation
