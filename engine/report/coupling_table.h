#pragma once

#include <vector>

#include "engine/io/result_file.h"
#include "engine/report/table.h"

namespace poesy {

/// Of a coupling result, for each size and each response that a summary shows: a table with a row for each subset of
/// the sources. Columns: the largest |effect| over the poses and the pose where it is, by number and coordinates, the
/// largest root sum square, worst case and |interaction|, and where sources oppose each other: at which share of the
/// poses, and the pose where they cancel most, with the cancellation there. What the words mean stands below the last
/// one.
std::vector<Table> coupling_tables(const StoredResult& result);

}  // namespace poesy
