#include <algorithm>

#include "engine/kinds/identification/identification.h"
#include "engine/kinds/identification/kind.h"
#include "engine/result/result_parts.h"

namespace poesy::identification {
namespace {

using Identification = Result;

const Group<Identification> kIdentification{
    "/identification",
    "Which errors deform the mechanism (Du et al. 2022, Section 5.1)",
    {{"rounding", &Identification::rounding}},
    {{"pose", &Identification::poses}},
    {{"single", &Identification::single, "1", "1: deforms alone, in any group (Table 6)"},
     {"coupled", &Identification::coupled, "1",
      "1: deforms alone or as named member of a coupling, in any group (Table 7)"},
     {"single_by_group", &Identification::single_by_group, "1", "single, for each group"},
     {"coupled_by_group", &Identification::coupled_by_group, "1", "coupled, for each group"},
     {"single_below", &Identification::single_below, "1",
      "Poses where the error alone gives no more than rounding; with required_poses of them it is harmless"},
     {"single_max", &Identification::single_max, "SI: unit of the measure of deformation",
      "Largest deformation by the error alone; NaN where not solved"},
     {"not_solved", &Identification::not_solved, "1",
      "Poses without a solution for the error alone; they count as deformed"},
     {"coupled_below", &Identification::coupled_below, "1",
      "Poses where the errors tried together in its frame give no more than rounding; 0 if it was not"},
     {"coupled_reduced", &Identification::coupled_reduced, "1",
      "Poses where setting it to zero takes nine tenths of its frame's deformation away"}}};

const Fields<ErrorSize> kSizeFields{
    {"group_linear", &ErrorSize::linear, {"group"}, "m", "Size of the group's linear errors"},
    {"group_angular", &ErrorSize::angular, {"group"}, "rad", "Size of the group's angular errors"}};

const Fields<Coupling> kCouplingFields{
    {"coupling_group", &Coupling::group, {"coupling"}, "1", "Group, by its position from 0"},
    {"coupling_first", &Coupling::first, {"coupling"}, "1", "One error, by its position from 0"},
    {"coupling_second", &Coupling::second, {"coupling"}, "1", "The other, by its position from 0"},
    {"coupling_poses", &Coupling::deforming_poses, {"coupling"}, "1", "Poses where the two deform together"}};

bool by_group(const FieldRow<Identification>& field) { return field.name.ends_with("_by_group"); }

/// Appends to the table a column for each pair of sizes (group), from a field with the axes group and factor.
void append_group_columns(CsvTable& table, const StoredResult& result, const std::string& prefix,
                          const FieldRow<Identification>& field) {
  for (std::size_t g = 0; g < identification_of(result).groups(); ++g) {
    const std::string heading = prefix + "group_" + std::to_string(g + 1);
    table.columns.push_back(field_row_column(heading, field, identification_of(result), g));
  }
}

CsvTable verdict_table(const StoredResult& result) {
  CsvTable table = lines_of_factors(result, "identification");
  for (const FieldRow<Identification>& field : kIdentification.fields) {
    if (field.axes == kByFactor) {
      table.columns.push_back(field_column(field.name, field, identification_of(result)));
    } else if (by_group(field)) {
      append_group_columns(table, result, field.name.substr(0, field.name.find('_')) + "_", field);
    }
  }
  return table;
}

CsvTable coupling_table(const StoredResult& result) {
  const std::vector<Coupling>& couplings = identification_of(result).couplings;
  const auto names = [&](std::size_t line) {
    return result.factors[couplings[line].first].name + "+" + result.factors[couplings[line].second].name;
  };
  return {"couplings",
          {"coupling", names},
          couplings.size(),
          {list_column("group", couplings, [](const Coupling& coupling) { return coupling.group + 1; }),
           list_column("first_factor", couplings, &Coupling::first),
           list_column("second_factor", couplings, &Coupling::second),
           list_column("poses", couplings, &Coupling::deforming_poses)}};
}

void write(ResultBuilder& result, const Study& study, std::any& any) {
  const auto& found = std::any_cast<const Identification&>(any);
  POESY_EXPECTS(found.factors() == study.analysis.factors.size());
  add_names(result, study, study.analysis.factors);
  const std::vector<std::string> statuses = listed_statuses(found.solves);
  result.add_axis("status", statuses, {"1", "How a solve ended"});
  result.add_axis("group", texts(found.sizes, &ErrorSize::name), {"1", "Name of the group of sizes"});
  result.add_axis("coupling", axis_numbers(found.couplings.size()), {"1", "Number of the coupling, from 0"});
  write_group(result, kIdentification, found);
  result.file().set_attribute("/identification", "required_poses", static_cast<std::int64_t>(found.required_poses));
  write_columns(result, "/identification", kSizeFields, found.sizes);
  write_columns(result, "/identification", kCouplingFields, found.couplings);
  const auto by_all = std::span(found.solves.by_status).first(statuses.size());
  const std::vector<std::uint64_t> by_status(by_all.begin(), by_all.end());
  result.add("/identification/solves_by_status", {"status"}, by_status, {"1", "Solves of both stages that ended so"});
  result.show_axes("/identification", {"coupling", "status"});
}

void read(const h5::File& file, StoredResult& result) {
  Identification found;
  read_group(file, kIdentification, found);
  found.required_poses =
      static_cast<std::uint64_t>(file.attribute<std::int64_t>("/identification", "required_poses").at(0));
  found.sizes = read_columns(file, "/identification", kSizeFields);
  const auto names = file.read<std::string>("/group");
  for (std::size_t g = 0; g < names.size(); ++g) found.sizes[g].name = names[g];
  found.couplings = read_columns(file, "/identification", kCouplingFields);
  for (const Coupling& coupling : found.couplings) {
    if (coupling.group >= found.groups() || coupling.first >= found.factors() || coupling.second >= found.factors()) {
      throw h5::Error("/identification/coupling_* name an unknown group or error");
    }
  }
  const auto by_status = read_along<std::uint64_t>(file, "/identification/solves_by_status", {"status"});
  if (by_status.size() != listed_statuses(file)) throw h5::Error("/status lists other endings of solves");
  std::ranges::copy(by_status, found.solves.by_status.begin());
  result.found = std::move(found);
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  const std::vector<ErrorSize>& sizes = identification_of(result).sizes;
  tables.push_back({"groups",
                    {"group", [&sizes](std::size_t g) { return sizes[g].name; }},
                    sizes.size(),
                    {list_column("linear [m]", sizes, &ErrorSize::linear),
                     list_column("angular [rad]", sizes, &ErrorSize::angular)}});
  tables.push_back(verdict_table(result));
  for (const FieldRow<Identification>& field : kIdentification.fields) {
    if (field.axes == kByFactor || by_group(field)) continue;
    CsvTable table = lines_of_factors(result, field.name);
    append_group_columns(table, result, "", field);
    tables.push_back(std::move(table));
  }
  tables.push_back(coupling_table(result));
}

}  // namespace

constinit const FileKind kFile{.write = write, .read = read, .append_tables = append_tables};

}  // namespace poesy::identification
