#include "engine/io/export_tables.h"

namespace poesy {
namespace {

void write_groups(TableFolder& folder, const StoredResult& result) {
  folder.write("groups", {"group", "linear [m]", "angular [rad]"}, [&](CsvTable& table) {
    for (const ErrorSize& group : result.groups) table.row(group.name, std::vector{group.linear, group.angular});
  });
}

/// A column for each group.
void add_group_columns(const StoredResult& result, const std::string& prefix, std::vector<std::string>& columns) {
  for (std::size_t g = 0; g < result.groups.size(); ++g) columns.push_back(prefix + "group_" + std::to_string(g + 1));
}

void write_verdicts(TableFolder& folder, const StoredResult& result) {
  const IdentificationResult& found = result.identification;
  std::vector<std::string> columns{"factor", "single", "coupled"};
  add_group_columns(result, "single_", columns);
  add_group_columns(result, "coupled_", columns);
  folder.write("identification", columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < found.factors; ++p) {
      std::vector<double> row{static_cast<double>(found.single[p]), static_cast<double>(found.coupled[p])};
      for (const auto* verdicts : {&found.single_by_group, &found.coupled_by_group}) {
        for (std::size_t g = 0; g < found.groups; ++g) row.push_back((*verdicts)[g * found.factors + p]);
      }
      table.row(result.factors[p].name, row);
    }
  });
}

template <class T>
void write_by_group(TableFolder& folder, const StoredResult& result, const std::string& name,
                    const std::vector<T>& values) {
  std::vector<std::string> columns{"factor"};
  add_group_columns(result, "", columns);
  folder.write(name, columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < result.factors.size(); ++p) {
      std::vector<double> row;
      for (std::size_t g = 0; g < result.groups.size(); ++g) {
        row.push_back(static_cast<double>(values[g * result.factors.size() + p]));
      }
      table.row(result.factors[p].name, row);
    }
  });
}

void write_couplings(TableFolder& folder, const StoredResult& result) {
  folder.write("couplings", {"coupling", "group", "first_factor", "second_factor", "poses"}, [&](CsvTable& table) {
    for (const Coupling& coupling : result.identification.couplings) {
      table.row(result.factors[coupling.first].name + "+" + result.factors[coupling.second].name,
                std::vector{static_cast<double>(coupling.group + 1), static_cast<double>(coupling.first),
                            static_cast<double>(coupling.second), static_cast<double>(coupling.deforming_poses)});
    }
  });
}

}  // namespace

void export_identification(TableFolder& folder, const StoredResult& result) {
  const IdentificationResult& found = result.identification;
  write_groups(folder, result);
  write_verdicts(folder, result);
  write_by_group(folder, result, "single_below", found.single_below);
  write_by_group(folder, result, "single_max", found.single_max);
  write_by_group(folder, result, "not_solved", found.not_solved);
  write_by_group(folder, result, "coupled_below", found.coupled_below);
  write_by_group(folder, result, "coupled_reduced", found.coupled_reduced);
  write_couplings(folder, result);
}

}  // namespace poesy
