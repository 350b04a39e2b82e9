#pragma once

#include <cstddef>
#include <vector>

namespace poesy {

/// The numbers of samples at a pose at which a study with adaptive samples decides what goes on, ascending: `min`
/// rounded up to whole units (Plan::kUnitSamples), then each 1.5 times the last, rounded up likewise, as far as they
/// are below `max`. A larger max only adds to the list. At max itself nothing is left to decide. Empty where the first
/// is not below max.
std::vector<std::size_t> milestones(std::size_t min, std::size_t max);

}  // namespace poesy
