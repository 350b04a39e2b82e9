#pragma once

#include "models/file/mechanism.h"
#include "models/file/numbers.h"

namespace poesy::file {

/// Adds features and their errors to a mechanism whose limbs are complete. Joints count from 1, frames from 0. A
/// feature of the part before joint k displaces frame k - 1; a feature of the part behind joint k displaces frame k. If
/// the feature moves by v and rotates by e about its middle c, in the axes of its part, the frame's error is [e; v + c
/// x e], to first order. Throws InputError if a feature refers to something that does not exist, and for sizes that are
/// not positive.
void add_features(const Numbers& numbers, Mechanism& mechanism);

}  // namespace poesy::file
