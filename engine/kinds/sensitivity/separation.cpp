#include "engine/kinds/sensitivity/separation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/figures.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/display.h"
#include "engine/stats/indices.h"

namespace poesy {
namespace {

/// 1 - residual / effect, at least zero; NaN where that is not finite.
double removable_part(double residual, double effect) {
  const double left = residual / effect;
  return std::isfinite(left) ? std::max(0.0, 1.0 - left) : kNaN;
}

/// Of one error: the same, and NaN where its effect is rounding.
double removable_share(double residual, double effect) {
  return has_effect(effect) ? removable_part(residual, effect) : kNaN;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// All poses' values of the separated errors, [P x M].
void fill_cells(const Model& model, const PoseSet& poses, std::span<const FactorIndex> factors,
                SeparationResult& result) {
  const std::size_t cells = factors.size() * poses.size();
  for (auto* values : {&result.drive, &result.constraint, &result.effect, &result.residual}) values->resize(cells);
  for (std::size_t m = 0; m < poses.size(); ++m) {
    const Separation at_pose = model.separation(poses[PoseIndex(m)]);
    for (std::size_t p = 0; p < factors.size(); ++p) {
      const std::size_t cell = p * poses.size() + m;
      result.drive[cell] = at_pose.drive[factors[p].value];
      result.constraint[cell] = at_pose.constraint[factors[p].value];
      result.effect[cell] = at_pose.effect[factors[p].value];
      result.residual[cell] = at_pose.residual[factors[p].value];
    }
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    result.removable_local.push_back(removable_share(result.residual[cell], result.effect[cell]));
  }
}

const Group<SeparationResult> kSeparation{
    "/separation",
    "What the actuators have to do with each error's effect, to first order; NaN where an error has no effect",
    {},
    {},
    {{"drive", &SeparationResult::drive, kByFactorPose, kLengthPerFactorUnit,
      "Part of the effect that enters through the actuated directions"},
     {"constraint", &SeparationResult::constraint, kByFactorPose, kLengthPerFactorUnit,
      "Part of the effect that enters through the constrained directions"},
     {"effect", &SeparationResult::effect, kByFactorPose, kLengthPerFactorUnit, "The effect: both parts together"},
     {"residual", &SeparationResult::residual, kByFactorPose, kLengthPerFactorUnit,
      "What the best correction of the actuators leaves of the effect"},
     {"removable_local", &SeparationResult::removable_local, kByFactorPose, "1",
      "Share of the effect that calibration can remove at each pose: 1 - residual / effect"},
     {"drive_share", &SeparationResult::drive_share, kByFactor, "1",
      "D / (D + C), with D and C the root mean squares of drive and constraint over the poses"},
     {"removable", &SeparationResult::removable, kByFactor, "1",
      "Share that calibration can remove: 1 - residual / effect, both as root mean squares over the poses"},
     {"removable_together",
      &SeparationResult::removable_together,
      {},
      "1",
      "The same for all errors together, independent, with the standard deviations of /factors/sigma: "
      "1 - root of the sum of (sigma x residual)^2 over root of the sum of (sigma x effect)^2"}}};

/// The published classes that occur, in the order of their first errors.
std::vector<std::string> classes_of(const std::vector<std::string>& of_errors) {
  std::vector<std::string> classes;
  for (const std::string& published : of_errors) {
    if (!published.empty() && std::ranges::find(classes, published) == classes.end()) classes.push_back(published);
  }
  return classes;
}

CsvTable share_table(const StoredResult& result, const SeparationResult& found) {
  CsvTable table = lines_of_factors(result, "separation");
  for (const FieldRow<SeparationResult>& field : kSeparation.fields) {
    if (field.axes == kByFactor) table.columns.push_back(field_column(field.name, field, found));
  }
  const std::vector<std::string>& of_errors = sensitivity_of(result).published_class;
  for (const std::string& published : classes_of(of_errors)) {
    table.columns.push_back({"published_" + published,
                             [&of_errors, published](std::size_t p) { return of_errors[p] == published ? 1.0 : 0.0; }});
  }
  return table;
}

}  // namespace

SeparationResult separate_errors(const Model& model, const PoseSet& poses, std::span<const FactorIndex> factors,
                                 std::span<const double> sigma) {
  POESY_EXPECTS(sigma.size() == factors.size());
  SeparationResult result;
  fill_cells(model, poses, factors, result);
  double effects = 0.0;
  double residuals = 0.0;
  for (std::size_t p = 0; p < factors.size(); ++p) {
    const auto over_poses = [&](const std::vector<double>& values) {
      return root_mean_square(std::span(values).subspan(p * poses.size(), poses.size()));
    };
    const double effect = over_poses(result.effect);
    const double residual = over_poses(result.residual);
    const double drive = over_poses(result.drive);
    result.removable.push_back(removable_share(residual, effect));
    result.drive_share.push_back(std::isnan(result.removable.back()) ? kNaN
                                                                     : drive / (drive + over_poses(result.constraint)));
    effects = std::hypot(effects, sigma[p] * effect);
    residuals = std::hypot(residuals, sigma[p] * residual);
  }
  result.removable_together = removable_part(residuals, effects);
  return result;
}

void write_separation(ResultBuilder& result, const Study& study, const std::optional<SeparationResult>& found) {
  if (!found) return;
  const auto& separation = study.model().separation;
  write_group(result, kSeparation, *found);
  result.file().set_attribute("/separation", "measure", separation->measure);
  const auto published =
      texts(study.analysis.factors, [&](FactorIndex factor) { return separation->published[factor.value]; });
  result.add("/separation/published", {"factor"}, published,
             {"1", "Class of the error in the literature; empty where it gives none"});
}

void read_separation(const h5::File& file, StoredSensitivity& found) {
  if (!file.exists("/separation")) return;
  read_group(file, kSeparation, found.separation.emplace());
  found.separation_measure = file.attribute<std::string>("/separation", "measure").at(0);
  found.published_class = read_along<std::string>(file, "/separation/published", {"factor"});
}

void append_separation_tables(CsvTables& tables, const StoredResult& result) {
  if (!sensitivity_of(result).separation) return;
  const SeparationResult& found = *sensitivity_of(result).separation;
  tables.push_back(share_table(result, found));
  for (const FieldRow<SeparationResult>& field : kSeparation.fields) {
    if (field.axes != kByFactorPose) continue;
    const bool share = field.name == "removable_local";
    tables.push_back(cell_table(result, "separation_" + (share ? "removable" : field.name), field, found));
  }
  tables.push_back({"separation_together",
                    {"errors", [](std::size_t) { return std::string("together"); }},
                    1,
                    {{"removable", [&found](std::size_t) { return found.removable_together; }}}});
}

Table separation_table(const StoredResult& result, const RankedErrors& ranked) {
  const SeparationResult& found = *sensitivity_of(result).separation;
  Table table{.name = "separation",
              .caption = "What calibration can remove of each error's effect, to first order, over the poses",
              .columns = {},
              .notes = {"effect: " + sensitivity_of(result).separation_measure,
                        fmt::format("all errors together, at the size the study sets: {} of the effect is removable",
                                    percent_text(found.removable_together))},
              .ranked = true};
  const std::vector<std::string>& of_errors = sensitivity_of(result).published_class;
  std::vector<FilledColumn> columns{rank_column(result, ranked, 2), name_column(result.factors, "error")};
  if (!classes_of(of_errors).empty()) {
    columns.push_back({text_column("published_class", "published class", 1),
                       [&of_errors](std::size_t p) { return text_cell(of_errors[p]); }});
  }
  columns.push_back({percent_column("drive_share", "drive share"),
                     [&found](std::size_t p) { return percent_cell(found.drive_share[p]); }});
  columns.push_back({percent_column("removable", "removable by calibration"),
                     [&found](std::size_t p) { return percent_cell(found.removable[p]); }});
  fill(table, ranked.rows, columns);
  return table;
}

void add_separation_section(const StoredResult& result, std::span<const Table> tables, Page& page) {
  if (!sensitivity_of(result).separation) return;
  const SeparationResult& found = *sensitivity_of(result).separation;
  Section& section = page.add_section("calibration", "What calibration can remove");
  section.paragraph(fmt::format(
      "To first order, a part of each error's effect enters through the actuated directions, where a correction of the "
      "actuators can take it away. The removable share is what the best correction at each pose removes; what is left "
      "has to be prevented by tolerances. The effect is measured by {}. Of all errors together, {} is removable.",
      sensitivity_of(result).separation_measure, percent_text(found.removable_together)));
  ArrayPool& pool = page.figures.pool;
  add_figure(page, section, "separation",
             error_bars(result, {share_quantity("removable by calibration", "removable", found.removable, pool),
                                 share_quantity("enters through the actuated directions", "drive_share",
                                                found.drive_share, pool)}),
             "How much of each error's effect calibration can remove.");
  section.table(tables, "separation");
}

}  // namespace poesy
