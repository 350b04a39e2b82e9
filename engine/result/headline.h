#pragma once

#include "engine/result/result_file.h"

namespace poesy {

/// Orders StoredResult::headline (the responses that a summary shows), and adds to it the responses with limits that it
/// lacks. Responses with limits come first, those whose limit is missed most often before the others. Then come the
/// displacement of the tool, the displacement of the platform, and the remaining responses in their order so far.
/// Precondition: StoredResult::verdicts is set, if the study has limits.
void order_headline(StoredResult& result);

}  // namespace poesy
