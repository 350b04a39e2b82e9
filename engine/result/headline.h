#pragma once

#include "engine/result/result_file.h"

namespace poesy {

/// Orders the headline, the responses that a summary shows, and adds the responses with limits that are not in it.
/// Responses with limits come first, the ones most often missed before the others. They are followed by the
/// displacement of the tool, the displacement of the platform, and the remaining responses. Apart from this, the order
/// stays. Precondition: the limits have been read.
void order_headline(StoredResult& result);

}  // namespace poesy
