#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/kinds/allocation/result.h"
#include "engine/report/display.h"
#include "engine/result/csv_table.h"

/// The zones of a drawing in tables and files, as a workshop reads them. Preconditions: AllocationResult::has_zones();
/// the result outlives what refers to it.
namespace poesy {

/// Feature, symbol, zone, datums and length of each part; of a part that is not a zone its name and T.
std::vector<FilledColumn> zone_columns(const AllocationResult& found);

/// The share of features inside their zone, and what else a drawing says.
std::vector<FilledColumn> inside_columns(const AllocationResult& found);

/// The parts of the drawing without the orientations that it does not need, each orientation behind its location.
std::vector<std::size_t> drawn_parts(const AllocationResult& found, const std::vector<std::size_t>& order);

/// How much of a zone is used: "half a zone: 3 standard deviations of a coordinate of an extreme point".
std::string zones_note(const AllocationResult& found);

/// drawing.csv: a line for each zone or tolerance of the drawing.
CsvTable drawing_csv(const AllocationResult& found);

}  // namespace poesy
