#include <any>
#include <string>
#include <utility>

#include "engine/kinds/sweep/kind.h"
#include "engine/kinds/sweep/result.h"
#include "engine/result/csv_table.h"
#include "engine/result/result_parts.h"

namespace poesy::sweep {
namespace {

constexpr const char* kQuantityUnit = "unit of the quantity, see /sweep/quantity_unit";

const Group<Result> kSweep{
    "/sweep",
    "Designs that differ in the values of some keys, by their figures of merit",
    {},
    {},
    {{"kind", &Result::kind, "1", "Kind of the studies"},
     {"response", &Result::response, "1", "Response of totals"},
     {"value", &Result::value, "1", "Values of the keys"},
     {"number", &Result::number, "see /sweep/unit", "Their numbers; NaN for a text"},
     {"unit", &Result::unit, "1", "Units of these numbers"},
     {"content_sha256", &Result::content_sha256, "1", "content_sha256 of the result of the design's own run"},
     {"verdict", &Result::verdict, "1", "Whether the limits are kept: kept, not kept, undecided, or none"},
     {"left_out", &Result::left_out, "1",
      "Share of the poses of the workspace that the design leaves out, because they are not feasible; NaN for an "
      "unknown part of a boundary",
      Presence::where_computed},
     {"has_first_poses", &Result::has_first_poses, "1", "1: the design has the poses of the first one",
      Presence::where_computed},
     {"quantity_unit", &Result::quantity_unit, "1", "Units of the figures of merit"},
     {"most_is_best", &Result::most_is_best, "1", "1: a larger value is better"},
     {"is_paired", &Result::is_paired, "1", "1: intervals of changes are of the same machines in both designs"},
     {"merit", &Result::merit, kQuantityUnit, "Figures of merit"},
     {"low", &Result::low, kQuantityUnit, "Lower ends of their intervals"},
     {"high", &Result::high, kQuantityUnit, "Upper ends of their intervals"},
     {"change", &Result::change, kQuantityUnit, "Figures of merit less those of the first design"},
     {"change_low", &Result::change_low, kQuantityUnit, "Lower ends of the intervals of changes"},
     {"change_high", &Result::change_high, kQuantityUnit, "Upper ends of the intervals of changes"},
     {"from_best", &Result::from_best, kQuantityUnit, "Figures of merit less those of the best design"},
     {"from_best_low", &Result::from_best_low, kQuantityUnit, "Lower ends of the intervals of changes from the best"},
     {"from_best_high", &Result::from_best_high, kQuantityUnit, "Upper ends of the intervals of changes from the best"},
     {"gained", &Result::gained, "1", "Machines that are good in this design and rejected in the first",
      Presence::where_computed},
     {"lost", &Result::lost, "1", "Machines that are rejected in this design and good in the first",
      Presence::where_computed},
     {"machines", &Result::machines, "1", "Machines of the design", Presence::where_computed},
     {"conf_level", &Result::conf_level, "1", "Level of the intervals"}}};

void write(ResultBuilder& result, const Study& study, std::any& any) {
  const auto& found = std::any_cast<const Result&>(any);
  add_names(result, study, study.analysis.factors);
  result.add_axis("design", axis_numbers(found.designs()), {"1", "Number of the design, from 0"});
  result.add_axis("key", found.keys, {"1", "Key that differs between designs"});
  result.add_axis("quantity", found.quantities, {"1", "Figure of merit"});
  write_group(result, kSweep, found);
  add_solver(result, {"design"}, found.solves);
}

void read(const h5::File& file, StoredResult& result) {
  Result found;
  read_group(file, kSweep, found);
  found.keys = file.read<std::string>("/key");
  found.quantities = file.read<std::string>("/quantity");
  check_names(found.keys, "/key");
  check_names(found.quantities, "/quantity");
  found.solves = read_solver(file, {"design"});
  if (found.designs() == 0 || found.keys.empty() || found.quantities.empty()) {
    throw h5::Error("/sweep has no designs, keys or quantities");
  }
  result.found = std::move(found);
}

void append_tables(CsvTables& tables, const StoredResult& result) {
  const Result& found = sweep_of(result);
  CsvTable table{"sweep", {"design", [&](std::size_t d) { return design_name(found, d); }}, found.designs()};
  for (std::size_t k = 0; k < found.keys.size(); ++k) {
    table.columns.push_back({with_unit(found.keys[k], found.unit(k)),
                             [&found, k](std::size_t d) { return to_number(found.number(d, k)); }});
  }
  for (std::size_t q = 0; q < found.quantities.size(); ++q) {
    const auto add = [&](const std::string& what, const Result::Numbers& numbers) {
      table.columns.push_back({with_unit(found.quantities[q] + what, found.quantity_unit(q)),
                               [&numbers, q](std::size_t d) { return to_number(numbers(q, d)); }});
    };
    add("", found.merit);
    add(" low", found.low);
    add(" high", found.high);
    add(" change", found.change);
    add(" change low", found.change_low);
    add(" change high", found.change_high);
    add(" from best", found.from_best);
    add(" from best low", found.from_best_low);
    add(" from best high", found.from_best_high);
  }
  append_solve_columns(table, found.solves);
  if (!found.left_out.empty()) table.columns.push_back({"left_out", [&](std::size_t d) { return found.left_out(d); }});
  table.last = {"verdict", [&](std::size_t d) { return found.verdict(d); }};
  table.rest = {{"content_sha256", [&](std::size_t d) { return found.content_sha256(d); }}};
  tables.push_back(std::move(table));
}

}  // namespace

constinit const FileKind kFile{.write = write, .read = read, .append_tables = append_tables};

}  // namespace poesy::sweep
