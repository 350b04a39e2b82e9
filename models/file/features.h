#pragma once

#include "models/file/mechanism.h"
#include "models/file/numbers.h"

namespace poesy::file {

/// Adds features, and their errors, of a mechanism whose limbs are complete. A feature of the part before joint k
/// displaces frame k - 1, in the axes of that frame; one of the part behind it displaces frame k. If it is displaced by
/// v and turned by e about its middle c, in the axes of its part, the frame's error is [e; v + c x e], to first order.
/// Throws InputError for what is not there, and for sizes that are not positive.
void add_features(const Numbers& numbers, Mechanism& mechanism);

}  // namespace poesy::file
