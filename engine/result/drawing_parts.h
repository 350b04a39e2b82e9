#pragma once

#include <string>
#include <vector>

#include "engine/result/csv_table.h"
#include "engine/result/drawing_result.h"
#include "engine/result/fields.h"

namespace poesy {

/// Adds /drawing. Precondition: the axes of responses and poses were added.
void write_drawing(ResultBuilder& result, const DrawingResult& found);
/// Reads /drawing. Precondition: it exists.
DrawingResult read_drawing(const h5::File& file);
/// Adds features.csv, with a line for each feature and response. Refers to both arguments.
void append_drawing_tables(CsvTables& tables, const std::vector<std::string>& responses, const DrawingResult& found);

}  // namespace poesy
