#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/monte_carlo/stored.h"
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
std::vector<FilledColumn> overall_columns(const StoredResult& result) {
  const MonteCarloResult& found = monte_carlo_of(result);
  const auto number = [&result](std::string name, std::string heading, const std::vector<double>& values,
                                int dispensable = 0, std::size_t stride = 1, std::size_t offset = 0) {
    return FilledColumn{number_column(std::move(name), std::move(heading), "", dispensable),
                        [&result, &values, stride, offset](std::size_t r) {
                          return value_cell(values[r * stride + offset], result.responses[r], kDigits);
                        }};
  };
  std::vector<FilledColumn> columns{
      name_column(result.responses, "response"),  unit_column(result.responses),
      number("mean", "mean", found.overall_mean), number("std", "std", found.overall_std),
      number("rms", "rms", found.overall_rms),    number("min", "min", found.overall_min, 1)};
  const std::size_t levels = found.levels.size();
  for (std::size_t q = 0; q < levels; ++q) {
    const int dispensable = q + 1 == levels ? 0 : static_cast<int>(levels - q);
    columns.push_back(number(quantile_name(found.levels[q]), quantile_heading(found.levels[q]), found.overall_quantiles,
                             dispensable, levels, q));
  }
  columns.push_back(number("max", "max", found.overall_max));
  return columns;
}

/// Precondition: there are poses and quantiles.
Table overall_table(const StoredResult& result) {
  const MonteCarloResult& found = monte_carlo_of(result);
  Table table{.name = "overall",
              .caption = fmt::format("{} together: responses over the samples of {}{}",
                                     counted(result.factors.size(), "error varies", "errors vary"),
                                     found.poses == 1 ? "" : "all ", counted(found.poses, "pose", "poses")),
              .columns = {},
              .notes = {fmt::format(
                  "{} at each pose; std: standard deviation; rms: root mean square; {}: {} of the samples lie "
                  "below it (quantiles to {} of their value)",
                  counted(found.solves.front().total(), "sample", "samples"), quantile_heading(found.levels.back()),
                  percent_text(found.levels.back()), percent_text(found.quantile_relative_error))}};
  fill(table, result.headline, overall_columns(result));
  return table;
}

/// The pose where a number is largest; NaN counts as least.
std::size_t worst_pose(const std::vector<double>& at_poses) {
  const auto worst =
      std::ranges::max_element(at_poses, [](double a, double b) { return std::isnan(a) ? !std::isnan(b) : a < b; });
  return static_cast<std::size_t>(worst - at_poses.begin());
}

/// The largest of one number of each pose, and its pose.
void add_worst_pose(std::vector<Cell>& row, const std::vector<double>& at_poses, const Unit& unit) {
  const std::size_t worst = worst_pose(at_poses);
  row.push_back(number_cell(at_poses[worst] / unit.si, kDigits));
  row.push_back(std::isnan(at_poses[worst]) ? text_cell("") : count_cell(worst));
}

/// The highest quantile of a response at each pose, or an end of its interval, [M]; empty where there is none.
std::vector<double> highest_at_poses(const MonteCarloResult& found, const std::vector<double>& quantiles,
                                     std::size_t r) {
  std::vector<double> values;
  if (quantiles.empty()) return values;
  for (std::size_t m = 0; m < found.poses; ++m) {
    values.push_back(quantiles[(r * found.poses + m + 1) * found.levels.size() - 1]);
  }
  return values;
}

/// The poses where the highest quantile of a response is the largest.
struct WorstPoses {
  std::vector<double> quantile;  ///< [M]
  std::size_t worst;             ///< the pose of the largest
  double low;                    ///< its interval; NaN in files of older versions
  double high;
  std::vector<std::size_t> alike;  ///< other poses whose intervals reach above `low`, the largest quantile first
};

WorstPoses worst_poses(const MonteCarloResult& found, std::size_t r) {
  WorstPoses poses{highest_at_poses(found, found.quantiles, r), 0, kNaN, kNaN, {}};
  poses.worst = worst_pose(poses.quantile);
  const std::vector<double> low = highest_at_poses(found, found.quantiles_ci_low, r);
  const std::vector<double> high = highest_at_poses(found, found.quantiles_ci_high, r);
  if (low.empty()) return poses;
  poses.low = low[poses.worst];
  poses.high = high[poses.worst];
  for (std::size_t m = 0; m < found.poses; ++m) {
    if (m != poses.worst && high[m] > poses.low) poses.alike.push_back(m);
  }
  std::ranges::stable_sort(poses.alike, std::ranges::greater(), [&](std::size_t m) { return poses.quantile[m]; });
  return poses;
}

std::vector<Cell> poses_row(const StoredResult& result, std::size_t r) {
  const MonteCarloResult& found = monte_carlo_of(result);
  const Unit& unit = display(result.responses[r]);
  std::vector<double> mean;
  double sum = 0.0;
  for (std::size_t m = 0; m < found.poses; ++m) {
    mean.push_back(found.mean[r * found.poses + m]);
    sum += mean.back();
  }
  std::vector<Cell> row{text_cell(result.responses[r].name), text_cell(unit.name),
                        number_cell(sum / static_cast<double>(found.poses) / unit.si, kDigits)};
  add_worst_pose(row, mean, unit);
  const WorstPoses poses = worst_poses(found, r);
  add_worst_pose(row, poses.quantile, unit);
  row.push_back(number_cell(poses.low / unit.si, kDigits));
  row.push_back(number_cell(poses.high / unit.si, kDigits));
  row.push_back(std::isnan(poses.low) ? text_cell("") : count_cell(poses.alike.size()));
  return row;
}

/// Names the poses that cannot be told from the worst; empty where there is none.
std::string alike_text(const StoredResult& result, std::size_t r) {
  constexpr std::size_t kMost = 5;
  const WorstPoses poses = worst_poses(monte_carlo_of(result), r);
  if (poses.alike.empty()) return {};
  std::string names;
  const std::size_t named = std::min(kMost, poses.alike.size());
  for (std::size_t k = 0; k < named; ++k) names += (k == 0 ? "" : ", ") + place_text(result, poses.alike[k]);
  if (poses.alike.size() > named) {
    names += fmt::format(" and {}", counted(poses.alike.size() - named, "other", "others"));
  }
  return fmt::format("{}: the largest {} is at {}, but its samples do not tell it from {}", result.responses[r].name,
                     quantile_heading(monte_carlo_of(result).levels.back()), place_text(result, poses.worst), names);
}

/// Precondition: there are poses and quantiles.
Table poses_table(const StoredResult& result) {
  const MonteCarloResult& found = monte_carlo_of(result);
  const std::string name = "largest_" + quantile_name(found.levels.back());
  const std::string heading = quantile_heading(found.levels.back());
  Table table{
      .name = "poses",
      .caption = "Pose by pose: the mean of the poses' means, and the worst poses",
      .columns = {text_column("response", "response"), text_column("unit", "unit"),
                  number_column("mean_of_means", "mean of means"), number_column("largest_mean", "largest mean"),
                  number_column("largest_mean_pose", "at pose"), number_column(name, "largest " + heading),
                  number_column("largest_quantile_pose", "at pose"), number_column(name + "_low", "low", "", 1),
                  number_column(name + "_high", "high", "", 1), number_column("poses_like_it", "poses like it")}};
  for (const std::size_t r : result.headline) table.rows.push_back(poses_row(result, r));
  if (found.quantiles_ci_low.empty()) return table;
  table.notes.push_back(
      fmt::format("low, high: {} interval of the largest {}, from order statistics; inf: too few samples for an end. "
                  "poses like it: other "
                  "poses whose interval reaches above low",
                  percent_text(found.conf_level), heading));
  for (const std::size_t r : result.headline) {
    if (std::string text = alike_text(result, r); !text.empty()) table.notes.push_back(std::move(text));
  }
  return table;
}

}  // namespace

std::vector<Table> monte_carlo_tables(const StoredResult& result, const TableOptions&) {
  const MonteCarloResult& found = monte_carlo_of(result);
  std::vector<Table> tables;
  if (found.poses > 0 && !found.levels.empty()) {
    tables.push_back(overall_table(result));
    tables.push_back(poses_table(result));
  }
  return tables;
}

}  // namespace poesy
