#include <fmt/format.h>

#include "engine/base/nan.h"
#include "engine/io/export_tables.h"
#include "engine/io/tolerance_files.h"
#include "engine/run/sensitivity.h"

namespace poesy {
namespace {

using Columns = std::vector<std::string>;

/// The lists of tolerances with their names.
std::vector<std::pair<std::string, const std::vector<double>*>> lists(const ResponseTolerances& tolerances) {
  std::vector<std::pair<std::string, const std::vector<double>*>> all{{"equal_effect", &tolerances.all.equal_effect}};
  if (tolerances.limit) {
    all.emplace_back("limit_equal_effect", &tolerances.limit->equal_effect);
    all.emplace_back("limit_equal_tolerance", &tolerances.limit->equal_tolerance);
  }
  return all;
}

/// The columns of append_row. name_of(name, unit, suffix) is what one is called; suffix "_display" for the
/// units people read.
template <class NameOf>
void add_columns(const StoredResult& result, const ResponseTolerances& tolerances, const NameOf& name_of,
                 Columns& columns) {
  const std::string si = units_of(result.factors, kSi);
  const std::string index_unit = result.responses[tolerances.response].unit + " per " + si;
  for (const char* name : {"index", "index_ci_low", "index_ci_high"}) columns.push_back(name_of(name, index_unit, ""));
  columns.emplace_back("mean_square_share");
  columns.emplace_back("index_change");
  for (const auto& [name, values] : lists(tolerances)) columns.push_back(name_of(name, si, ""));
  const std::string display_units = units_of(result.factors, kDisplay);
  for (const auto& [name, values] : lists(tolerances)) columns.push_back(name_of(name, display_units, "_display"));
}

/// The numbers of one error, in the order of add_columns.
void append_row(const StoredResult& result, const ResponseTolerances& tolerances, std::size_t p,
                std::vector<double>& row) {
  const SensitivityResult& found = result.sensitivity;
  const std::size_t at = tolerances.response * found.factors + p;
  row.insert(row.end(),
             {found.global[at], found.global_ci_low[at], found.global_ci_high[at], tolerances.all.mean_square_share[p],
              found.index_change.empty() ? kNaN : found.index_change[at]});
  for (const double scale : {1.0, display(result.factors[p]).si}) {
    for (const auto& [name, values] : lists(tolerances)) row.push_back((*values)[p] / scale);
  }
}

void write_response(TableFolder& folder, const StoredResult& result, const ResponseTolerances& tolerances) {
  Columns columns{"factor", "angular", "limb"};
  const auto name_of = [](const std::string& name, const std::string& unit, const char*) { return column(name, unit); };
  add_columns(result, tolerances, name_of, columns);
  folder.write("tolerances_" + result.responses[tolerances.response].name, columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < result.factors.size(); ++p) {
      const bool angular = dimension_of(result.factors[p].unit) == Dimension::angle;
      std::vector<double> row{angular ? 1.0 : 0.0, static_cast<double>(result.factor_limb[p])};
      append_row(result, tolerances, p, row);
      table.row(result.factors[p].name, row);
    }
  });
}

}  // namespace

bool has_tolerances(const StoredResult& result) {
  return !result.factor_limb.empty() && !result.sensitivity.background.empty();
}

void export_tolerances(TableFolder& folder, const StoredResult& result) {
  if (!has_tolerances(result)) return;
  for (std::size_t r = 0; r < result.tolerance_reference.size(); ++r) {
    const ResponseStudy response = response_study(result.sensitivity, result.factor_sigma, r);
    write_response(folder, result, {r, tolerances(response, result.tolerance_reference[r]), std::nullopt});
  }
}

std::string write_tolerances(const std::string& folder, const StoredResult& result,
                             const ResponseTolerances& tolerances) {
  make_folder(folder);
  TableFolder tables(folder);
  const NamedUnit& response = result.responses[tolerances.response];
  Columns columns{"factor", "kind", "limb", "unit", "display_unit", "index_unit", "studied_as"};
  const auto name_of = [](const std::string& name, const std::string&, const char* suffix) { return name + suffix; };
  add_columns(result, tolerances, name_of, columns);
  tables.write("tolerances", columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < result.factors.size(); ++p) {
      const NamedUnit& factor = result.factors[p];
      std::vector<double> row;
      append_row(result, tolerances, p, row);
      const std::string shape = result.factor_distribution.empty() ? "unknown" : result.factor_distribution[p];
      table.row(
          fmt::format("{},{},{},{},{},{}/{},{}", factor.name, error_kind(dimension_of(factor.unit)),
                      result.factor_limb[p], factor.unit, kDisplay(factor.unit), response.unit, factor.unit, shape),
          row);
    }
  });
  return tables.files().front();
}

}  // namespace poesy
