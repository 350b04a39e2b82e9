#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

constexpr int kDigits = 6;

/// Mean and extremes of a response over the solved samples; NaN where none is.
struct Summary {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double smallest = mean;
  double largest = mean;
};

Summary summary(const EvaluationResult& found, std::size_t r) {
  const std::size_t all = found.poses * found.samples;
  double sum = 0.0;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  std::size_t count = 0;
  for (std::size_t n = 0; n < all; ++n) {
    if (!solved(found.status[n])) continue;
    const double value = found.response[r * all + n];
    sum += value;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
    ++count;
  }
  return count == 0 ? Summary() : Summary{sum / static_cast<double>(count), smallest, largest};
}

}  // namespace

Table evaluation_table(const StoredResult& result) {
  Table table{
      .name = "evaluation",
      .caption = "Responses over all samples that were solved",
      .columns = {text_column("response", "response"), text_column("unit", "unit"), number_column("mean", "mean"),
                  number_column("smallest", "smallest"), number_column("largest", "largest")},
      .rows = {},
      .notes = {}};
  for (const std::size_t r : result.headline) {
    const Unit& unit = display(result.responses[r]);
    const Summary found = summary(result.evaluation, r);
    table.rows.push_back({text_cell(result.responses[r].name), text_cell(unit.name),
                          number_cell(found.mean / unit.si, kDigits), number_cell(found.smallest / unit.si, kDigits),
                          number_cell(found.largest / unit.si, kDigits)});
  }
  return table;
}

Table cases_table(const StoredResult& result) {
  const CaseResult& found = result.case_result;
  Table table{.name = "cases",
              .caption = "Each case over its poses: mean and largest value of the responses",
              .columns = {text_column("case", "case"), number_column("poses", "poses")},
              .rows = {},
              .notes = {"poses: those whose solve counts"}};
  int dispensable = 0;  // of the first response's columns; the last response's go first
  for (const std::size_t r : result.headline) {
    const NamedUnit& response = result.responses[r];
    const std::string_view unit = display(response).name;
    table.columns.push_back(number_column(response.name + "_mean", response.name + " mean", unit, dispensable));
    table.columns.push_back(
        number_column(response.name + "_max", response.name + " max", unit, dispensable == 0 ? 0 : dispensable + 1));
    dispensable += 2;
  }
  for (std::size_t c = 0; c < result.cases.size(); ++c) {
    std::vector<Cell> row{text_cell(result.cases[c]), count_cell(found.count[c])};
    for (const std::size_t r : result.headline) {
      const std::size_t at = r * result.cases.size() + c;
      const double unit = display(result.responses[r]).si;
      row.push_back(number_cell(found.mean[at] / unit, kDigits));
      row.push_back(number_cell(found.max[at] / unit, kDigits));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace poesy
