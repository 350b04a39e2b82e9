#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "engine/base/units.h"
#include "engine/report/display.h"
#include "engine/report/html/outcomes.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/sections.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

/// 0, the levels, 1: where a distribution's smallest value, quantiles and largest value stand.
std::vector<double> all_levels(const MonteCarloResult& found) {
  std::vector<double> levels{0.0};
  levels.insert(levels.end(), found.levels.begin(), found.levels.end());
  levels.push_back(1.0);
  return levels;
}

std::vector<double> distribution(const MonteCarloResult& found, std::size_t r) {
  std::vector<double> values{found.overall_min[r]};
  for (std::size_t q = 0; q < found.levels.size(); ++q) {
    values.push_back(found.overall_quantiles[r * found.levels.size() + q]);
  }
  values.push_back(found.overall_max[r]);
  return values;
}

/// The same of one pose.
std::vector<double> distribution_at(const MonteCarloResult& found, std::size_t r, std::size_t pose) {
  const std::size_t cell = r * found.poses + pose;
  std::vector<double> values{found.min[cell]};
  for (std::size_t q = 0; q < found.levels.size(); ++q)
    values.push_back(found.quantiles[cell * found.levels.size() + q]);
  values.push_back(found.max[cell]);
  return values;
}

/// The pose with the largest mean; none where no mean is known.
std::optional<std::size_t> worst_pose(const MonteCarloResult& found, std::size_t r) {
  std::optional<std::size_t> worst;
  for (std::size_t m = 0; m < found.poses; ++m) {
    const double mean = found.mean[r * found.poses + m];
    if (!std::isnan(mean) && (!worst || mean > found.mean[r * found.poses + *worst])) worst = m;
  }
  return worst;
}

Panel distribution_panel(const StoredResult& result, std::size_t r, ArrayPool& pool) {
  const MonteCarloResult& found = result.monte_carlo;
  const NamedUnit& response = result.responses[r];
  const double unit = display(response).si;
  Panel panel{response.name, unit_text(response), {}};
  panel.series.push_back(
      {"samples of all poses", pool.add(fmt::format("distribution/{}", r), distribution(found, r), unit)});
  if (const auto worst = worst_pose(found, r)) {
    panel.series.push_back(
        {.label = fmt::format("pose {}, the largest mean", *worst),
         .value = pool.add(fmt::format("distribution_worst/{}", r), distribution_at(found, r, *worst), unit),
         .style = "dashed"});
  }
  return panel;
}

Section how_large(const StoredResult& result, std::vector<Table>& tables, Page& page) {
  Section section("how-large", "How large are the deviations");
  section.paragraph(fmt::format(
      "All {} vary at once. A curve says below which value a share of the samples lies: at 50 % is the median, "
      "at 0 and 100 % the smallest and the largest value that was drawn.",
      counted(result.factors.size(), "error", "errors")));
  ArrayPool& pool = page.figures.pool;
  Lines lines{.x = {"share of the samples below", "%", pool.add("axis_levels", all_levels(result.monte_carlo), 0.01)},
              .panels = {}};
  for (const std::size_t r : headline_order(result)) lines.panels.push_back(distribution_panel(result, r, pool));
  add_figure(page, section, "distribution", std::move(lines), "The distribution of each response by its quantiles.");
  for (const Table& table : take_tables(tables, std::vector<std::string_view>{"overall", "poses"}))
    section.table(table);
  return section;
}

/// One quantile of a response at all poses, [M].
std::vector<double> quantile_at_poses(const MonteCarloResult& found, std::size_t r, std::size_t q) {
  std::vector<double> values(found.poses);
  for (std::size_t m = 0; m < found.poses; ++m) {
    values[m] = found.quantiles[(r * found.poses + m) * found.levels.size() + q];
  }
  return values;
}

/// Adds numbers of a response at all poses, those that are shown.
class PoseArrays {
 public:
  PoseArrays(const StoredResult& result, const ShownCells& shown, ArrayPool& pool)
      : result_(result), shown_(shown), pool_(pool) {}

  ArrayName of(std::string_view what, std::size_t r, std::span<const double> at_poses) const {
    return pool_.add(fmt::format("{}/{}", what, r), shown_.at_poses(at_poses), display(result_.responses[r]).si);
  }
  ArrayName quantile(std::size_t r, std::size_t q) const {
    return of(fmt::format("quantile/{}", q), r, quantile_at_poses(result_.monte_carlo, r, q));
  }
  ArrayName mean(std::size_t r) const {
    const std::size_t poses = result_.monte_carlo.poses;
    return of("mean", r, std::span(result_.monte_carlo.mean).subspan(r * poses, poses));
  }
  ArrayName spread(std::size_t r) const {
    const std::size_t poses = result_.monte_carlo.poses;
    return of("std", r, std::span(result_.monte_carlo.std).subspan(r * poses, poses));
  }

 private:
  const StoredResult& result_;
  const ShownCells& shown_;
  ArrayPool& pool_;
};

std::string quantile_label(double level) { return shortest(100.0 * level) + " % quantile"; }

/// The mean of each pose in a band from the lowest to the highest quantile.
Lines bands(const StoredResult& result, const ShownCells& shown, const PoseArrays& arrays, ArrayPool& pool) {
  const std::size_t levels = result.monte_carlo.levels.size();
  Lines lines{.x = pose_axis(result, shown, pool), .panels = {}};
  for (const std::size_t r : shown.responses) {
    lines.panels.push_back({result.responses[r].name,
                            unit_text(result.responses[r]),
                            {{"mean", arrays.mean(r), arrays.quantile(r, 0), arrays.quantile(r, levels - 1)}}});
  }
  return lines;
}

std::vector<Field> fields(const StoredResult& result, const ShownCells& shown, const PoseArrays& arrays,
                          ArrayPool& pool) {
  const std::vector<double>& levels = result.monte_carlo.levels;
  std::vector<Field> list;
  for (const std::size_t r : shown.responses) {
    const std::string& name = result.responses[r].name;
    const std::string unit = unit_text(result.responses[r]);
    list.push_back({name + ", mean", unit, arrays.mean(r)});
    list.push_back({name + ", " + quantile_label(levels.back()), unit, arrays.quantile(r, levels.size() - 1)});
    list.push_back({name + ", standard deviation", unit, arrays.spread(r)});
  }
  list.push_back(
      pose_field("not_converged_poses", "not converged", "%", tally_of(result).shares_by_pose(), shown, pool, 0.01));
  for (Field& field : condition_field(result, shown, pool)) list.push_back(std::move(field));
  return list;
}

Section where(const StoredResult& result, Page& page) {
  ArrayPool& pool = page.figures.pool;
  const std::vector<double>& levels = result.monte_carlo.levels;
  const ShownCells shown = shown_cells(result);
  const PoseArrays arrays(result, shown, pool);
  Section section("where", "Where in the workspace");
  section.paragraph(
      fmt::format("Pose by pose: the mean of the samples, and between which quantiles ({} and {}) they lie.",
                  quantile_label(levels.front()), quantile_label(levels.back())));
  if (!shown.note().empty()) section.paragraph(shown.note());
  add_figure(page, section, "poses", bands(result, shown, arrays, pool),
             "The mean at each pose, and how far the lowest and the highest quantile are from it.");
  add_figure(page, section, "workspace",
             WorkspaceMap{pose_coordinates(result, shown, pool), fields(result, shown, arrays, pool),
                          pose_numbers(shown, pool)},
             "Each dot is a pose of the study, coloured by what is chosen.");
  return section;
}

}  // namespace

void add_monte_carlo(const StoredResult& result, Page& page) {
  if (result.monte_carlo.poses == 0 || result.monte_carlo.levels.empty()) return;
  std::vector<Table> tables = result_tables(result, default_ranking(result));
  page.sections.push_back(how_large(result, tables, page));
  page.sections.push_back(where(result, page));
  add_certainty(result, tables, page);
  if (!tables.empty()) page.sections[0].folded("More tables", tables);
}

}  // namespace poesy
