#include <fmt/format.h>

#include "engine/report/display.h"
#include "engine/report/html/sections.h"

namespace poesy {
namespace {

Table status_table(const SolveCounts& solves, std::string_view at_fidelity) {
  Table table{.name = "solves",
              .caption = fmt::format("How the solves{} ended", at_fidelity),
              .columns = {text_column("status", "status"), number_column("solves", "solves"),
                          percent_column("share", "share"), text_column("meaning", "meaning")}};
  for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
    const double share = static_cast<double>(solves.by_status[status]) / static_cast<double>(solves.total());
    table.rows.push_back({text_cell(kStatusNames[status]), count_cell(solves.by_status[status]), percent_cell(share),
                          text_cell(kStatusMeanings[status])});
  }
  return table;
}

Table failures_table(const ReportedResult& result) {
  Table table{.name = "failures",
              .caption = "Samples that did not converge, in the order of errors, poses and samples",
              .columns = {text_column("error", "error"), number_column("pose", "pose"), text_column("where", "where"),
                          number_column("sample", "sample"), text_column("status", "status"),
                          text_column("replay", "replay it with")},
              .notes = {fmt::format("At most {} of each error at a pose are listed, and {} in all.",
                                    FailedSamples::kMost, count_text(kMostFailuresListed))}};
  for (const Failure& failure : result.stored.failures) {
    const std::string& error = result.stored.varied[failure.slot];
    const std::uint64_t sample = failure.failed.sample.value;
    table.rows.push_back(
        {text_cell(error), count_cell(failure.pose.value),
         text_cell(coordinates_text(result.stored, failure.pose.value)), count_cell(sample),
         text_cell(kStatusNames[static_cast<std::size_t>(failure.failed.status)]),
         text_cell(fmt::format("poesy replay {} {} {} {}", result.path, error, failure.pose.value, sample))});
  }
  return table;
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

void add_figures(const ReportKind& kind, const StoredResult& result, const SolveTally& outcomes, Page& page,
                 Section& section) {
  add_bars(outcomes, page, section);
  if (outcomes.poses < 2 || outcomes.poses != result.poses.size()) return;
  const PoseFigures figures(result, kind.shown_cells(result), page);
  std::vector<Field> fields{figures.not_converged(outcomes.shares_by_pose())};
  figures.add_condition(fields);
  figures.add_workspace(section, std::move(fields), "Where solves did not converge: each dot is a pose.",
                        "not-converged-where");
}

}  // namespace

void add_outcomes(const ReportKind& kind, const ReportedResult& result, Page& page) {
  const StoredResult& stored = result.stored;
  const SolveTally outcomes = kind.tally(stored);
  const SolveCounts total = outcomes.total();
  const std::string at_first = at_first_fidelity(outcomes);
  Section& section = page.add_section("not-solved", "What was not solved");
  if (total.not_converged() == 0) {
    section.paragraph(fmt::format("All {} solves{} converged.", count_text(total.total()), at_first));
  } else {
    section.paragraph(unsolved_text(stored, outcomes) +
                      " Each is counted where it happened. Whether the numbers above leave such solves out is the "
                      "study's choice, not_converged under [solver].");
    if (many_not_converged(stored, total.not_converged(), total.total()))
      add_figures(kind, stored, outcomes, page, section);
  }
  if (const std::optional<SecondFidelity>& second = outcomes.second) {
    const std::string solves = count_text(second->total);
    section.paragraph(
        second->not_converged == 0
            ? fmt::format("All {} solves at fidelity \"{}\" converged.", solves, second->second)
            : fmt::format(
                  "At fidelity \"{}\", {} of {} solves did not converge: what is said of it rests on the others.",
                  second->second, count_text(second->not_converged), solves));
  }
  section.table(status_table(total, at_first));
  if (!stored.failures.empty()) {
    section.folded("Samples that did not converge, and how to replay them", failures_table(result));
  }
}

}  // namespace poesy
