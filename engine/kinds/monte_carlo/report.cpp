#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/kinds/corner_machines.h"
#include "engine/kinds/monte_carlo/advice.h"
#include "engine/kinds/monte_carlo/drivers.h"
#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/machine_report.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/what_if/what_if.h"
#include "engine/report/display.h"
#include "engine/report/drawn_errors.h"
#include "engine/report/far_limits.h"
#include "engine/report/sketch_view.h"
#include "engine/report/tables.h"

namespace poesy::monte_carlo {
namespace {

/// A quantile's name in JSON: "q_0_95".
std::string quantile_name(double level) {
  std::string name = "q_" + shortest(level);
  std::ranges::replace_if(
      name, [](char c) { return c == '.' || c == '-' || c == '+'; }, '_');
  return name;
}

std::string quantile_heading(double level) { return "q_" + shortest(level); }

/// The columns of the table with numbers over the samples of all poses. If the table is too wide, the lowest quantiles
/// are left out first, and then the smallest value; mean, spread and the highest quantile always stay.
std::vector<FilledColumn> overall_columns(const StoredResult& result) {
  const Result& found = monte_carlo_of(result);
  const auto number = [&result](std::string name, std::string heading, const auto& values, int dispensable = 0,
                                std::size_t q = 0) {
    return FilledColumn{
        number_column(std::move(name), std::move(heading), "", dispensable),
        [&result, &values, q](std::size_t r) { return value_cell(values.row(r)[q], result.responses[r]); }};
  };
  std::vector<FilledColumn> columns{
      name_column(result.responses, "response"),  unit_column(result.responses),
      number("mean", "mean", found.overall_mean), number("std", "std", found.overall_std),
      number("rms", "rms", found.overall_rms),    number("min", "min", found.overall_min, 1)};
  const std::size_t levels = found.levels.size();
  for (std::size_t q = 0; q < levels; ++q) {
    const int dispensable = q + 1 == levels ? 0 : static_cast<int>(levels - q);
    columns.push_back(number(quantile_name(found.levels[q]), quantile_heading(found.levels[q]), found.overall_quantiles,
                             dispensable, q));
  }
  columns.push_back(number("max", "max", found.overall_max));
  return columns;
}

/// A text on the accuracy of the quantiles over all poses.
std::string overall_error_text(const StoredResult& result) {
  const Result& found = monte_carlo_of(result);
  if (found.overall_quantile_error.empty()) {  // files of version 0.2
    return fmt::format("quantiles to {} of their value", percent_text(found.quantile_relative_error));
  }
  return quantile_error_text(result.headline, found.overall_quantile_error, found.overall_std);
}

/// The table of statistics over the samples of all poses, with a row for each response. Precondition: there are poses
/// and quantiles.
Table overall_table(const StoredResult& result) {
  const Result& found = monte_carlo_of(result);
  Table table{.name = "overall",
              .caption = fmt::format("{} together: responses over the samples of {}{}",
                                     counted(result.factors.size(), "error varies", "errors vary"),
                                     found.poses() == 1 ? "" : "all ", counted(found.poses(), "pose", "poses")),
              .columns = {},
              .notes = {fmt::format(
                  "{} at each pose; std: standard deviation; rms: root mean square; {}: {} of the samples lie "
                  "below it ({})",
                  counted(found.solves.front().total(), "sample", "samples"), quantile_heading(found.levels.back()),
                  percent_text(found.levels.back()), overall_error_text(result))}};
  fill(table, result.headline, overall_columns(result));
  if (std::string given = given_errors_text(result); !given.empty() && !result.verdicts) {
    table.notes.push_back(std::move(given));
  }
  return table;
}

/// The pose at which a number is largest; NaN counts as smallest.
std::size_t worst_pose(std::span<const double> at_poses) {
  const auto worst =
      std::ranges::max_element(at_poses, [](double a, double b) { return std::isnan(a) ? !std::isnan(b) : a < b; });
  return static_cast<std::size_t>(worst - at_poses.begin());
}

/// Appends cells to the row: the largest value over the poses, and its pose.
void add_worst_pose(std::vector<Cell>& row, std::span<const double> at_poses, const Unit& unit) {
  const std::size_t worst = worst_pose(at_poses);
  row.push_back(number_cell(at_poses[worst] / unit.si));
  row.push_back(std::isnan(at_poses[worst]) ? text_cell("") : count_cell(worst));
}

/// One quantile of a response at all poses.
std::vector<double> at_poses(const Result::QuantilesAtPoses& quantiles, std::size_t r, std::size_t q) {
  std::vector<double> values;
  for (std::size_t m = 0; m < quantiles.length<axis::Pose>(); ++m) values.push_back(quantiles(r, m, q));
  return values;
}

/// The pose at which the highest-level quantile of a response is largest, and the other poses at which the samples do
/// not show this quantile to be smaller.
struct WorstPoses {
  std::vector<double> quantile;  ///< [poses] quantile of the highest level
  std::size_t worst;             ///< pose with the largest quantile
  double low;                    ///< lower end of the interval of this quantile
  double high;
  std::vector<std::size_t> alike;  ///< other poses whose intervals reach above `low`, by decreasing quantile
};

WorstPoses worst_poses(const Result& found, std::size_t r) {
  const std::size_t highest = found.levels.size() - 1;
  WorstPoses poses{at_poses(found.quantiles, r, highest), 0, kNaN, kNaN, {}};
  poses.worst = worst_pose(poses.quantile);
  poses.low = found.quantiles_ci_low(r, poses.worst, highest);
  poses.high = found.quantiles_ci_high(r, poses.worst, highest);
  for (std::size_t m = 0; m < found.poses(); ++m) {
    if (m != poses.worst && found.quantiles_ci_high(r, m, highest) > poses.low) poses.alike.push_back(m);
  }
  std::ranges::stable_sort(poses.alike, std::ranges::greater(), [&](std::size_t m) { return poses.quantile[m]; });
  return poses;
}

std::vector<Cell> poses_row(const StoredResult& result, std::size_t r) {
  const Result& found = monte_carlo_of(result);
  const Unit& unit = display(result.responses[r]);
  const std::span mean = found.mean.row(r);
  const double sum = std::accumulate(mean.begin(), mean.end(), 0.0);
  std::vector<Cell> row{text_cell(result.responses[r].name), text_cell(unit.name),
                        number_cell(sum / static_cast<double>(mean.size()) / unit.si)};
  add_worst_pose(row, mean, unit);
  const WorstPoses poses = worst_poses(found, r);
  add_worst_pose(row, poses.quantile, unit);
  row.push_back(number_cell(poses.low / unit.si));
  row.push_back(number_cell(poses.high / unit.si));
  row.push_back(std::isnan(poses.low) ? text_cell("") : count_cell(poses.alike.size()));
  return row;
}

/// A note that names the poses that cannot be distinguished from the worst pose; empty if there are none.
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

/// The table of the worst poses of each response. Precondition: there are poses and quantiles.
Table poses_table(const StoredResult& result) {
  const Result& found = monte_carlo_of(result);
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
  table.notes.push_back(
      fmt::format("low, high: {} interval of the largest {}, from order statistics; inf: too few samples for an end; "
                  "poses like it: other poses whose interval reaches above low",
                  percent_text(found.conf_level), heading));
  for (const std::size_t r : result.headline) {
    if (std::string text = alike_text(result, r); !text.empty()) table.notes.push_back(std::move(text));
  }
  return table;
}

/// The histogram of a response that a figure shows.
struct ShownHistogram {
  std::span<const double> edges;          ///< edges of the bins, SI
  std::span<const std::uint64_t> counts;  ///< number of machines or samples in each bin
  double all;                             ///< sum of `counts`
  bool of_machines;  ///< true: largest magnitude of each machine over the poses; false: samples of all poses
  bool is_signed;    ///< true if some values are negative
};

/// The machines' largest magnitudes if the study judges machines by these, otherwise the samples.
ShownHistogram shown_histogram(const StoredResult& result, std::size_t r) {
  const Result& found = monte_carlo_of(result);
  const LimitVerdict* verdict = verdict_on(result, r);
  if (found.machines && verdict != nullptr && verdict->limit.is_plain()) {
    const MachineValues& largest = found.machines->largest;
    return {largest.histogram_edges.row(r), largest.histogram_counts.row(r), static_cast<double>(largest.count(r)),
            true, false};
  }
  return {found.histogram_edges.row(r), found.histogram_counts.row(r), static_cast<double>(found.overall_count(r)),
          false, found.overall_min(r) < 0.0};
}

/// A histogram and its cumulative distribution, as lines over the edges of the bins. The first and the last bin are
/// left out, because they extend to the smallest and the largest value.
struct Outline {
  std::vector<double> x;        ///< lower and upper end of each bin, in the unit shown
  double width = 1.0;           ///< a round number, about the width of a bin, in the unit shown
  std::vector<double> density;  ///< share of the values per `width`
  std::vector<double> below;    ///< share of the values below x
};

Outline outline(const ShownHistogram& histogram, double unit) {
  const auto& [edges, counts, all, of_machines, is_signed] = histogram;
  // Unused bins, which are the last ones, have both edges at the largest value.
  std::size_t end = 1;
  while (end + 1 < counts.size() && edges[end] < edges[end + 1] && edges[end + 1] < edges.back()) ++end;
  // Bins are joined until about as many are left as Rice's rule asks for.
  const std::size_t most = std::max<std::size_t>(10, static_cast<std::size_t>(2.0 * std::cbrt(all)));
  const std::size_t joined = (end - 1 + most - 1) / most;
  Outline drawn;
  double sum = static_cast<double>(counts.front()) / all;
  for (std::size_t b = 1; b < end; b += joined) {
    const std::size_t next = std::min(b + joined, end);
    const auto inside = counts.subspan(b, next - b);
    const double share = static_cast<double>(std::accumulate(inside.begin(), inside.end(), std::uint64_t{0})) / all;
    const double density = share / ((edges[next] - edges[b]) / unit);
    drawn.x.insert(drawn.x.end(), {edges[b] / unit, edges[next] / unit});
    drawn.density.insert(drawn.density.end(), {density, density});
    drawn.below.insert(drawn.below.end(), {sum, sum + share});
    sum += share;
  }
  if (drawn.x.empty()) return drawn;
  const double bins = 0.5 * static_cast<double>(drawn.x.size());
  drawn.width = rounded_down((drawn.x.back() - drawn.x.front()) / bins);
  for (double& density : drawn.density) density *= drawn.width;
  return drawn;
}

std::string distribution_caption(const StoredResult& result, std::size_t r, bool of_machines) {
  const NamedUnit& response = result.responses[r];
  std::string text = fmt::format(
      "{}: {}, and below it the share of the {} below a value. The outermost 0.05 % on either side are not drawn.",
      response.name,
      of_machines ? "its largest magnitude over the poses, for each machine"
                  : "its distribution over the samples of all poses",
      of_machines ? "machines" : "samples");
  if (const LimitVerdict* verdict = verdict_on(result, r)) {
    const bool machines = result.verdicts->judge == Judge::yield;
    text += fmt::format(" {} of the {} are within the limit{}.",
                        percent_text(static_cast<double>(verdict->within) / static_cast<double>(verdict->tried)),
                        machines ? "machines" : "draws", machines ? " at all poses" : "");
  }
  return text;
}

Lines distribution(const StoredResult& result, std::size_t r, const ShownHistogram& histogram, ArrayPool& pool) {
  const NamedUnit& response = result.responses[r];
  const std::string unit = unit_text(response);
  const std::string of = histogram.of_machines ? "machines" : "samples";
  const std::string all = histogram.of_machines ? "machines" : "samples of all poses";
  const Outline drawn = outline(histogram, display(response).si);
  const auto add = [&](std::string_view what, const std::vector<double>& values, double scale) {
    return pool.add(fmt::format("{}/{}", what, r), values, scale);
  };
  const ArrayName zero = add("histogram_zero", std::vector<double>(drawn.x.size(), 0.0), 1.0);
  const ArrayName density = add("histogram", drawn.density, 0.01);
  return {
      .x = {histogram.of_machines ? "largest " + response.name + " over the poses" : response.name, unit,
            add("histogram_x", drawn.x, 1.0)},
      .panels = {{fmt::format("share of the {} per {}{}", of, number_text(drawn.width), unit.empty() ? "" : " " + unit),
                  "%",
                  {{all, density, zero, density}}},
                 {fmt::format("share of the {} below", of), "%", {{all, add("below", drawn.below, 0.01)}}}},
      .marks = limit_marks(result, r, histogram.is_signed)};
}

void add_how_large(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const Result& found = monte_carlo_of(result);
  Section& section = page.add_section("how-large", "How large are the deviations");
  section.paragraph(fmt::format("All {} vary at once.", counted(result.factors.size(), "error", "errors")));
  section.table(tables, "overall");
  if (found.machines && found.machines->calibration) section.table(tables, "calibration");
  if (found.machines) section.table(tables, "machines");
  for (const std::size_t r : headline_order(result)) {
    const ShownHistogram histogram = shown_histogram(result, r);
    if (histogram.all == 0.0) continue;
    add_figure(page, section, fmt::format("distribution-{}", r), distribution(result, r, histogram, page.figures.pool),
               distribution_caption(result, r, histogram.of_machines));
  }
  section.table(tables, "poses");
}

std::string quantile_label(double level) { return percent_text(level) + " quantile"; }

SolveTally tally(const StoredResult& result) {
  return {"", {"all errors"}, result.poses.size(), monte_carlo_of(result).solves};
}

/// Adds the section with the mean at each pose, in a band from the lowest to the highest quantile, and with a map of
/// the workspace.
void add_where(const StoredResult& result, Page& page) {
  const Result& found = monte_carlo_of(result);
  const std::vector<double>& levels = found.levels;
  const PoseFigures figures(result, shown_cells(result, kSummaryRows), page);
  Lines bands{.x = figures.axis(), .panels = {}};
  std::vector<Field> fields;
  for (const std::size_t r : figures.responses()) {
    const NamedUnit& response = result.responses[r];
    const std::string unit = unit_text(response);
    const auto add = [&](std::string_view what, std::span<const double> at_poses) {
      return figures.add(fmt::format("{}/{}", what, r), at_poses, response);
    };
    const auto quantile = [&](std::size_t q) {
      return add(fmt::format("quantile/{}", q), at_poses(found.quantiles, r, q));
    };
    const ArrayName mean = add("mean", found.mean.row(r));
    const ArrayName highest = quantile(levels.size() - 1);
    bands.panels.push_back({response.name,
                            unit,
                            {{"mean", mean, quantile(0), highest}},
                            limit_marks(result, r, found.overall_min(r) < 0.0)});
    fields.push_back({response.name + ", mean", unit, mean});
    fields.push_back({response.name + ", " + quantile_label(levels.back()), unit, highest});
    fields.push_back({response.name + ", standard deviation", unit, add("std", found.std.row(r))});
  }
  if (found.machines) std::ranges::move(reject_fields(result, figures), std::back_inserter(fields));
  fields.push_back(figures.not_converged(tally(result).shares_by_pose()));
  figures.add_condition(fields);
  Section& section = page.add_section("where", "Where in the workspace");
  section.paragraph(
      fmt::format("Pose by pose: the mean of the samples, and between which quantiles ({} and {}) they lie.",
                  quantile_label(levels.front()), quantile_label(levels.back())));
  figures.add_note(section);
  add_figure(page, section, "poses", std::move(bands),
             "The mean at each pose, and how far the lowest and the highest quantile are from it.");
  figures.add_workspace(section, std::move(fields));
}

void add_how_sure(const StoredResult& result, std::span<const Table> tables, Page& page) {
  Section& section = add_how_sure(page, "How sure are the means", monte_carlo_of(result).conf_level);
  if (result.convergence) {
    ArrayPool& pool = page.figures.pool;
    const EstimateCourse course = with_ends(result.convergence->course);
    Lines lines = over_samples(course, pool);
    for (const std::size_t r : headline_order(result)) {
      const NamedUnit& response = result.responses[r];
      const std::string array = fmt::format("samples/{}", r);
      lines.panels.push_back({response.name,
                              unit_text(response),
                              {series_of(course, r, display(response).si, "all errors together", array, pool)}});
    }
    section.paragraph("The mean over the samples of all poses after so many samples, with its interval.");
    add_figure(page, section, "convergence", std::move(lines),
               "The overall mean over the number of samples, with its interval.");
  } else {
    section.paragraph(
        "With a fixed number of samples a Monte Carlo study does not keep how its means settled. One with adaptive "
        "samples does: samples = { min = .., max = .., relative_error = .. } under [analysis].");
  }
  section.table(tables, "convergence");
}

void add_page(const StoredResult& result, std::span<const Table> tables, Page& page) {
  if (monte_carlo_of(result).poses() == 0 || monte_carlo_of(result).levels.empty()) return;
  add_limits(tables, page);
  if (const auto& machines = monte_carlo_of(result).machines; machines && machines->yield) {
    add_drivers_section(result, tables, page);
  }
  add_how_large(result, tables, page);
  add_effects_section(result, tables, page);
  add_where(result, page);
  add_how_sure(result, tables, page);
}

/// [poses] The weight of each pose for predictions of the yield: the share of machines that are rejected there, summed
/// over the limits, plus a small amount that is proportional to the root mean square of the limited responses there.
std::vector<double> pose_weights(const Result& found, const Study& study) {
  constexpr double kSmall = 1e-6;
  std::vector<double> weights(found.poses(), 0.0);
  for (const ResponseLimit& limit : study.analysis.limits) {
    const std::span rms = found.rms.row(limit.response);
    const double largest = *std::ranges::max_element(rms);
    for (std::size_t m = 0; m < weights.size(); ++m) {
      const double rejected = found.machines->yield->worst_pose_share(limit.response, m);
      weights[m] += (std::isnan(rejected) ? 0.0 : rejected) + (largest > 0.0 ? kSmall * rms[m] / largest : 0.0);
    }
  }
  return weights;
}

/// Adds to the page the section that predicts the yield at other sizes of the errors. Returns a sentence on the changes
/// that raise the yield most; empty if there is no prediction or no such change.
std::string add_prediction(const ReportedResult& reported, Page& page) {
  const Result& found = monte_carlo_of(reported.stored);
  const YieldResult& yield = *found.machines->yield;
  return add_what_if({.study = *reported.study,
                      .model = *reported.model,
                      .poses = reported.stored.poses,
                      .errors = sized_errors(*reported.study, reported.stored.poses),
                      .pose_weights = pose_weights(found, *reported.study),
                      .machines = yield.machines,
                      .yield = yield.value,
                      .yield_low = yield.ci_low,
                      .yield_high = yield.ci_high,
                      .conf_level = yield.conf_level},
                     "yield", page);
}

/// Adds the section with predicted yields, unless machines are calibrated, and states in the summary which changes
/// raise the yield most and what the verdict does not cover. Adds nothing if there is no yield.
void add_solved_page(const ReportedResult& reported, Page& page) {
  const Result& found = monte_carlo_of(reported.stored);
  const Study& study = *reported.study;
  const bool fits = study.analysis.kind == &kStudy && study.analysis.draws == Draws::per_machine &&
                    study.analysis.factors.size() == reported.stored.factors.size() &&
                    reported.model->description().responses.size() == reported.stored.responses.size();
  if (!fits || !found.machines || !found.machines->yield) return;
  if (found.poses() == 0 || found.poses() != reported.stored.poses.size()) return;
  const std::string changes = study.analysis.calibration == nullptr ? add_prediction(reported, page) : std::string();
  const auto line = std::ranges::find(page.answer, kWhatToDo, &AnswerLine::first);
  if (!changes.empty() && line != page.answer.end()) {
    line->second = advice(reported.stored, response_named(reported.stored, default_ranking(reported.stored)), changes);
  }
  add_not_covered(study, *reported.model, reported.stored, page);
}

/// The summary at the top of the report: the expected values of a response, and its worst pose.
Answer answer(const StoredResult& result) {
  const Result& found = monte_carlo_of(result);
  if (found.poses() == 0 || found.levels.empty()) return {};
  const std::size_t r = response_named(result, default_ranking(result));
  const NamedUnit& response = result.responses[r];
  const auto text = [&](double value) { return response_text(response, value); };
  const std::size_t highest = found.levels.size() - 1;
  const std::string level = percent_text(found.levels[highest]);
  const WorstPoses worst = worst_poses(found, r);
  Answer lines;
  if (std::string limits = limits_text(result); !limits.empty()) lines.emplace_back("Limits", std::move(limits));
  lines.emplace_back("Answer",
                     fmt::format("{} is {} on average; {} of the samples of all poses are below {}, the largest "
                                 "is {}.",
                                 response.name, text(found.overall_mean(r)), level,
                                 text(found.overall_quantiles(r, highest)), text(found.overall_max(r))));
  const std::string place = place_text(result, worst.worst);
  lines.emplace_back("Where", fmt::format("The worst is {}: {} of the samples there are below {}.", place, level,
                                          text(worst.quantile[worst.worst])));
  std::string sure = fmt::format("{} at each pose.", counted(found.solves.front().total(), "sample", "samples"));
  if (!std::isnan(worst.low)) {
    sure += fmt::format(" The {} interval of the value at the worst pose is {} to {}; {} cannot be told from it.",
                        percent_text(found.conf_level), text(worst.low), text(worst.high),
                        counted(worst.alike.size(), "other pose", "other poses"));
  }
  lines.emplace_back("How sure", std::move(sure));
  lines.emplace_back(kWhatToDo, advice(result, r));
  return lines;
}

Settling settling(const StoredResult& result) { return {"overall means", {"all errors"}, result.headline}; }

std::vector<std::string> notes_on_far_limits(const StoredResult& result) {
  const auto rms = [&](std::size_t limit) {
    return monte_carlo_of(result).overall_rms(result.verdicts->limits[limit].response);
  };
  return far_limit_notes(result, rms, "root mean square");
}

void warn(const StoredResult& result, std::vector<std::string>& list) {
  if (std::string text = not_settled_text(result, settling(result)); !text.empty()) list.push_back(std::move(text));
}

/// The statistics over the samples of all poses that can be compared, each with its name and as a function of the
/// response; quantiles are in the order of the levels. The smallest and the largest sample are left out, because they
/// depend on the number of samples.
std::vector<std::pair<std::string, std::function<double(std::size_t r)>>> overall(const StoredResult& result) {
  const Result& found = monte_carlo_of(result);
  const auto of = [](const Result::Overall& numbers) { return [&](std::size_t r) { return numbers(r); }; };
  std::vector<std::pair<std::string, std::function<double(std::size_t)>>> list{
      {"mean", of(found.overall_mean)}, {"standard deviation", of(found.overall_std)}};
  for (std::size_t q = 0; q < found.levels.size(); ++q) {
    list.emplace_back(shortest(100.0 * found.levels[q]) + " % quantile",
                      [&found, q](std::size_t r) { return found.overall_quantiles(r, q); });
  }
  return list;
}

std::vector<double> rms_at_poses(const StoredResult& result, std::size_t response) {
  const std::span<const double> values = monte_carlo_of(result).rms.row(response);
  return {values.begin(), values.end()};
}

/// The shares of errors in the scatter of a limited response, or their first-order indices if there are no shares; and
/// the root mean square at each pose.
ErrorShares error_shares(const StoredResult& result) {
  const Result& found = monte_carlo_of(result);
  if (found.poses() == 0) return {};
  const auto shares = response_shares(result);
  const std::size_t r = shares ? shares->response : response_named(result, default_ranking(result));
  if (!shares && !varies(result, r)) return {};
  const std::string& response = result.responses[r].name;
  const std::span values = shares ? shares->each : found.effects.effects.s1.row(r);
  return {.what = (shares ? "share of the scatter of " : "first-order index S1 of ") + response,
          .values = {values.begin(), values.end()},
          .pose_what = "the root mean square of " + response,
          .at_poses = rms_at_poses(result, r)};
}

/// The figures of merit by which two results are compared: the yield, and the root mean square of the response over all
/// samples. name: name of the response; empty: the yield alone.
std::vector<Merit> merits(const StoredResult& result, std::string_view name) {
  const Result& found = monte_carlo_of(result);
  std::vector<Merit> list;
  if (result.verdicts && result.verdicts->yield) list.push_back(yield_merit(*result.verdicts->yield));
  if (name.empty() || found.overall_rms.empty()) return list;
  const std::size_t r = response_named(result, name);
  const NamedUnit& response = result.responses[r];
  list.push_back({.what = fmt::format("root mean square of {}", name),
                  .unit = unit_text(response),
                  .value = found.overall_rms(r) / display(response).si});
  return list;
}

Comparable comparable(const StoredResult& result, const StoredResult&) {
  const auto numbers = overall(result);
  std::vector<std::string> names;
  for (const auto& number : numbers) names.push_back(number.first);
  Comparable all = comparable_by_response(result, "number", std::move(names));
  add_quantity(all, result, "over the samples of all poses", "overall",
               [&](std::size_t r, std::size_t n) { return numbers[n].second(r); });
  return all;
}

}  // namespace

std::vector<Table> monte_carlo_tables(const StoredResult& result, const TableOptions&) {
  const Result& found = monte_carlo_of(result);
  std::vector<Table> tables;
  if (const std::vector<std::string> notes = notes_on_far_limits(result);
      !notes.empty() && result.verdicts->yield.has_value()) {
    tables.push_back(yield_table(result, *result.verdicts));
    std::ranges::copy(notes, std::back_inserter(tables.back().notes));
  }
  if (found.poses() > 0 && !found.levels.empty()) {
    if (found.machines && found.machines->calibration) tables.push_back(calibration_table(result));
    std::ranges::move(driver_tables(result), std::back_inserter(tables));
    tables.push_back(overall_table(result));
    tables.push_back(poses_table(result));
    if (found.machines) std::ranges::move(machine_tables(result), std::back_inserter(tables));
    tables.push_back(effect_table(result));
  }
  return tables;
}

namespace {

MethodWords method(const StoredResult& result) {
  if (!monte_carlo_of(result).machines) return {"All errors vary together, and are drawn anew at each pose."};
  std::string text = "All errors vary together.";
  if (result.verdicts && result.verdicts->yield) {
    text += " The yield is the share of machines that keep all limits at all poses.";
  }
  return {std::move(text)};
}

}  // namespace

constinit const ReportKind kReport{
    .tally = tally,
    .tables = monte_carlo_tables,
    .merits = merits,
    .settling = settling,
    .words = [](const StoredResult&) { return StudyWords{.draws = true}; },
    .method = method,
    .warn = warn,
    .far_limits = notes_on_far_limits,
    .answer = answer,
    .shown_cells = [](const StoredResult& result) { return shown_cells(result, kSummaryRows); },
    .page = add_page,
    .solved_page = add_solved_page,
    .error_shares = error_shares,
    .rms_at_poses = rms_at_poses,
    .comparable = comparable};

}  // namespace poesy::monte_carlo
