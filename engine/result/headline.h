#pragma once

#include "engine/result/result_file.h"

namespace poesy {

/// Orders the headline by what a study is about, and adds the responses with limits that it does not have: first the
/// responses with limits, the one whose limit is missed most often before the others; then the displacement of the
/// tool, that of the platform, and the rest. Equal ones keep their order. Precondition: the limits are read.
void order_headline(StoredResult& result);

}  // namespace poesy
