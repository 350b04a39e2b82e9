#include "engine/report/html/outcomes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/report/display.h"
#include "engine/report/failure_share.h"
#include "engine/report/html/parts.h"
#include "engine/report/not_converged.h"

namespace poesy {
namespace {

/// What evaluations ended with, samples that are no cases together.
SolveTally evaluation_tally(const StoredResult& result) {
  const EvaluationResult& found = result.evaluation;
  SolveTally outcomes{"case", result.cases, found.poses, {}};
  if (result.cases.empty()) outcomes.names = {"all rows"};
  outcomes.cells.resize(outcomes.names.size() * found.poses);
  for (std::size_t m = 0; m < found.poses; ++m) {
    for (std::size_t s = 0; s < found.samples; ++s) {
      const std::size_t row = result.cases.empty() ? 0 : s;
      const std::size_t at = m * found.samples + s;
      outcomes.cells[row * found.poses + m].add(found.status[at], found.iterations[at]);
    }
  }
  return outcomes;
}

Table status_table(const SolveCounts& solves, std::string_view at_fidelity) {
  Table table{.name = "solves",
              .caption = fmt::format("How the solves{} ended", at_fidelity),
              .columns = {text_column("status", "status"), number_column("solves", "solves"),
                          percent_column("share", "share"), text_column("meaning", "meaning")},
              .rows = {},
              .notes = {}};
  constexpr std::string_view kMeanings[] = {
      "the change fell below the tolerance", "as exact as the arithmetic allows; counts as converged",
      "still changing after the most iterations allowed", "the equations have no unique solution",
      "a value overflowed or became undefined"};
  for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
    const double share = static_cast<double>(solves.by_status[status]) / static_cast<double>(solves.total());
    table.rows.push_back({text_cell(kStatusNames[status]), count_cell(solves.by_status[status]), percent_cell(share),
                          text_cell(kMeanings[status])});
  }
  return table;
}

Table failures_table(const ReportedResult& result) {
  Table table{.name = "failures",
              .caption = "Samples that did not converge, in the order of errors, poses and samples",
              .columns = {text_column("error", "error"), number_column("pose", "pose"), text_column("where", "where"),
                          number_column("sample", "sample"), text_column("status", "status"),
                          text_column("replay", "replay it with")},
              .rows = {},
              .notes = {fmt::format("At most {} of each error at a pose are listed, and {} in all.",
                                    FailedSamples::kMost, count_text(kMostFailuresListed))}};
  for (const Failure& failure : listed_failures(result.stored)) {
    const std::string error = varied_name(result.stored, failure.slot);
    const std::uint64_t sample = failure.failed.sample.value;
    table.rows.push_back(
        {text_cell(error), count_cell(failure.pose.value),
         text_cell(coordinates_text(result.stored, failure.pose.value)), count_cell(sample),
         text_cell(kStatusNames[static_cast<std::size_t>(failure.failed.status)]),
         text_cell(fmt::format("poesy replay {} {} {} {}", result.path, error, failure.pose.value, sample))});
  }
  return table;
}

std::string unsolved_text(const StoredResult& result, const SolveTally& outcomes, const SolveCounts& total) {
  const double share = share_not_converged(total);
  return fmt::format(
      "{} of {} solves{} ({}) did not converge.{}{} Each is counted where it happened. Whether the numbers above leave "
      "such solves out is the study's choice, not_converged under [solver].",
      count_text(total.not_converged()), count_text(total.total()), at_first_fidelity(result), percent_text(share),
      doubt_text(share), worst_text(result, outcomes));
}

/// Of the rows that have any.
void add_bars(const SolveTally& outcomes, Page& page, Section& section) {
  const std::vector<double> shares = outcomes.shares_by_row();
  std::vector<std::string> names;
  std::vector<double> failing;
  for (std::size_t row = 0; row < shares.size(); ++row) {
    if (shares[row] == 0.0) continue;
    names.push_back(outcomes.names[row]);
    failing.push_back(shares[row]);
  }
  if (outcomes.names.size() < 2) return;
  const std::size_t others = outcomes.names.size() - names.size();
  Bars bars{{}, {{"not converged", {{"%"}}, page.figures.pool.add("not_converged_rows", failing, 0.01)}}, names};
  add_figure(page, section, "not-converged", std::move(bars),
             fmt::format("Share of the solves of each {} that did not converge{}.", outcomes.row_word,
                         others == 0 ? "" : fmt::format("; {} more had none", count_text(others))));
}

void add_figures(const StoredResult& result, const SolveTally& outcomes, Page& page, Section& section) {
  ArrayPool& pool = page.figures.pool;
  add_bars(outcomes, page, section);
  if (outcomes.poses < 2 || outcomes.poses != result.poses.size()) return;
  const ShownCells shown = shown_cells(result);
  std::vector<Field> fields{
      pose_field("not_converged_poses", "not converged", "%", outcomes.shares_by_pose(), shown, pool, 0.01)};
  for (Field& field : condition_field(result, shown, pool)) fields.push_back(std::move(field));
  add_figure(page, section, "not-converged-where",
             WorkspaceMap{pose_coordinates(result, shown, pool), std::move(fields), pose_numbers(shown, pool)},
             "Where solves did not converge: each dot is a pose.");
}

}  // namespace

std::vector<double> SolveTally::shares() const {
  std::vector<double> list;
  list.reserve(cells.size());
  for (const SolveCounts& cell : cells) list.push_back(share_not_converged(cell));
  return list;
}

std::vector<double> SolveTally::shares_by_row() const {
  std::vector<double> list;
  for (std::size_t row = 0; row < names.size(); ++row) {
    list.push_back(share_not_converged(sum_of(std::span(cells).subspan(row * poses, poses))));
  }
  return list;
}

std::vector<double> SolveTally::shares_by_pose() const {
  std::vector<double> list;
  for (std::size_t m = 0; m < poses; ++m) {
    SolveCounts sum;
    for (std::size_t row = 0; row < names.size(); ++row) sum.merge(cells[row * poses + m]);
    list.push_back(share_not_converged(sum));
  }
  return list;
}

SolveTally tally_of(const StoredResult& result) {
  const std::size_t poses = result.poses.size();
  if (result.kind == "sensitivity") return {"error", names_of(result.factors), poses, result.sensitivity.solves};
  if (result.kind == "monte-carlo") return {"", {"all errors"}, poses, result.monte_carlo.solves};
  if (result.kind == "coupling") return {"size", result.coupling.size_names, poses, result.coupling.found.solves};
  if (result.kind == "identification") return {"", {"all errors"}, 1, {result.identification.solves}};
  return evaluation_tally(result);
}

std::optional<SecondFidelity> second_fidelity(const StoredResult& result) {
  const std::optional<FidelityResult>& compared = result.sensitivity.fidelity;
  if (!compared) return std::nullopt;
  SecondFidelity second{0, result.sensitivity.total().total()};
  for (const std::uint64_t count : compared->not_converged) second.not_converged += count;
  return second;
}

std::string at_first_fidelity(const StoredResult& result) {
  return result.sensitivity.fidelity ? fmt::format(" at fidelity \"{}\"", result.fidelities[0]) : std::string();
}

std::string worst_text(const StoredResult& result, const SolveTally& outcomes) {
  std::vector<std::string> places;
  const auto add = [&](const std::vector<double>& shares, const auto& name) {
    const auto at = std::ranges::max_element(shares, {}, [](double share) { return std::isnan(share) ? -1.0 : share; });
    places.push_back(fmt::format("{} {}", name(static_cast<std::size_t>(at - shares.begin())), percent_text(*at)));
  };
  if (outcomes.names.size() > 1) add(outcomes.shares_by_row(), [&](std::size_t row) { return outcomes.names[row]; });
  if (outcomes.poses > 1) add(outcomes.shares_by_pose(), [&](std::size_t m) { return place_text(result, m); });
  return places.empty() ? std::string() : fmt::format(" The largest shares: {}.", fmt::join(places, "; "));
}

std::string doubt_text(double share) {
  if (!(share > kManyNotConverged)) return {};
  return " That is more than 1 %: all numbers rest on the rest, and both ways of treating such solves are wrong where "
         "they are many. Left out, they make numbers too small, because they are mostly the large errors; included, "
         "they fill them with unfinished iterates.";
}

void add_outcomes(const ReportedResult& result, Page& page) {
  const SolveTally outcomes = tally_of(result.stored);
  const SolveCounts total = sum_of(outcomes.cells);
  const std::string at_first = at_first_fidelity(result.stored);
  Section section("not-solved", "What was not solved");
  if (total.not_converged() == 0) {
    section.paragraph(fmt::format("All {} solves{} converged.", count_text(total.total()), at_first));
  } else {
    section.paragraph(unsolved_text(result.stored, outcomes, total));
    if (many_not_converged(result.stored, total.not_converged(), total.total())) {
      add_figures(result.stored, outcomes, page, section);
    }
  }
  if (const auto second = second_fidelity(result.stored)) {
    const std::string solves = count_text(second->total);
    section.paragraph(
        second->not_converged == 0
            ? fmt::format("All {} solves at fidelity \"{}\" converged.", solves, result.stored.fidelities[1])
            : fmt::format(
                  "At fidelity \"{}\", {} of {} solves did not converge: what is said of it rests on the others.",
                  result.stored.fidelities[1], count_text(second->not_converged), solves));
  }
  section.table(status_table(total, at_first));
  if (!listed_failures(result.stored).empty()) {
    section.folded("Samples that did not converge, and how to replay them", failures_table(result));
  }
  page.sections.push_back(std::move(section));
}

}  // namespace poesy
