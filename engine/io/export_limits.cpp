#include "engine/io/export_tables.h"

namespace poesy {

void export_limits(TableFolder& folder, const std::optional<LimitVerdicts>& verdicts, const StoredResult& result) {
  if (!verdicts) return;
  const auto number = [](const std::optional<std::size_t>& position) {
    return position ? static_cast<double>(*position) : -1.0;
  };
  folder.write("limits", {"response", "value", "limit", "passed", "tried", "within", "pose", "row", "unit"},
               [&](CsvTable& table) {
                 for (const LimitVerdict& one : verdicts->limits) {
                   const NamedUnit& response = result.responses[one.response];
                   table.row(response.name,
                             std::vector{one.value, one.limit, one.passed ? 1.0 : 0.0, static_cast<double>(one.tried),
                                         static_cast<double>(one.within), number(one.pose), number(one.row)},
                             response.unit);
                 }
               });
}

}  // namespace poesy
