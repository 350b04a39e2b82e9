#pragma once

#include "engine/kinds/monte_carlo/result.h"
#include "engine/result/csv_table.h"
#include "engine/result/fields.h"
#include "engine/result/result_file.h"

/// Reads and writes main effects, and the additional results of a Monte Carlo study with draws per machine.
namespace poesy::monte_carlo {

/// The sizes in bytes of the numbers of main effects, and of the additional results with draws per machine, if the axes
/// have these lengths.
/// @{
std::size_t effect_bytes(const AxisLengths& lengths);
std::size_t machine_bytes(const AxisLengths& lengths);
/// @}

/// Adds the first-order indices and the group /monte_carlo/main_effect to the result file. Precondition: the file has
/// the group /monte_carlo.
void write_effects(ResultBuilder& result, const EffectResult& found);
/// Reads what write_effects() wrote. Throws h5::Error.
EffectResult read_effects(const h5::File& file);
/// Adds to `tables` S1.csv and the tables of main-effect curves.
void append_effect_tables(CsvTables& tables, const StoredResult& result);

/// Adds to the result file the groups /machines and /yield. Precondition: the file has the axes of the Monte Carlo
/// study and of the main effects.
void write_machines(ResultBuilder& result, const MachineResult& found);

/// Reads what write_machines() wrote; none if errors were drawn per pose. Throws h5::Error.
std::optional<MachineResult> read_machines(const h5::File& file);

/// Adds to `tables` yield.csv and the other tables of machines.
void append_machine_tables(CsvTables& tables, const StoredResult& result);

}  // namespace poesy::monte_carlo
