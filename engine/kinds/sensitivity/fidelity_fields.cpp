#include <array>

#include "engine/files/result_parts.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/sensitivity/stored.h"

namespace poesy {
namespace {

using Fidelity = FidelityResult;

const Group<Fidelity> kFidelity{
    "/fidelity",
    "The model's second fidelity on the same draws, compared with the first, of which all other groups speak",
    {{"linearity", &Fidelity::linearity}},
    {},
    {{"global", &Fidelity::global, kByResponseFactor, kIndexUnit, "Global index by the second fidelity"},
     {"discrepancy", &Fidelity::discrepancy, kByResponseFactor, kIndexUnit,
      "Global index by the second fidelity - global index by the first (/sensitivity/global)"},
     {"relative_discrepancy", &Fidelity::relative_discrepancy, kByResponseFactor, "1",
      "discrepancy over the error's effect: its largest global index by the first fidelity on any response of the same "
      "dimension; infinity where only the second fidelity has an effect, NaN where neither has"},
     {"nonlinearity", &Fidelity::nonlinearity, kByResponseFactor, "1",
      "Root mean square over the poses of hypot(change of the mean over the background, change of the standard "
      "deviation) / sigma(error), over the error's effect as in relative_discrepancy"},
     {"linear", &Fidelity::linear, kByFactor, "1",
      "1: for errors of the study's size no response's nonlinearity or relative discrepancy is above the attribute "
      "linearity of /fidelity; 0: one is, or the comparison is incomplete"},
     {"not_converged", &Fidelity::not_converged, kByFactorPose, "1",
      "Samples that the second fidelity did not solve"}}};

/// What a measure is called in CSV: the index by the name of its fidelity.
std::string csv_name(const FieldRow<Fidelity>& field, const StoredSensitivity& first) {
  return field.name == "global" ? first.fidelities[1] : field.name;
}

}  // namespace

void add_fidelity(ResultBuilder& result, const Study& study, const std::optional<FidelityResult>& found) {
  if (!found) return;
  write_group(result, kFidelity, *found);
  const MechanismChoice& choice = study.mechanism;
  const std::array names{study.model().fidelities[choice.fidelity], study.model().fidelities[choice.compared.value()]};
  result.file().set_attribute("/fidelity", "fidelities", std::span<const std::string>(names));
}

void read_fidelity(const h5::File& file, StoredSensitivity& found) {
  if (!file.exists("/fidelity")) return;
  found.fidelities = file.attribute<std::string>("/fidelity", "fidelities");
  if (found.fidelities.size() != 2) throw h5::Error("it does not compare two fidelities");
  read_group(file, kFidelity, found.fidelity.emplace());
}

void append_fidelity_tables(CsvTables& tables, const StoredResult& result) {
  const StoredSensitivity& first = sensitivity_of(result);
  if (!first.fidelity) return;
  const Fidelity& found = *first.fidelity;
  CsvTable table = lines_of_factors(result, "fidelity");
  table.columns.push_back(list_column("linear", found.linear));
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    const std::size_t begin = r * first.factors;
    const std::string index_unit = csv_unit(kIndexUnit, result, &response);
    table.columns.push_back(
        list_column(with_unit(response.name + "_" + first.fidelities[0], index_unit), first.global, begin));
    for (const FieldRow<Fidelity>& field : kFidelity.fields) {
      if (field.axes != kByResponseFactor) continue;
      const std::string heading =
          with_unit(response.name + "_" + csv_name(field, first), csv_unit(field.unit, result, &response));
      table.columns.push_back(field_column(heading, field, found, begin));
    }
  }
  tables.push_back(std::move(table));
  for (const FieldRow<Fidelity>& field : kFidelity.fields) {
    if (field.axes == kByFactorPose) tables.push_back(cell_table(result, "fidelity_" + field.name, field, found));
  }
}

}  // namespace poesy
