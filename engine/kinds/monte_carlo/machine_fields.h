#pragma once

#include "engine/kinds/monte_carlo/result.h"
#include "engine/result/csv_table.h"
#include "engine/result/fields.h"
#include "engine/result/result_file.h"

/// How files keep what the bins of errors say, and what a Monte Carlo study of machines found in addition.
namespace poesy {

/// Bytes of the numbers of effects, and of what studies of machines find in addition, along axes of these lengths.
/// @{
std::size_t effect_bytes(const AxisLengths& lengths);
std::size_t machine_bytes(const AxisLengths& lengths);
/// @}

/// Adds first-order indices and the group /monte_carlo/main_effect. Precondition: /monte_carlo is there.
void write_effects(ResultBuilder& result, const EffectResult& found);
/// The opposite. Throws h5::Error.
EffectResult read_effects(const h5::File& file);
/// Appends S1.csv and the curves.
void append_effect_tables(CsvTables& tables, const StoredResult& result);

/// Adds the groups /machines and /yield. Precondition: the axes of the Monte Carlo study and of the effects are there.
void write_machines(ResultBuilder& result, const MachineResult& found);

/// The opposite; empty where errors were drawn per pose. Throws h5::Error.
std::optional<MachineResult> read_machines(const h5::File& file);

/// Appends yield.csv and its like.
void append_machine_tables(CsvTables& tables, const StoredResult& result);

}  // namespace poesy
