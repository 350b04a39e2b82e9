#pragma once

#include <span>

#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/model/model.h"
#include "engine/report/html/page.h"
#include "engine/result/result_parts.h"
#include "engine/run/result.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Separates these errors at all poses. sigma: [P] their standard deviations, SI. An effect that is rounding has no
/// shares. Over the poses, an effect that is not finite at one of them has none either. Precondition: the model
/// separates its errors and reaches the poses.
SeparationResult separate_errors(const Model& model, const PoseSet& poses, std::span<const FactorIndex> factors,
                                 std::span<const double> sigma);

/// Writes the group /separation; nothing if the model does not separate its errors.
/// @{
void write_separation(ResultBuilder& result, const std::optional<SeparationResult>& found);
std::optional<SeparationResult> read_separation(const h5::File& file);
/// @}
/// Bytes of the datasets of /separation, in memory and in a file alike.
std::size_t separation_bytes(const AxisLengths& lengths);
/// Adds separation.csv and its tables by pose.
void append_separation_tables(CsvTables& tables, const StoredResult& result);

/// The part of each error's effect that calibration can remove, in this order. Precondition: the result has it.
Table separation_table(const StoredResult& result, const RankedErrors& ranked);
/// Adds the section of a report if the result has a separation.
void add_separation_section(const StoredResult& result, std::span<const Table> tables, Page& page);

}  // namespace poesy
