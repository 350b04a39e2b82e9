#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/units.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

std::string name_cells(std::string_view name, std::string_view unit) { return fmt::format("{:<22} {:>6}", name, unit); }

std::string cell(std::string_view word) { return fmt::format(" {:>13}", word); }

std::string cell(double value) { return fmt::format(" {:>13.6g}", value); }

std::string overall_row(const StoredResult& result, std::size_t r) {
  const MonteCarloResult& found = result.monte_carlo;
  const Unit& unit = display(result.responses[r]);
  std::string text = name_cells(result.responses[r].name, unit.name);
  std::vector<double> row{found.overall_mean[r], found.overall_std[r], found.overall_min[r]};
  for (std::size_t q = 0; q < found.levels.size(); ++q) {
    row.push_back(found.overall_quantiles[r * found.levels.size() + q]);
  }
  row.push_back(found.overall_max[r]);
  for (const double value : row) text += cell(value / unit.si);
  return text + '\n';
}

/// The largest of one number of each pose, and its pose; NaN counts as least.
std::string worst_pose(const std::vector<double>& at_poses, const Unit& unit) {
  const auto worst =
      std::ranges::max_element(at_poses, [](double a, double b) { return std::isnan(a) ? !std::isnan(b) : a < b; });
  return cell(*worst / unit.si) + fmt::format(" {:>9}", fmt::format("pose {}", worst - at_poses.begin()));
}

std::string poses_row(const StoredResult& result, std::size_t r) {
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
  return name_cells(result.responses[r].name, unit.name) + cell(sum / static_cast<double>(found.poses) / unit.si) +
         worst_pose(mean, unit) + worst_pose(highest_quantile, unit) + '\n';
}

}  // namespace

std::string monte_carlo_table(const StoredResult& result) {
  const MonteCarloResult& found = result.monte_carlo;
  if (found.poses == 0 || found.levels.empty()) return "no poses\n";
  std::string text =
      fmt::format("{} errors vary together, {} samples at each of {} poses; quantiles to {:.2g} % of their value\n\n",
                  result.factors.size(), count_text(found.solves.front().total()), found.poses,
                  100.0 * found.quantile_relative_error);
  text += name_cells("all poses together", "unit");
  for (const char* word : {"mean", "std", "min"}) text += cell(word);
  for (const double level : found.levels) text += cell("q_" + shortest(level));
  text += cell("max") + '\n';
  for (const std::size_t r : result.headline) text += overall_row(result, r);
  const std::string highest = "q_" + shortest(found.levels.back());
  text += '\n' + name_cells("over the poses", "unit") +
          fmt::format(" {:>13} {:>23} {:>23}\n", "mean of means", "largest mean", "largest " + highest);
  for (const std::size_t r : result.headline) text += poses_row(result, r);
  return text;
}

}  // namespace poesy
