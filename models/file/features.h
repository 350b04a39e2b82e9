#pragma once

#include "models/file/mechanism.h"
#include "models/file/numbers.h"

namespace poesy::file {

/// Adds features and their errors to a mechanism whose limbs are complete. Joints count from 1, frames from 0. A
/// feature of the part before joint k displaces frame k - 1; a feature of the part behind joint k displaces frame k. If
/// the feature moves by v and rotates by e about its middle c, all in the frame of its part, the frame's error is to
/// first order [e; v + c x e]. If the part is behind a joint but not the last body of the limb, the frame's error is
/// minus that. Throws InputError if a feature refers to something that does not exist, and for sizes that are not
/// positive.
void add_features(const Numbers& numbers, Mechanism& mechanism);

}  // namespace poesy::file
