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
#include "engine/stats/moments.h"

namespace poesy::sensitivity {
namespace {

/// 1 - residual / effect, but at least zero; NaN if the ratio is not finite.
double removable_part(double residual, double effect) {
  const double left = residual / effect;
  return std::isfinite(left) ? std::max(0.0, 1.0 - left) : kNaN;
}

/// The removable part of one error; NaN if its effect is rounding.
double removable_share(double residual, double effect) {
  return has_effect(effect) ? removable_part(residual, effect) : kNaN;
}

using Cells = SeparationResult::Cells;

/// Sets, for each error at each pose, the two parts of its effect (drive and constraint), the effect, the residual
/// after the best correction of the actuators, and the share that this correction removes.
void fill_cells(const Model& model, const PoseSet& poses, std::span<const FactorIndex> factors,
                SeparationResult& result) {
  for (Cells* cells : {&result.drive, &result.constraint, &result.effect, &result.residual, &result.removable_local}) {
    *cells = Cells({factors.size(), poses.size()});
  }
  for (std::size_t m = 0; m < poses.size(); ++m) {
    const Separation at_pose = model.separation(poses[PoseIndex(m)]);
    for (std::size_t p = 0; p < factors.size(); ++p) {
      const std::size_t factor = factors[p].value;
      result.drive(p, m) = at_pose.drive[factor];
      result.constraint(p, m) = at_pose.constraint[factor];
      result.effect(p, m) = at_pose.effect[factor];
      result.residual(p, m) = at_pose.residual[factor];
      result.removable_local(p, m) = removable_share(result.residual(p, m), result.effect(p, m));
    }
  }
}

const Group<SeparationResult> kSeparation{
    "/separation",
    "What the actuators have to do with each error's effect, to first order; NaN where an error has no effect",
    {},
    {},
    {{"drive", &SeparationResult::drive, kLengthPerFactorUnit,
      "Part of the effect that enters through the actuated directions"},
     {"constraint", &SeparationResult::constraint, kLengthPerFactorUnit,
      "Part of the effect that enters through the constrained directions"},
     {"effect", &SeparationResult::effect, kLengthPerFactorUnit, "The effect: both parts together"},
     {"residual", &SeparationResult::residual, kLengthPerFactorUnit,
      "What the best correction of the actuators leaves of the effect"},
     {"removable_local", &SeparationResult::removable_local, "1",
      "Share of the effect that calibration can remove at each pose: 1 - residual / effect"},
     {"drive_share", &SeparationResult::drive_share, "1",
      "D / (D + C), with D and C the root mean squares of drive and constraint over the poses"},
     {"removable", &SeparationResult::removable, "1",
      "Share that calibration can remove: 1 - residual / effect, both as root mean squares over the poses"},
     {"removable_together", &SeparationResult::removable_together, "1",
      "The same for all errors together, independent, with the standard deviations of /factors/sigma: "
      "1 - root of the sum of (sigma x residual)^2 over root of the sum of (sigma x effect)^2"},
     {"published", &SeparationResult::published, "1",
      "Class of the error in the literature; empty where it gives none"}}};

/// The published classes of these errors, in the order in which they first appear.
std::vector<std::string> classes_of(std::span<const std::string> of_errors) {
  std::vector<std::string> classes;
  for (const std::string& published : of_errors) {
    if (!published.empty() && std::ranges::find(classes, published) == classes.end()) classes.push_back(published);
  }
  return classes;
}

CsvTable share_table(const StoredResult& result, const SeparationResult& found) {
  CsvTable table = lines_of_factors(result, "separation");
  for (const FieldRow<SeparationResult>& field : kSeparation.fields) {
    const bool number = field.name == "drive_share" || field.name == "removable";
    if (number) table.columns.push_back(field_column(field.name, field, found));
  }
  for (const std::string& published : classes_of(found.published)) {
    table.columns.push_back({"published_" + published, [&found, published](std::size_t p) {
                               return found.published(p) == published ? 1.0 : 0.0;
                             }});
  }
  return table;
}

}  // namespace

SeparationResult separate_errors(const Model& model, const PoseSet& poses, std::span<const FactorIndex> factors,
                                 std::span<const double> sigma) {
  POESY_EXPECTS(sigma.size() == factors.size());
  const SeparationDescription& described = *model.description().separation;
  SeparationResult result;
  result.measure = described.measure;
  fill_cells(model, poses, factors, result);
  result.removable = result.drive_share = Array<double, axis::Factor>({factors.size()});
  result.published = Array<std::string, axis::Factor>({factors.size()});
  double effects = 0.0;
  double residuals = 0.0;
  for (std::size_t p = 0; p < factors.size(); ++p) {
    const double effect = root_mean_square(result.effect.row(p));
    const double residual = root_mean_square(result.residual.row(p));
    const double drive = root_mean_square(result.drive.row(p));
    const double removable = removable_share(residual, effect);
    result.removable(p) = removable;
    result.drive_share(p) = std::isnan(removable) ? kNaN : drive / (drive + root_mean_square(result.constraint.row(p)));
    result.published(p) = described.published[factors[p].value];
    effects = std::hypot(effects, sigma[p] * effect);
    residuals = std::hypot(residuals, sigma[p] * residual);
  }
  result.removable_together = removable_part(residuals, effects);
  return result;
}

void write_separation(ResultBuilder& result, const std::optional<SeparationResult>& found) {
  if (!found) return;
  write_group(result, kSeparation, *found);
  result.file().set_attribute("/separation", "measure", found->measure);
}

std::optional<SeparationResult> read_separation(const h5::File& file) {
  if (!file.exists("/separation")) return std::nullopt;
  SeparationResult found;
  read_group(file, kSeparation, found);
  found.measure = file.attribute<std::string>("/separation", "measure").at(0);
  return found;
}

std::size_t separation_bytes(const AxisLengths& lengths) { return bytes_of(kSeparation.fields, lengths); }

void append_separation_tables(CsvTables& tables, const StoredResult& result) {
  if (!sensitivity_of(result).separation) return;
  const SeparationResult& found = *sensitivity_of(result).separation;
  tables.push_back(share_table(result, found));
  for (const FieldRow<SeparationResult>& field : kSeparation.fields) {
    if (field.axes != Cells::axis_names()) continue;
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
              .notes = {"effect: " + found.measure,
                        fmt::format("all errors together, at the size the study sets: {} of the effect is removable",
                                    percent_text(found.removable_together))},
              .ranked = true};
  std::vector<FilledColumn> columns{rank_column(result, ranked, 2), name_column(result.factors, "error")};
  if (!classes_of(found.published).empty()) {
    columns.push_back({text_column("published_class", "published class", 1),
                       [&found](std::size_t p) { return text_cell(found.published(p)); }});
  }
  columns.push_back({percent_column("drive_share", "drive share"),
                     [&found](std::size_t p) { return percent_cell(found.drive_share(p)); }});
  columns.push_back({percent_column("removable", "removable by calibration"),
                     [&found](std::size_t p) { return percent_cell(found.removable(p)); }});
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
      found.measure, percent_text(found.removable_together)));
  ArrayPool& pool = page.figures.pool;
  add_figure(page, section, "separation",
             error_bars(result, {share_quantity("removable by calibration", "removable", found.removable, pool),
                                 share_quantity("enters through the actuated directions", "drive_share",
                                                found.drive_share, pool)}),
             "How much of each error's effect calibration can remove.");
  section.table(tables, "separation");
}

}  // namespace poesy::sensitivity
