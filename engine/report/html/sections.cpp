#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/report/display.h"
#include "engine/report/drawn_errors.h"
#include "engine/report/report_kind.h"

namespace poesy {
namespace {

/// The description of an error, a response or a coordinate as a sentence; "-" if it has none.
std::string sentence(const NamedUnit& thing) {
  std::string text = thing.description;
  if (text.empty()) return "-";
  if (text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text + (text.back() == '.' ? "" : ".");
}

Table table_of(std::string name, std::string word, std::string caption, const std::vector<NamedUnit>& things) {
  Table table{.name = std::move(name),
              .caption = std::move(caption),
              .columns = {text_column("name", std::move(word)), text_column("unit", "unit"),
                          text_column("description", "what it is")}};
  for (const NamedUnit& thing : things) {
    table.rows.push_back({text_cell(thing.name), text_cell(unit_text(thing)), text_cell(thing.description)});
  }
  return table;
}

Table status_table(const SolveCounts& solves, std::string_view at_fidelity) {
  Table table{.name = "solves",
              .caption = fmt::format("How samples{} ended", at_fidelity),
              .columns = {text_column("status", "status"), number_column("solves", "samples"),
                          percent_column("share", "share"), text_column("meaning", "meaning")}};
  for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
    const std::uint64_t count = solves.by_status[status];
    table.rows.push_back({text_cell(kStatusNames[status]), count_cell(count),
                          percent_cell(share_of(count, solves.total())), text_cell(kStatusMeanings[status])});
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

/// Adds to the page bars for the rows of the tally (SolveTally) in which solves did not converge, with the share of
/// these solves. Adds nothing if there is only one row.
void add_bars(const SolveTally& outcomes, Page& page, Section& section) {
  if (outcomes.names.size() < 2) return;
  const std::vector<double> shares = outcomes.shares_by_row();
  std::vector<std::string> names;
  std::vector<double> failing;
  for (std::size_t row = 0; row < shares.size(); ++row) {
    if (shares[row] == 0.0) continue;
    names.push_back(outcomes.names[row]);
    failing.push_back(shares[row]);
  }
  const std::size_t others = shares.size() - names.size();
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

/// A fact about a run: its label and its text. The text is empty if the fact is not known or does not apply.
using RunFact = std::pair<std::string, std::string>;

std::string setting(const StoredResult& result, std::string_view section, std::string_view key) {
  return readable_setting(result.study_text, section, key);
}

std::string poses_text(const StoredResult& result, const StudyWords& words) {
  std::string text = count_text(result.poses.size());
  if (!words.own_poses) return text + ", from a table";
  const std::string choice = setting(result, "poses", "select");
  if (!choice.empty()) text += ", " + choice;
  return result.time.empty() ? text
                             : text + fmt::format(", from {:.4g} to {:.4g} s", result.time.front(), result.time.back());
}

std::string samples_text(const StoredResult& result, const StudyWords& words) {
  if (!words.samples.empty()) return words.samples;
  const std::string fixed = setting(result, "analysis", "samples");
  if (!fixed.empty()) return fixed;
  const std::string least = setting(result, "analysis", "samples.min");
  if (least.empty()) return {};
  return fmt::format("adaptive, {} to {}, until intervals are within +-{} of their value", least,
                     setting(result, "analysis", "samples.max"), setting(result, "analysis", "samples.relative_error"));
}

std::string speed_text(const RunFacts& run) {
  if (!(run.wall_seconds > 0.0)) return {};
  const double speed = static_cast<double>(run.samples()) / run.wall_seconds;
  return count_text(static_cast<std::uint64_t>(std::llround(speed)));
}

/// The facts on how and where a result was made. Every result has the same labels in the same order.
std::vector<RunFact> run_facts(const ReportKind& kind, const ReportedResult& reported) {
  const StoredResult& result = reported.stored;
  const RunFacts& run = result.facts;
  const StudyWords words = kind.words(result);
  const bool by_reach = result.metric == "platform" || result.metric == "stiffness";
  const std::string tolerance_unit = by_reach ? "of the reach" : "rad, m";
  return {
      {"result file", reported.path},
      {"title", result.title},
      {"kind of study", result.kind},
      {"mechanism", result.model + (setting(result, "analysis", "calibrated").empty() ? "" : ", calibrated")},
      {"fidelity of the model", setting(result, "mechanism", "fidelity")},
      {"poses", poses_text(result, words)},
      {"errors", result.factors.empty() ? "" : count_text(result.factors.size())},
      {"sizes of the errors",
       fmt::format("{}", fmt::join(words.draws ? drawn_sizes(result, words) : words.sizes, "; "))},
      {"zones", words.draws ? setting(result, "errors", "zones") : ""},
      {"draws", words.draws ? setting(result, "analysis", "draws") : ""},
      {"samples at each pose", samples_text(result, words)},
      {"metric", metric_text(result)},
      {"solver", setting(result, "solver", "method")},
      {fmt::format("tolerance of the solver [{}]", tolerance_unit), setting(result, "solver", "tolerance")},
      {"most iterations", setting(result, "solver", "max_iterations")},
      {"samples not converged", setting(result, "solver", "not_converged")},
      {"seed", seed_text(result, words)},
      {"poesy", result.poesy_version},
      {"commit", result.git_commit},
      {"date (UTC)", run.created},
      {"machine", run.host},
      {"processor", run.cpu},
      {"threads", std::to_string(run.threads)},
      {"ranks", std::to_string(run.ranks)},
      {"wall time [s]", fmt::format("{:.2f}", run.wall_seconds)},
      {"solves", count_text(run.solves)},
      {"samples", count_text(run.samples())},
      {"samples per second", speed_text(run)},
      {"content hash (SHA-256)",
       result.content_sha256 + (result.changed ? " (the content no longer has this hash)" : "")},
  };
}

/// A table of facts. For one result it has all facts. For several results it has the facts in which they agree if
/// `same` is true, and otherwise those in which they differ.
Table facts_table(const ReportKind& kind, std::span<const ReportedResult> results, bool same) {
  const bool several = results.size() > 1;
  Table table{.name = same ? "what_was_run_alike" : "what_was_run",
              .caption = !several ? "What was run"
                         : same   ? "What is the same in all runs"
                                  : "What differs between the runs",
              .columns = {text_column("fact", "fact")}};
  std::vector<std::vector<RunFact>> facts;
  for (const ReportedResult& result : results) {
    const std::string letter = several ? std::string(1, letter_of(facts.size())) : "value";
    table.columns.push_back(text_column(letter, letter));
    facts.push_back(run_facts(kind, result));
  }
  for (std::size_t n = 0; n < facts.front().size(); ++n) {
    const auto as_first = [&](const std::vector<RunFact>& other) { return other[n].second == facts[0][n].second; };
    if (several && std::ranges::all_of(facts, as_first) != same) continue;
    std::vector<Cell>& row = table.rows.emplace_back();
    row.push_back(text_cell(facts.front()[n].first));
    for (const std::vector<RunFact>& of_result : facts) row.push_back(text_cell(of_result[n].second));
  }
  return table;
}

/// A text that says which settings the study in the report has, and which numbers came from tables.
std::string_view origin_text(const StudyWords& words) {
  if (!words.from_tables) {
    return "The study below holds every setting, those that its author left out among them. With the same program on "
           "the same kind of processor it gives the same numbers for any number of threads.";
  }
  return words.own_poses
             ? "The measurements came from a table, and are in the result file. The study below states all else: the "
               "errors that were fitted, the tolerances of all errors, and the poses at which the "
               "remaining displacement is predicted."
             : "Of the study below, mechanism and solver were used; poses and errors came from tables, and are in the "
               "result file.";
}

}  // namespace

void add_responses(const StoredResult& result, Page& page) {
  for (const NamedUnit& response : result.responses) page.figures.about.emplace(response.name, response.description);
  std::vector<std::size_t> shown = headline_order(result);
  for (const std::size_t r : result.signed_headline) {
    if (std::ranges::find(shown, r) == shown.end()) shown.push_back(r);
  }
  std::vector<std::pair<std::string, std::string>> list;
  for (const std::size_t r : shown) list.emplace_back(result.responses[r].name, sentence(result.responses[r]));
  page.add_section("what-is-measured", "What is measured").definitions(list);
}

void add_glossary(const StoredResult& result, Page& page) {
  for (const NamedUnit& error : result.factors) page.figures.about.emplace(error.name, error.description);
  Section& section = page.add_section("names", "What the names mean");
  section.table(table_of("coordinates", "coordinate", "Coordinates of a pose", result.pose_coordinates));
  section.table(table_of("errors", "error", "Errors", result.factors));
  if (const auto measured = measured_table(result)) section.table(*measured);
  if (const auto stated = stated_table(result)) section.table(*stated);
}

void add_outcomes(const ReportKind& kind, const ReportedResult& result, Page& page) {
  const StoredResult& stored = result.stored;
  const SolveTally outcomes = kind.tally(stored);
  const SolveCounts total = outcomes.total();
  if (total.total() == 0 && !outcomes.second) return;  // a calibration of a machine does not count its solves
  const std::string at_first = at_first_fidelity(outcomes);
  Section& section = page.add_section("not-solved", "What was not solved");
  if (total.not_converged() == 0) {
    section.paragraph(fmt::format("All {}{} converged.", counted_samples(total.total(), total.by_series()), at_first));
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

void add_what_was_run(const ReportKind& kind, std::span<const ReportedResult> results, Page& page) {
  const StoredResult& first = results.front().stored;
  Section& section = page.add_section("what-was-run", "What was run");
  section.paragraph(std::string(origin_text(kind.words(first))));
  section.table(facts_table(kind, results, false));
  if (results.size() > 1) section.folded("What is the same in all", facts_table(kind, results, true));
  for (std::size_t n = 0; n < results.size(); ++n) {
    const std::string name = results.size() > 1 ? fmt::format("The study of {}", letter_of(n)) : "The study";
    section.folded_text(name + ", resolved", results[n].stored.study_text);
  }
}

}  // namespace poesy
