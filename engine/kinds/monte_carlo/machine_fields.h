#pragma once

#include "engine/kinds/monte_carlo/result.h"
#include "engine/result/csv_table.h"
#include "engine/result/fields.h"
#include "engine/result/result_file.h"

/// Reads and writes main effects, and what a Monte Carlo study with draws per machine finds in addition.
namespace poesy {

/// Bytes of the numbers of main effects and of studies with draws per machine, along axes of these lengths.
/// @{
std::size_t effect_bytes(const AxisLengths& lengths);
std::size_t machine_bytes(const AxisLengths& lengths);
/// @}

/// Adds first-order indices and the group /monte_carlo/main_effect. Precondition: the file has /monte_carlo.
void write_effects(ResultBuilder& result, const EffectResult& found);
/// Reads what write_effects() wrote. Throws h5::Error.
EffectResult read_effects(const h5::File& file);
/// Adds S1.csv and the curves.
void append_effect_tables(CsvTables& tables, const StoredResult& result);

/// Adds the groups /machines and /yield. Precondition: the file has the axes of the Monte Carlo study and of the
/// effects.
void write_machines(ResultBuilder& result, const MachineResult& found);

/// Reads what write_machines() wrote; empty if errors were drawn per pose. Throws h5::Error.
std::optional<MachineResult> read_machines(const h5::File& file);

/// Adds yield.csv and the other tables of machines.
void append_machine_tables(CsvTables& tables, const StoredResult& result);

}  // namespace poesy
