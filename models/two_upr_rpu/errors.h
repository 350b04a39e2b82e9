#pragma once

#include <vector>

#include "engine/model/model.h"
#include "models/chain/deformation_model.h"

namespace poesy::two_upr_rpu {

/// The 71 geometric errors (Du et al. 2022, Section 3.2). Of the 90 error parameters, 12 are initial joint
/// displacements and 7 are zero by the definition of the frames. The errors are ordered by limb, then by frame, and
/// linear errors precede angular ones.
std::vector<Factor> factors();

/// For each error, in the order of factors(), the component of a frame's error that it changes.
std::vector<chain::ErrorTerms> error_terms();

/// The sets of errors: "all" (71), "deforming" (25: limbs 1 and 3, Section 6.1 of Du et al. 2022), "deforming-all" (41:
/// Table 7), "benign" (30).
std::vector<FactorSet> factor_sets();

}  // namespace poesy::two_upr_rpu
