// Fuzzes tables of errors, which are read for every mechanism.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/run/evaluation.h"
#include "engine/study/table_file.h"
#include "models/registry.h"
#include "tests/fuzz/target.h"

namespace {

using namespace poesy;

/// All built-in mechanisms, with their published geometry.
const std::vector<std::unique_ptr<Model>>& models() {
  static const auto all = [] {
    std::vector<std::unique_ptr<Model>> list;
    for (const CatalogEntry& entry : registry()) {
      std::vector<double> geometry;
      for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
      list.push_back(entry.build(geometry, 0));
    }
    return list;
  }();
  return all;
}

void check(const ErrorTable& table) {
  fuzz::expect(table.rows > 0 && !table.factors.empty(), "a table has a row and a column");
  fuzz::expect(table.values.size() == table.rows * table.factors.size(), "every row is complete");
  fuzz::expect(std::ranges::all_of(table.values, [](double x) { return std::isfinite(x); }), "errors are finite");
  const std::vector<std::string>& labels = table.labels.names;
  fuzz::expect(labels.empty() || labels.size() == table.rows, "every row has a label, or none has");
  fuzz::expect(std::ranges::none_of(labels, [](const std::string& label) { return label_problem(label).has_value(); }),
               "labels follow their rule");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file({data, size});
  for (const auto& model : models()) {
    fuzz::accepted<InputError>([&] { check(read_errors(file.path(), *model)); });
  }
  return 0;
}
