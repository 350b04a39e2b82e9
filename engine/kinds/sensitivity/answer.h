#pragma once

#include <string>

#include "engine/report/html/page.h"
#include "engine/result/result_file.h"

namespace poesy::sensitivity {

/// Two sentences: which errors cause most of the mean square of the response by which errors are ranked, and how many
/// errors together cause hardly any of it. Empty if an effect is not known, or if no error has an effect.
std::string few_matter_text(const StoredResult& result);

/// A sentence on the pose at which the most important error has its largest effect; empty if the effect hardly differs
/// between poses.
std::string worst_place_text(const StoredResult& result);

/// The summary at the top of the report of a sensitivity result.
Answer sensitivity_answer(const StoredResult& result);

}  // namespace poesy::sensitivity
