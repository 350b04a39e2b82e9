#include <fmt/format.h>

#include <algorithm>

#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/coupling/stored.h"
#include "engine/report/display.h"
#include "engine/report/study_settings.h"
#include "engine/report/tables.h"
#include "engine/stats/rounding.h"

namespace poesy {
namespace {

double rounding_at(const StoredCoupling& stored, std::size_t z) {
  return size_rounding(stored.linear[z], stored.angular[z]);
}

Cell place_cell(const StoredResult& result, bool known, std::int64_t pose) {
  return text_cell(known ? coordinates_text(result, static_cast<std::size_t>(pose)) : std::string());
}

Cell pose_cell(bool known, std::int64_t pose) {
  return known ? count_cell(static_cast<std::uint64_t>(pose)) : text_cell("");
}

std::vector<Cell> subset_row(const StoredResult& result, std::size_t r, std::size_t at) {
  const StoredCoupling& stored = coupling_of(result);
  const CouplingResult& found = stored.found;
  const double rounding = rounding_at(stored, at / found.subsets % found.sizes);
  const auto cell = [&](double value) {
    Cell shown = number_cell(value / display(result.responses[r]).si, 5);
    if (value <= rounding) shown.text = "0";
    return shown;
  };
  const bool opposed = found.cancellation_max[at] > 0.0;
  return {text_cell(stored.subsets[at % found.subsets]),
          cell(found.effect_max[at]),
          pose_cell(found.effect_max[at] > rounding, found.effect_max_pose[at]),
          place_cell(result, found.effect_max[at] > rounding, found.effect_max_pose[at]),
          cell(found.root_sum_square_max[at]),
          cell(found.worst_case_max[at]),
          cell(found.interaction_max[at]),
          opposed ? percent_cell(found.opposed_share[at]) : text_cell(""),
          opposed ? percent_cell(found.cancellation_max[at]) : text_cell(""),
          pose_cell(opposed, found.cancellation_max_pose[at]),
          place_cell(result, opposed, found.cancellation_max_pose[at])};
}

Table response_table(const StoredResult& result, std::size_t z, std::size_t r) {
  const StoredCoupling& stored = coupling_of(result);
  const CouplingResult& found = stored.found;
  const NamedUnit& response = result.responses[r];
  const std::string_view unit = display(response).name;
  Table table{
      .name = fmt::format("coupling_{}_{}", z + 1, response.name),
      .caption = fmt::format("{}: {} [{}]", stored.size_names[z], response.name, unit),
      .columns = {
          text_column("subset", "subset"), number_column("effect_max", "largest effect", unit),
          number_column("effect_max_pose", "at pose", "", 1), text_column("effect_max_where", "largest where", 4),
          number_column("root_sum_square_max", "root sum square", unit),
          number_column("worst_case_max", "worst case", unit), number_column("interaction_max", "interaction", unit),
          percent_column("opposed_share", "opposed", 3), percent_column("cancellation_max", "cancellation", 2),
          number_column("cancellation_max_pose", "at pose", "", 2),
          text_column("cancellation_max_where", "cancelled where", 4)}};
  for (std::size_t k = 0; k < found.subsets; ++k) {
    table.rows.push_back(subset_row(result, r, (r * found.sizes + z) * found.subsets + k));
  }
  return table;
}

/// Whether a source alone does nothing at any pose, at any size, to one of the responses shown.
bool does_nothing(const StoredResult& result, const std::string& source) {
  const StoredCoupling& stored = coupling_of(result);
  const CouplingResult& found = stored.found;
  const auto k = static_cast<std::size_t>(std::ranges::find(stored.subsets, source) - stored.subsets.begin());
  if (k == found.subsets) return false;
  return std::ranges::any_of(result.signed_headline, [&](std::size_t r) {
    for (std::size_t z = 0; z < found.sizes; ++z) {
      if (!(found.effect_max[(r * found.sizes + z) * found.subsets + k] <= rounding_at(stored, z))) return false;
    }
    return true;
  });
}

/// Whether each limb has the same errors, as the stored study, complete as it is, says.
bool same_in_all_limbs(const StoredResult& result) {
  return study_setting(result.study_text, "analysis", "limbs") == "\"all\"";
}

std::vector<std::string> notes(const StoredResult& result) {
  const StoredCoupling& stored = coupling_of(result);
  std::vector<std::string> list{
      fmt::format("{} of errors, alone and together; largest values over {}",
                  counted(stored.sources.size(), "source", "sources"), counted(stored.found.poses, "pose", "poses")),
      "interaction: together minus the sum of each alone",
      "opposed: share of the poses where the sum is less than its largest part, cancellation: by how much at most; a "
      "norm, which has no sign, cannot tell"};
  const std::vector<std::uint64_t>& count = stored.found.count;
  if (std::ranges::any_of(count, [&](std::uint64_t poses) { return poses < stored.found.poses; })) {
    list.emplace_back("some subsets leave out poses that were not solved: see the export's coupling_summary.csv");
  }
  if (same_in_all_limbs(result) &&
      std::ranges::any_of(stored.sources, [&](const std::string& source) { return does_nothing(result, source); })) {
    list.emplace_back(
        "all limbs have the same error here, so sources that are symmetric cancel; limbs = \"independent\" "
        "shows what they can do");
  }
  return list;
}

}  // namespace

std::vector<Table> coupling_tables(const StoredResult& result, const TableOptions&) {
  std::vector<Table> tables;
  for (std::size_t z = 0; z < coupling_of(result).found.sizes; ++z) {
    for (const std::size_t r : result.signed_headline) tables.push_back(response_table(result, z, r));
  }
  if (!tables.empty()) tables.back().notes = notes(result);
  return tables;
}

}  // namespace poesy
