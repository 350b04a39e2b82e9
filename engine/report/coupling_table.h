#pragma once

#include <string>

#include "engine/io/result_file.h"

namespace poesy {

/// Of a coupling result, for each size and each response that a summary shows: a table with a row for each subset of
/// the sources. Columns: the largest |effect| over the poses and the pose where it is, the largest root sum square,
/// worst case and |interaction|, and where sources oppose each other: at which share of the poses, and the pose where
/// they cancel most, with the cancellation there.
std::string coupling_table(const StoredResult& result);

}  // namespace poesy
