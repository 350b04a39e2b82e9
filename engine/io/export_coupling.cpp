#include "engine/io/export_tables.h"

namespace poesy {
namespace {

using Columns = std::vector<std::string>;

/// "subset", the sizes, then `own`, and for each response its columns: add(response, columns).
template <class Add>
Columns columns_of(const StoredResult& result, const Columns& own, const Add& add) {
  Columns columns{"subset", column("size_linear", "m"), column("size_angular", "rad")};
  columns.insert(columns.end(), own.begin(), own.end());
  for (const NamedUnit& response : result.responses) add(response, columns);
  return columns;
}

/// A column of a response: its name, the quantity, and the response's unit, or "1".
std::string response_column(const NamedUnit& response, const std::string& quantity, const std::string& unit) {
  return column(response.name + "_" + quantity, unit);
}

void write_curves(TableFolder& folder, const StoredResult& result) {
  const StoredCoupling& stored = result.coupling;
  const CouplingResult& found = stored.found;
  const Columns columns = columns_of(result, {"pose"}, [](const NamedUnit& response, Columns& list) {
    for (const char* quantity : {"effect", "interaction", "worst_case", "root_sum_square"}) {
      list.push_back(response_column(response, quantity, response.unit));
    }
    list.push_back(response_column(response, "cancellation", "1"));
  });
  const std::size_t cells = found.sizes * found.subsets * found.poses;
  folder.write("coupling", columns, [&](CsvTable& table) {
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const std::size_t z = cell / found.poses / found.subsets;
      const std::size_t k = cell / found.poses % found.subsets;
      std::vector<double> row{stored.linear[z], stored.angular[z], static_cast<double>(cell % found.poses)};
      for (std::size_t at = cell; at < found.effect.size(); at += cells) {
        row.insert(row.end(), {found.effect[at], found.interaction[at], found.worst_case[at],
                               found.root_sum_square[at], found.cancellation[at]});
      }
      table.row(stored.subsets[k], row);
    }
  });
}

void write_summary(TableFolder& folder, const StoredResult& result) {
  const StoredCoupling& stored = result.coupling;
  const CouplingResult& found = stored.found;
  const Columns columns = columns_of(result, {}, [](const NamedUnit& response, Columns& list) {
    list.push_back(response_column(response, "poses", "1"));
    list.push_back(response_column(response, "effect_max", response.unit));
    list.push_back(response_column(response, "effect_max_pose", "1"));
    for (const char* quantity : {"interaction_max", "worst_case_max", "root_sum_square_max"}) {
      list.push_back(response_column(response, quantity, response.unit));
    }
    for (const char* quantity : {"opposed_share", "cancellation_max", "cancellation_max_pose"}) {
      list.push_back(response_column(response, quantity, "1"));
    }
  });
  const std::size_t cells = found.sizes * found.subsets;
  folder.write("coupling_summary", columns, [&](CsvTable& table) {
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const std::size_t z = cell / found.subsets;
      std::vector<double> row{stored.linear[z], stored.angular[z]};
      for (std::size_t at = cell; at < found.effect_max.size(); at += cells) {
        row.insert(row.end(), {static_cast<double>(found.count[at]), found.effect_max[at],
                               static_cast<double>(found.effect_max_pose[at]), found.interaction_max[at],
                               found.worst_case_max[at], found.root_sum_square_max[at], found.opposed_share[at],
                               found.cancellation_max[at], static_cast<double>(found.cancellation_max_pose[at])});
      }
      table.row(stored.subsets[cell % found.subsets], row);
    }
  });
}

void write_not_converged(TableFolder& folder, const StoredResult& result) {
  const StoredCoupling& stored = result.coupling;
  Columns columns{"pose", column("size_linear", "m"), column("size_angular", "rad")};
  add_solve_columns(columns);
  folder.write("not_converged", columns, [&](CsvTable& table) {
    for (std::size_t cell = 0; cell < stored.found.solves.size(); ++cell) {
      const std::size_t z = cell / stored.found.poses;
      std::vector<double> row{stored.linear[z], stored.angular[z]};
      append_solves(stored.found.solves[cell], row);
      table.row(std::to_string(cell % stored.found.poses), row);
    }
  });
}

}  // namespace

void export_coupling(TableFolder& folder, const StoredResult& result) {
  write_curves(folder, result);
  write_summary(folder, result);
  write_not_converged(folder, result);
}

}  // namespace poesy
