#pragma once

#include <string>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/sources.h"

namespace poesy::three_prs {

inline constexpr std::size_t kFrames = 8;  ///< sources of a limb, each a frame of its own

/// The 60 error sources a_x_1 ... c_z_3 (San et al. 2023, Section 3), limb by limb; frame counts the sources.
std::vector<Factor> factors();

/// all (the 51 that have an effect); compensable (30: the paper's 24, with its scalar c as three components) and
/// non-compensable (21), Section 4.2; platform-hinges (FS), initial-position (T), revolute-gap (R), rod-length (L),
/// Section 5.2.
std::vector<FactorSet> factor_sets();

/// "compensable", "non-compensable", or empty without effect (Section 4.2), [60].
std::vector<std::string> published_classes();

}  // namespace poesy::three_prs
