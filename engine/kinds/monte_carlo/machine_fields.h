#pragma once

#include "engine/files/csv_table.h"
#include "engine/files/fields.h"
#include "engine/files/result_file.h"
#include "engine/kinds/monte_carlo/result.h"

/// How files keep what a Monte Carlo study of machines found in addition.
namespace poesy {

/// Adds the groups /machines, /yield and /monte_carlo/main_effect, and first-order indices beside them. Precondition:
/// the axes of the Monte Carlo study are there.
void write_machines(ResultBuilder& result, const MachineResult& found);

/// The opposite; empty where errors were drawn per pose. Throws h5::Error.
std::optional<MachineResult> read_machines(const h5::File& file);

/// Appends yield.csv and its like.
void append_machine_tables(CsvTables& tables, const StoredResult& result);

}  // namespace poesy
