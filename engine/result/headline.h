#pragma once

#include "engine/result/result_file.h"

namespace poesy {

/// Orders the responses of the headline, and adds those responses with limits that it lacks. Responses with limits come
/// first, the ones most often missed before the others. Then follow the displacement of the tool, that of the platform,
/// and the remaining responses. Otherwise the order stays. Precondition: the limits have been read.
void order_headline(StoredResult& result);

}  // namespace poesy
