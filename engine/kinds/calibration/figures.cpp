#include "engine/kinds/calibration/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/nan.h"
#include "engine/kinds/calibration/result.h"
#include "engine/kinds/calibration/words.h"
#include "engine/report/display.h"
#include "engine/report/html/parts.h"

namespace poesy::calibration {
namespace {

/// The title of the column in which a value was measured: "deviation_z" of "deviation_z of p5".
std::string column_of(const std::string& value) { return value.substr(0, value.find(' ')); }

/// The columns of the table of measurements that have values, in order.
std::vector<std::string> measured_columns(const Result& found) {
  std::vector<std::string> columns;
  for (const std::string& value : found.values) {
    if (std::ranges::find(columns, column_of(value)) == columns.end()) columns.push_back(column_of(value));
  }
  return columns;
}

/// [rows of the table of measurements] The elements of `numbers` that belong to the measured values in one column; NaN
/// for a row without a value in this column. numbers: one number for each measured value.
std::vector<double> at_rows(const Result& found, const std::string& column, const Array<double, axis::Value>& numbers) {
  std::vector<double> list(found.rows.size(), kNaN);
  for (std::size_t i = 0; i < found.values.size(); ++i) {
    if (column_of(found.values[i]) == column) list[found.value_row(i)] = numbers(i);
  }
  return list;
}

template <class... A>
std::vector<double> column_at(const Array<double, A...>& matrix, std::size_t column) {
  std::vector<double> list(matrix.lengths()[0]);
  for (std::size_t row = 0; row < list.size(); ++row) list[row] = matrix(row, column);
  return list;
}

/// The SI unit of the values of a column.
std::string unit_of(const Result& found, const std::string& column) {
  const auto first = std::ranges::find(found.values, column, column_of);
  return found.value_units[static_cast<std::size_t>(first - found.values.begin())];
}

std::vector<Field> residual_fields(const Result& found, ArrayPool& pool) {
  std::vector<Field> fields;
  for (const std::string& column : measured_columns(found)) {
    const NamedUnit named{column, unit_of(found, column)};
    fields.push_back({"residual of " + column,
                      unit_text(named),
                      pool.add("residual/" + column, at_rows(found, column, found.residual), display(named).si),
                      {},
                      true});
    if (found.noise_is_known == 0) continue;
    fields.push_back({fmt::format("residual of {} over its standard deviation", column),
                      "",
                      pool.add("standardised/" + column, at_rows(found, column, found.standardised)),
                      {},
                      true});
  }
  return fields;
}

/// A map of the poses at which the machine was measured, coloured by residuals.
WorkspaceMap residual_map(const StoredResult& result, ArrayPool& pool) {
  const Result& found = calibration_of(result);
  WorkspaceMap map;
  for (std::size_t c = 0; c < result.pose_coordinates.size(); ++c) {
    const NamedUnit& named = result.pose_coordinates[c];
    const std::vector<double> values = column_at(found.measured_at, c);
    map.coordinates.push_back(
        {named.name, unit_text(named), pool.add(fmt::format("measured_at/{}", c), values, display(named).si)});
  }
  map.fields = residual_fields(found, pool);
  std::vector<double> numbers(found.rows.size());
  for (std::size_t m = 0; m < numbers.size(); ++m) numbers[m] = static_cast<double>(m + 1);
  map.numbers = pool.add("measurement", numbers);
  return map;
}

void add_residuals(const StoredResult& result, std::span<const Table> tables, Page& page) {
  Section& section = page.add_section("residuals", "Measured against fitted values");
  add_figure(page, section, "residuals", residual_map(result, page.figures.pool),
             "Each dot is a place where the machine was measured, coloured by what is chosen. Point at a dot to see "
             "its row in the table of measurements. A value is unknown where this was not measured. A distance is at "
             "the first of "
             "its two places.");
  section.table(tables, "residuals");
}

void add_correlations(const Result& found, Page& page) {
  if (found.fitted.size() < 2) return;
  Section& section = page.add_section("together", "Which fitted errors move together");
  HeatMap map{{}, names_of(found.fitted), "fitted error, in the order of the rows", {}};
  map.layers.push_back(
      {"correlation of the estimates", "", page.figures.pool.add("correlation", found.correlation.all()), true});
  add_figure(page, section, "correlations", std::move(map),
             "The correlation of each two estimates. Near 1 or -1, the measurements tell a difference or a sum of the "
             "two far better than each of them.");
}

/// [poses] The root mean square of a component of the remaining displacement, SI: sqrt(left_mean^2 + left_sd^2).
std::vector<double> left_rms_at_poses(const Result& found, std::size_t component) {
  std::vector<double> list = column_at(found.left_mean, component);
  const std::vector<double> sd = column_at(found.left_sd, component);
  for (std::size_t m = 0; m < list.size(); ++m) list[m] = std::hypot(list[m], sd[m]);
  return list;
}

/// [poses] The root mean square length of the remaining displacement, including its uncertainty, m.
std::vector<double> left_lengths_at_poses(const Result& found, const LeftLength& length) {
  std::vector<double> list = left_rms_at_poses(found, length.first);
  for (const std::size_t next : {length.first + 1, length.first + 2}) {
    const std::vector<double> component = left_rms_at_poses(found, next);
    for (std::size_t m = 0; m < list.size(); ++m) list[m] = std::hypot(list[m], component[m]);
  }
  return list;
}

void add_left(const StoredResult& result, Page& page) {
  const Result& found = calibration_of(result);
  std::vector<LeftComponent> components = left_components(found);
  if (components.empty()) return;
  std::stable_partition(components.begin(), components.end(),
                        [](const LeftComponent& one) { return one.named.unit == "m"; });
  const PoseFigures figures(result, shown_cells(result, 1), page);
  std::vector<Field> fields;
  for (const LeftComponent& one : components) {
    const auto add = [&](const std::string& what, const std::vector<double>& values, bool is_signed) {
      fields.push_back({one.named.name + ", " + what,
                        unit_text(one.named),
                        figures.add("left/" + what + "/" + one.named.name, values, one.named),
                        {},
                        is_signed});
    };
    if (found.noise_is_known != 0) add("root mean square", left_rms_at_poses(found, one.component), false);
    const std::vector<double> mean = column_at(found.left_mean, one.component);
    const bool is_seen = std::ranges::any_of(mean, [](double value) { return std::abs(value) > kLeftRounding; });
    if (is_seen) add("expected", mean, true);
  }
  if (const std::optional<LeftLength> length = left_length(found); length && found.noise_is_known != 0) {
    fields.insert(fields.begin(), {length->named.name + ", root mean square", unit_text(length->named),
                                   figures.add("left/length", left_lengths_at_poses(found, *length), length->named)});
  }
  Section& section = page.add_section("left", "What the calibrated controller leaves");
  figures.add_note(section);
  figures.add_workspace(section, std::move(fields),
                        "Each dot is a pose of the study, coloured by the displacement that is predicted to remain. "
                        "The root mean square includes what is not known of the errors.",
                        "left");
}

}  // namespace

void add_calibration_figures(const StoredResult& result, std::span<const Table> tables, Page& page) {
  add_residuals(result, tables, page);
  add_correlations(calibration_of(result), page);
  add_left(result, page);
}

}  // namespace poesy::calibration
