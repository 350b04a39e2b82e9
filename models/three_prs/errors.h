#pragma once

#include <string>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/sources.h"

namespace poesy::three_prs {

inline constexpr std::size_t kFrames = 8;  ///< number of error sources of a limb; each source has its own frame

/// The 60 errors a_x_1 ... c_z_3 (San et al. 2023, Section 3), limb by limb. The frames of a limb are numbered by error
/// source.
std::vector<Factor> factors();

/// The sets of errors, after San et al. 2023: "all" (the 51 with an effect); "compensable" (30: the paper's 24, with
/// its scalar c as three components) and "non-compensable" (21), Section 4.2; "platform-hinges" (FS in the paper),
/// "initial-position" (T), "revolute-gap" (R), "rod-length" (L), Section 5.2.
std::vector<FactorSet> factor_sets();

/// [60] The class of each error: "compensable", "non-compensable", or empty if it has no effect (San et al. 2023,
/// Section 4.2).
std::vector<std::string> published_classes();

}  // namespace poesy::three_prs
