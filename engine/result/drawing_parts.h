#pragma once

#include <string>
#include <vector>

#include "engine/result/csv_table.h"
#include "engine/result/drawing_result.h"
#include "engine/result/fields.h"

namespace poesy {

/// Adds to the result file the group /drawing. Precondition: the axes of responses and poses were added.
void write_drawing(ResultBuilder& result, const DrawingResult& found);
/// Reads the group /drawing. Precondition: the file has it.
DrawingResult read_drawing(const h5::File& file);
/// Adds to `tables` the table features.csv, with a line for each feature and response. The table keeps references to
/// `responses` and `found`.
void append_drawing_tables(CsvTables& tables, const std::vector<std::string>& responses, const DrawingResult& found);

}  // namespace poesy
