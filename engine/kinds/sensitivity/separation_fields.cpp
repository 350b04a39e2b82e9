#include <algorithm>

#include "engine/files/result_parts.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/sensitivity/stored.h"

namespace poesy {
namespace {

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

void add_separation(ResultBuilder& result, const Study& study, const std::optional<SeparationResult>& found) {
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

}  // namespace poesy
