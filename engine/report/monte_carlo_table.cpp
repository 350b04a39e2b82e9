#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/units.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

constexpr int kDigits = 6;

/// "q_0_95", a name of JSON.
std::string quantile_name(double level) {
  std::string name = "q_" + shortest(level);
  std::ranges::replace_if(
      name, [](char c) { return c == '.' || c == '-' || c == '+'; }, '_');
  return name;
}

std::string quantile_heading(double level) { return "q_" + shortest(level); }

/// The lowest quantiles go first, then the smallest value; mean, spread and what is high stay.
std::vector<Column> overall_columns(const std::vector<double>& levels) {
  std::vector<Column> columns{text_column("response", "response"), text_column("unit", "unit"),
                              number_column("mean", "mean"),       number_column("std", "std"),
                              number_column("rms", "rms"),         number_column("min", "min", "", 1)};
  for (std::size_t q = 0; q < levels.size(); ++q) {
    const std::size_t higher = levels.size() - 1 - q;
    const int dispensable = higher == 0 ? 0 : 1 + static_cast<int>(higher);
    columns.push_back(number_column(quantile_name(levels[q]), quantile_heading(levels[q]), "", dispensable));
  }
  columns.push_back(number_column("max", "max"));
  return columns;
}

/// Over all samples, from their mean and standard deviation; NaN without samples.
double root_mean_square(const MonteCarloResult& found, std::size_t r) {
  const auto count = static_cast<double>(found.overall_count[r]);
  return std::sqrt(found.overall_mean[r] * found.overall_mean[r] +
                   found.overall_std[r] * found.overall_std[r] * (count - 1.0) / count);
}

std::vector<Cell> overall_row(const StoredResult& result, std::size_t r) {
  const MonteCarloResult& found = result.monte_carlo;
  const Unit& unit = display(result.responses[r]);
  std::vector<Cell> row{text_cell(result.responses[r].name), text_cell(unit.name)};
  const auto add = [&](double value) { row.push_back(number_cell(value / unit.si, kDigits)); };
  add(found.overall_mean[r]);
  add(found.overall_std[r]);
  add(root_mean_square(found, r));
  add(found.overall_min[r]);
  for (std::size_t q = 0; q < found.levels.size(); ++q) add(found.overall_quantiles[r * found.levels.size() + q]);
  add(found.overall_max[r]);
  return row;
}

/// Precondition: there are poses and quantiles.
Table overall_table(const StoredResult& result) {
  const MonteCarloResult& found = result.monte_carlo;
  Table table{.name = "overall",
              .caption = fmt::format("{} together: responses over the samples of {}{}",
                                     counted(result.factors.size(), "error varies", "errors vary"),
                                     found.poses == 1 ? "" : "all ", counted(found.poses, "pose", "poses")),
              .columns = overall_columns(found.levels),
              .rows = {},
              .notes = {fmt::format(
                  "{} at each pose; std: standard deviation; rms: root mean square; {}: {:.3g} % of the samples lie "
                  "below it (quantiles to {:.2g} % of their value)",
                  counted(found.solves.front().total(), "sample", "samples"), quantile_heading(found.levels.back()),
                  100.0 * found.levels.back(), 100.0 * found.quantile_relative_error)}};
  for (const std::size_t r : result.headline) table.rows.push_back(overall_row(result, r));
  return table;
}

/// The largest of one number of each pose, and its pose; NaN counts as least.
void add_worst_pose(std::vector<Cell>& row, const std::vector<double>& at_poses, const Unit& unit) {
  const auto worst =
      std::ranges::max_element(at_poses, [](double a, double b) { return std::isnan(a) ? !std::isnan(b) : a < b; });
  row.push_back(number_cell(*worst / unit.si, kDigits));
  row.push_back(std::isnan(*worst) ? text_cell("") : count_cell(static_cast<std::uint64_t>(worst - at_poses.begin())));
}

std::vector<Cell> poses_row(const StoredResult& result, std::size_t r) {
  const MonteCarloResult& found = result.monte_carlo;
  const Unit& unit = display(result.responses[r]);
  std::vector<double> mean;
  std::vector<double> highest_quantile;
  double sum = 0.0;
  for (std::size_t m = 0; m < found.poses; ++m) {
    const std::size_t cell = r * found.poses + m;
    mean.push_back(found.mean[cell]);
    sum += found.mean[cell];
    highest_quantile.push_back(found.quantiles[(cell + 1) * found.levels.size() - 1]);
  }
  std::vector<Cell> row{text_cell(result.responses[r].name), text_cell(unit.name),
                        number_cell(sum / static_cast<double>(found.poses) / unit.si, kDigits)};
  add_worst_pose(row, mean, unit);
  add_worst_pose(row, highest_quantile, unit);
  return row;
}

/// Precondition: there are poses and quantiles.
Table poses_table(const StoredResult& result) {
  const std::vector<double>& levels = result.monte_carlo.levels;
  Table table{.name = "poses",
              .caption = "Pose by pose: the mean of the poses' means, and the worst poses",
              .columns = {text_column("response", "response"), text_column("unit", "unit"),
                          number_column("mean_of_means", "mean of means"),
                          number_column("largest_mean", "largest mean"), number_column("largest_mean_pose", "at pose"),
                          number_column("largest_" + quantile_name(levels.back()),
                                        "largest " + quantile_heading(levels.back())),
                          number_column("largest_quantile_pose", "at pose")},
              .rows = {},
              .notes = {}};
  for (const std::size_t r : result.headline) table.rows.push_back(poses_row(result, r));
  return table;
}

}  // namespace

std::vector<Table> monte_carlo_tables(const StoredResult& result) {
  const MonteCarloResult& found = result.monte_carlo;
  if (found.poses == 0 || found.levels.empty()) return {};
  return {overall_table(result), poses_table(result)};
}

}  // namespace poesy
