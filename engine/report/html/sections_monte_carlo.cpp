#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "engine/base/units.h"
#include "engine/report/display.h"
#include "engine/report/html/outcomes.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/sections.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

/// The histogram of a response and its cumulative curve, as outlines over the edges of the bins. Without the first and
/// the last bin, which reach out to the extremes.
struct Outline {
  std::vector<double> x;        ///< [2 B] each bin's lower and upper end, in the unit shown
  std::vector<double> density;  ///< [2 B] share of the samples per unit of x
  std::vector<double> below;    ///< [2 B] share of the samples below x
};

Outline outline(const MonteCarloResult& found, std::size_t r, double unit) {
  const std::size_t bins = found.histogram_counts.size() / found.responses;
  const std::span counts = std::span(found.histogram_counts).subspan(r * bins, bins);
  const std::span edges = std::span(found.histogram_edges).subspan(r * (bins + 1), bins + 1);
  const double all = static_cast<double>(found.overall_count[r]);
  Outline drawn;
  double sum = static_cast<double>(counts.front()) / all;
  for (std::size_t b = 1; b + 1 < bins; ++b) {
    // Bins that are left over stand at the largest value.
    if (!(edges[b] < edges[b + 1]) || !(edges[b + 1] < edges.back())) continue;
    const double share = static_cast<double>(counts[b]) / all;
    const double density = share / ((edges[b + 1] - edges[b]) / unit);
    drawn.x.insert(drawn.x.end(), {edges[b] / unit, edges[b + 1] / unit});
    drawn.density.insert(drawn.density.end(), {density, density});
    drawn.below.insert(drawn.below.end(), {sum, sum + share});
    sum += share;
  }
  return drawn;
}

/// The verdict on a response; null where it has no limit.
const LimitVerdict* verdict_on(const StoredResult& result, std::size_t r) {
  const std::optional<LimitVerdicts>& verdicts = verdicts_of(result);
  if (!verdicts) return nullptr;
  const auto found = std::ranges::find(verdicts->limits, r, &LimitVerdict::response);
  return found == verdicts->limits.end() ? nullptr : &*found;
}

/// The limit of a response where it is drawn: on both sides of zero if the response has values there.
std::vector<Mark> limit_marks(const StoredResult& result, std::size_t r, double unit) {
  const LimitVerdict* verdict = verdict_on(result, r);
  if (verdict == nullptr) return {};
  std::vector<Mark> marks{{"limit", verdict->limit / unit}};
  if (result.monte_carlo.overall_min[r] < 0.0) marks.push_back({"limit", -verdict->limit / unit});
  return marks;
}

std::string distribution_caption(const StoredResult& result, std::size_t r) {
  const NamedUnit& response = result.responses[r];
  std::string text = fmt::format(
      "{}: its distribution over the samples of all poses, and below it the share of the samples below a value. The "
      "outermost 0.05 % on either side are not drawn.",
      response.name);
  if (const LimitVerdict* verdict = verdict_on(result, r)) {
    text += fmt::format(" {} of the draws are within the limit.",
                        percent_text(static_cast<double>(verdict->within) / static_cast<double>(verdict->tried)));
  }
  return text;
}

Lines distribution(const StoredResult& result, std::size_t r, ArrayPool& pool) {
  const NamedUnit& response = result.responses[r];
  const std::string unit = unit_text(response);
  const Outline drawn = outline(result.monte_carlo, r, display(response).si);
  const auto add = [&](std::string_view what, const std::vector<double>& values, double scale) {
    return pool.add(fmt::format("{}/{}", what, r), values, scale);
  };
  const ArrayName zero = add("histogram_zero", std::vector<double>(drawn.x.size(), 0.0), 1.0);
  const ArrayName density = add("histogram", drawn.density, 0.01);
  return {.x = {response.name, unit, add("histogram_x", drawn.x, 1.0)},
          .panels = {{"share of the samples per unit",
                      unit.empty() ? "%" : "%/" + unit,
                      {{"samples of all poses", density, zero, density}}},
                     {"share of the samples below", "%", {{"samples of all poses", add("below", drawn.below, 0.01)}}}},
          .marks = limit_marks(result, r, display(response).si)};
}

Section how_large(const StoredResult& result, std::vector<Table>& tables, Page& page) {
  const MonteCarloResult& found = result.monte_carlo;
  Section section("how-large", "How large are the deviations");
  section.paragraph(fmt::format("All {} vary at once.", counted(result.factors.size(), "error", "errors")));
  for (const Table& table : take_tables(tables, std::vector<std::string_view>{"overall"})) section.table(table);
  for (const std::size_t r : headline_order(result)) {
    if (found.histogram_counts.empty() || found.overall_count[r] == 0) continue;
    add_figure(page, section, fmt::format("distribution-{}", r), distribution(result, r, page.figures.pool),
               distribution_caption(result, r));
  }
  for (const Table& table : take_tables(tables, std::vector<std::string_view>{"poses"})) section.table(table);
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

std::string quantile_label(double level) { return percent_text(level) + " quantile"; }

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
  add_limits(tables, page);
  page.sections.push_back(how_large(result, tables, page));
  page.sections.push_back(where(result, page));
  add_certainty(result, tables, page);
  if (!tables.empty()) page.sections.back().folded("More tables", tables);
}

}  // namespace poesy
