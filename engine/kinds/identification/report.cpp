#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "engine/kinds/identification/identification.h"
#include "engine/kinds/identification/kind.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy::identification {
namespace {

constexpr std::string_view kAlone = "deforms alone";
constexpr std::string_view kCoupled = "deforms in a coupling";
constexpr std::string_view kAbsorbed = "absorbed";

std::string_view verdict(const Result& found, std::size_t p) {
  if (found.single(p) != 0) return kAlone;
  return found.coupled(p) != 0 ? kCoupled : kAbsorbed;
}

bool groups_agree(const Result& found) {
  for (std::size_t g = 0; g < found.groups(); ++g) {
    if (!std::ranges::equal(found.coupled_by_group.row(g), found.coupled)) return false;
    if (!std::ranges::equal(found.single_by_group.row(g), found.single)) return false;
  }
  return true;
}

std::vector<std::string> notes(const Result& found) {
  std::vector<std::string> list{
      fmt::format("under each group of sizes: poses where the error alone deforms, of {}; {} decide, rounding ends at "
                  "{:.3g}",
                  found.poses, found.required_poses, found.rounding)};
  if (!groups_agree(found)) list.push_back("the groups do not agree: see the export's identification.csv");
  return list;
}

Table verdict_table(const StoredResult& result) {
  const Result& found = identification_of(result);
  Table table{
      .name = "identification",
      .caption = fmt::format("{} of {} errors deform alone, {} with couplings", std::ranges::count(found.single, 1),
                             found.factors(), std::ranges::count(found.coupled, 1)),
      .columns = {},
      .notes = notes(found)};
  std::vector<FilledColumn> columns{
      name_column(result.factors, "error"),
      {text_column("verdict", "verdict"), [&](std::size_t p) { return text_cell(verdict(found, p)); }}};
  for (std::size_t g = 0; g < found.groups(); ++g) {
    columns.push_back({number_column(fmt::format("deforming_poses_{}", g + 1), identification_of(result).sizes[g].name,
                                     "", static_cast<int>(g)),
                       [&, g](std::size_t p) { return count_cell(found.poses - found.single_below(g, p)); }});
  }
  fill(table, positions(found.factors()), columns);
  return table;
}

Table coupling_rows(const StoredResult& result) {
  Table table{.name = "couplings",
              .caption = "Errors that deform together and not alone",
              .columns = {text_column("error", "error"), text_column("with", "with"), text_column("group", "group"),
                          number_column("deforming_poses", "poses")},
              .notes = {fmt::format("poses: where the two deform, of {}", identification_of(result).poses)}};
  for (const Coupling& coupling : identification_of(result).couplings) {
    table.rows.push_back(
        {text_cell(result.factors[coupling.first].name), text_cell(result.factors[coupling.second].name),
         text_cell(identification_of(result).sizes[coupling.group].name), count_cell(coupling.deforming_poses)});
  }
  return table;
}

std::vector<std::string> group_names(const StoredResult& result) {
  std::vector<std::string> names;
  for (const ErrorSize& group : identification_of(result).sizes) names.push_back(group.name);
  return names;
}

/// Converts numbers of poses to shares of all poses. If `but_these` is true, the share is that of the other poses.
std::vector<double> share_of_poses(const Result& found, const Result::ByGroup<std::uint64_t>& counts, bool but_these) {
  std::vector<double> list;
  for (const std::uint64_t count : counts) {
    const std::uint64_t those = but_these ? found.poses - count : count;
    list.push_back(static_cast<double>(those) / static_cast<double>(found.poses));
  }
  return list;
}

/// [groups x errors] The largest deformation by each error alone, divided by the largest deformation by any error at
/// the same pair of sizes. 0 if the deformation is only rounding, NaN if it is unknown.
std::vector<double> relative_deformations(const Result& found) {
  std::vector<double> list;
  for (std::size_t g = 0; g < found.groups(); ++g) {
    const std::span<const double> all = found.single_max.row(g);
    const double most =
        std::accumulate(all.begin(), all.end(), 0.0, [](double a, double b) { return std::fmax(a, b); });
    for (const double one : all) list.push_back(one <= found.rounding ? 0.0 : one / most);
  }
  return list;
}

/// Returns true if some share is neither 0 nor 1. If all are 0 or 1, they say no more than the verdicts.
bool differ_by_pose(std::span<const double> shares) {
  return std::ranges::any_of(shares, [](double share) { return share > 0.0 && share < 1.0; });
}

Bars bars_of(const StoredResult& result, ArrayPool& pool) {
  const Result& found = identification_of(result);
  Bars bars{{{"size of the errors", group_names(result)}}, {}, names_of(result.factors)};
  const auto add = [&](std::string label, const std::string& array, const std::vector<double>& shares) {
    bars.quantities.push_back({std::move(label), std::vector<std::vector<std::string>>(found.groups(), {"%"}),
                               pool.add(array, shares, 0.01)});
  };
  const auto add_poses = [&](std::string label, const std::string& array, const std::vector<double>& shares) {
    if (differ_by_pose(shares)) add(std::move(label), array, shares);
  };
  add("largest deformation by the error alone, relative to the largest of all errors", "single_max",
      relative_deformations(found));
  add_poses("poses where the errors of its frame deform together", "coupled",
            share_of_poses(found, found.coupled_below, true));
  add_poses("poses where leaving it out of them takes nine tenths away", "coupled_reduced",
            share_of_poses(found, found.coupled_reduced, false));
  return bars;
}

void add_page(const StoredResult& result, std::span<const Table> tables, Page& page) {
  const Result& found = identification_of(result);
  Section& section = page.add_section("which-errors-deform", "Which errors deform the mechanism");
  section.paragraph(fmt::format(
      "Each error was set alone, and then together with those of its frame that do not deform alone, at {}. An error "
      "is harmless where nothing deforms by more than {:.3g}, which is rounding, at {} of the {} poses; a pose that "
      "was "
      "not solved counts as deformed.",
      counted(found.groups(), "size", "sizes"), found.rounding, count_text(found.required_poses),
      count_text(found.poses)));
  add_figure(page, section, "deforming", bars_of(result, page.figures.pool),
             "How much each error deforms the mechanism alone, over the poses. An error with 0 is absorbed, or "
             "deforms only together with another.");
  for (const Table& table : tables) section.table(table);
}

/// The names of the errors whose verdict is `what`.
std::vector<std::string> errors_that(const StoredResult& result, std::string_view what) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < identification_of(result).factors(); ++p) {
    if (verdict(identification_of(result), p) == what) names.push_back(result.factors[p].name);
  }
  return names;
}

Answer answer(const StoredResult& result) {
  const Result& found = identification_of(result);
  const std::vector<std::string> alone = errors_that(result, kAlone);
  const std::vector<std::string> coupled = errors_that(result, kCoupled);
  const std::vector<std::string> absorbed = errors_that(result, kAbsorbed);
  Answer lines{{"Answer", fmt::format("{} of {} deform the mechanism alone, {} more in a coupling; {} absorbed.",
                                      alone.size(), counted(found.factors(), "error", "errors"), coupled.size(),
                                      counted(absorbed.size(), "is", "are"))}};
  if (!coupled.empty()) lines.emplace_back("In couplings", some_names(coupled) + ".");
  if (!absorbed.empty()) lines.emplace_back("Absorbed", some_names(absorbed) + ".");
  lines.emplace_back("How sure", fmt::format("Solved, not sampled, at {}: {} decide. The {} of errors {}.",
                                             counted(found.poses, "pose", "poses"), count_text(found.required_poses),
                                             counted(found.groups(), "size", "sizes"),
                                             groups_agree(found) ? "agree" : "do not agree on all errors"));
  lines.emplace_back(kWhatToDo,
                     "Tolerances of errors that are absorbed do not load the mechanism. A sensitivity study with "
                     "factors = \"deforming\" says how much each of the others does.");
  return lines;
}

SolveTally tally(const StoredResult& result) { return {"", {"all errors"}, 1, {identification_of(result).solves}}; }

Comparable comparable(const StoredResult& result, const StoredResult&) {
  const Result& found = identification_of(result);
  std::vector<double> percent;
  for (const std::uint64_t below : found.single_below) {
    percent.push_back(100.0 - 100.0 * static_cast<double>(below) / static_cast<double>(found.poses));
  }
  return {.option_word = "size of the errors",
          .options = group_names(result),
          .item_word = "error",
          .items = names_of(result.factors),
          .quantities = {{"poses where the error deforms alone", "deforms",
                          std::vector<std::vector<std::string>>(found.groups(), {"%"}), std::move(percent)}}};
}

std::vector<Table> identification_tables(const StoredResult& result, const TableOptions&) {
  std::vector<Table> tables{verdict_table(result)};
  if (!identification_of(result).couplings.empty()) tables.push_back(coupling_rows(result));
  return tables;
}

}  // namespace

constinit const ReportKind kReport{
    .tally = tally,
    .tables = identification_tables,
    .words = [](const StoredResult& result) { return StudyWords{.sizes = group_names(result)}; },
    .answer = answer,
    .shown_cells = [](const StoredResult& result) { return shown_cells(result, kSummaryRows); },
    .page = add_page,
    .comparable = comparable};

}  // namespace poesy::identification
