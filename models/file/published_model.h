#pragma once

#include <memory>

#include "models/chain/block_solver.h"
#include "models/file/rounding.h"
#include "models/file/tracked_model.h"

namespace poesy::file {

/// The model of an over-constrained mechanism of limbs between base and platform according to the published rule (Du et
/// al. 2022). This rule compares the limbs in pairs, in radians and metres at the base's origin.
std::unique_ptr<TrackedModel> published_model(const MechanismFile& file, Checked found, chain::Fidelity fidelity);

}  // namespace poesy::file
