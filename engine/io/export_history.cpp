#include "engine/io/export_tables.h"

namespace poesy {
namespace {

void write_history(TableFolder& folder, const StoredResult& result, const IndexHistory& found, std::size_t r) {
  const NamedUnit& response = result.responses[r];
  const std::string unit = response.unit + " per " + units_of(result.factors, kSi);
  const std::vector<std::string> columns{"factor", "samples", column("index", unit), column("index_ci_low", unit),
                                         column("index_ci_high", unit)};
  const std::size_t factors = result.factors.size();
  folder.write("history_" + response.name, columns, [&](CsvTable& table) {
    for (std::size_t p = 0; p < factors; ++p) {
      for (std::size_t k = 0; k < found.samples.size(); ++k) {
        const std::size_t at = (r * factors + p) * found.samples.size() + k;
        table.row(result.factors[p].name, std::vector{static_cast<double>(found.samples[k]), found.global[at],
                                                      found.global_ci_low[at], found.global_ci_high[at]});
      }
    }
  });
}

}  // namespace

void export_history(TableFolder& folder, const StoredResult& result) {
  if (!result.sensitivity.history) return;
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    write_history(folder, result, *result.sensitivity.history, r);
  }
}

}  // namespace poesy
