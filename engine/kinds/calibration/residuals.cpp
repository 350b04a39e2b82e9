#include "engine/kinds/calibration/residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/report/display.h"

namespace poesy::calibration {
namespace {

constexpr std::size_t kMostRows = 10;  // largest number of values in the table
constexpr int kValueDigits = 6;  // significant digits of measured and fitted values, enough to show that they differ
constexpr int kResidualDigits = 3;

/// The number by which values are ordered: the magnitude of the residual over its standard deviation, or the magnitude
/// of the residual if all noise is 0. 0 if no other value checks the value.
double size_of(const Result& found, std::size_t i) {
  const double size = std::abs(found.noise_is_known != 0 ? found.standardised(i) : found.residual(i));
  return std::isnan(size) ? 0.0 : size;
}

/// True if no other measured value checks value i. The fit then reproduces the value exactly, so its residual has no
/// standard deviation.
bool is_unchecked(const Result& found, std::size_t i) {
  return found.noise_is_known != 0 && std::isnan(found.standardised(i));
}

std::vector<std::size_t> largest_residuals(const Result& found) {
  std::vector<std::size_t> order = positions(found.values.size());
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return size_of(found, i); });
  if (order.size() > kMostRows) order.resize(kMostRows);
  return order;
}

std::string mark_of(const Result& found, std::size_t i) {
  return found.outlier(i) != 0 ? "outlier" : is_unchecked(found, i) ? "unchecked" : "";
}

std::vector<FilledColumn> place_columns(const StoredResult& result, const Result& found) {
  std::vector<FilledColumn> columns;
  for (std::size_t c = 0; c < result.pose_coordinates.size(); ++c) {
    const NamedUnit& own = result.pose_coordinates[c];
    columns.push_back({number_column("at_" + own.name, own.name, unit_text(own), 2), [&found, &own, c](std::size_t i) {
                         return value_cell(found.measured_at(found.value_row(i), c), own);
                       }});
  }
  return columns;
}

void add_notes(const Result& found, const std::vector<std::size_t>& shown, Table& table) {
  table.notes.emplace_back("residual: measured less fitted value, in the unit of the value");
  if (found.noise_is_known != 0) {
    table.notes.emplace_back(
        "residual/sd: the residual over its own standard deviation, which is below that of the value, because the fit "
        "follows the value");
  }
  if (std::ranges::any_of(shown, [&](std::size_t i) { return is_unchecked(found, i); })) {
    table.notes.emplace_back("unchecked: no other value checks this one");
  }
  if (std::ranges::any_of(shown, [&](std::size_t i) { return is_distance(found, i); })) {
    table.notes.emplace_back("the place of a distance is the first of its two");
  }
  if (shown.size() < found.values.size()) {
    table.notes.push_back(fmt::format("{} of {} values shown; all are in residuals.csv ('poesy export')", shown.size(),
                                      found.values.size()));
  }
}

}  // namespace

Table residuals_table(const StoredResult& result) {
  const Result& found = calibration_of(result);
  Table table{.name = "residuals",
              .caption = fmt::format("Measured against fitted values, the largest residual{} first",
                                     found.noise_is_known != 0 ? " over its standard deviation" : ""),
              .columns = {}};
  const std::vector<std::size_t> shown = largest_residuals(found);
  const auto value = [&](const std::string& name, int digits, std::function<double(std::size_t)> of) {
    return FilledColumn{number_column(name, name), [&found, digits, of = std::move(of)](std::size_t i) {
                          return value_cell(of(i), {found.values[i], found.value_units[i]}, digits);
                        }};
  };
  std::vector<FilledColumn> columns{
      {text_column("value", "value"), [&](std::size_t i) { return text_cell(found.values[i]); }}};
  for (FilledColumn& place : place_columns(result, found)) columns.push_back(std::move(place));
  columns.push_back({text_column("unit", "unit"), [&](std::size_t i) {
                       return text_cell(unit_text({found.values[i], found.value_units[i]}));
                     }});
  columns.push_back(value("measured", kValueDigits, [&](std::size_t i) { return found.measured(i); }));
  columns.push_back(
      value("fitted", kValueDigits, [&](std::size_t i) { return found.measured(i) - found.residual(i); }));
  columns.push_back(value("residual", kResidualDigits, [&](std::size_t i) { return found.residual(i); }));
  columns.back().column.main = true;
  if (found.noise_is_known != 0) {
    columns.push_back({number_column("residual_over_sd", "residual/sd"),
                       [&](std::size_t i) { return number_cell(found.standardised(i), kResidualDigits); }});
  }
  if (std::ranges::any_of(shown, [&](std::size_t i) { return !mark_of(found, i).empty(); })) {
    columns.push_back({text_column("mark", "mark"), [&](std::size_t i) { return text_cell(mark_of(found, i)); }});
  }
  fill(table, shown, columns);
  add_notes(found, shown, table);
  return table;
}

}  // namespace poesy::calibration
