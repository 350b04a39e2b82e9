#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/kinds/allocation/result.h"
#include "engine/report/display.h"
#include "engine/result/csv_table.h"

/// The zones of a drawing in tables and files, as a workshop reads them. Preconditions: Result::has_zones();
/// the result outlives the columns and tables that refer to it.
namespace poesy::allocation {

/// Columns for feature, symbol, zone, datums and length of each part. A part that is not a zone has only its name and
/// T.
std::vector<FilledColumn> zone_columns(const Result& found);

/// Columns for the share of features inside their zone, and for remarks.
std::vector<FilledColumn> inside_columns(const Result& found);

/// The parts that the drawing states, each orientation directly after its location. Orientations that the drawing does
/// not need are left out.
std::vector<std::size_t> drawn_parts(const Result& found, const std::vector<std::size_t>& order);

/// A note in words: how many standard deviations half a zone is, what the column `inside` shows, and how zones are
/// rounded.
std::string zones_note(const Result& found);

/// The table drawing.csv, with a line for each zone or tolerance of the drawing.
CsvTable drawing_csv(const Result& found);

}  // namespace poesy::allocation
