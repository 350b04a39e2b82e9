#pragma once

#include <span>

#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/model/model.h"
#include "engine/report/html/page.h"
#include "engine/result/result_parts.h"
#include "engine/run/result.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy::sensitivity {

/// Separates the effects of errors at all poses (SeparationResult). sigma: [errors] standard deviations of these
/// errors, SI. The shares of an error are NaN if its effect is rounding. The shares over all poses are NaN if its
/// effect is not finite at some pose. Precondition: the model separates its errors and reaches the poses.
SeparationResult separate_errors(const Model& model, const PoseSet& poses, std::span<const FactorIndex> factors,
                                 std::span<const double> sigma);

/// Writes and reads the group /separation. Writes nothing if the model does not separate its errors.
/// @{
void write_separation(ResultBuilder& result, const std::optional<SeparationResult>& found);
std::optional<SeparationResult> read_separation(const h5::File& file);
/// @}
/// The size in bytes of the datasets of /separation, which is the same in memory and in a file.
std::size_t separation_bytes(const AxisLengths& lengths);
/// Adds to `tables` separation.csv and the tables that show the separation at each pose.
void append_separation_tables(CsvTables& tables, const StoredResult& result);

/// The table of the part of each error's effect that calibration can remove, in the order of `ranked`. Precondition:
/// the result has a separation.
Table separation_table(const StoredResult& result, const RankedErrors& ranked);
/// Adds to the page the section on separation, if the result has one.
void add_separation_section(const StoredResult& result, std::span<const Table> tables, Page& page);

}  // namespace poesy::sensitivity
