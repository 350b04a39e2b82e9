#include "engine/report/html/what_was_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/report/display.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/study_facts.h"

namespace poesy {
namespace {

class Facts {
 public:
  explicit Facts(const StoredResult& result) : study_(result.study_text) {}

  void add(std::string label, std::string text) {
    list_.push_back({std::move(label), text.empty() ? std::string("-") : std::move(text)});
  }
  void add_setting(std::string label, std::string_view section, std::string_view key) {
    add(std::move(label), readable_setting(study_, section, key));
  }
  std::string setting(std::string_view section, std::string_view key) const {
    return readable_setting(study_, section, key);
  }

  std::vector<RunFact> take() { return std::move(list_); }

 private:
  std::string_view study_;
  std::vector<RunFact> list_;
};

/// Whether poses and errors came from tables, as `poesy evaluate` takes them, and not from the study.
bool from_tables(const StoredResult& result) { return result.kind == "evaluate" && result.cases.empty(); }

/// Whether errors were drawn.
bool draws(const StoredResult& result) { return result.kind == "sensitivity" || result.kind == "monte-carlo"; }

std::string poses_text(const Facts& facts, const StoredResult& result) {
  std::string text = count_text(result.poses.size());
  if (from_tables(result)) return text + ", from a table";
  const std::string choice = facts.setting("poses", "select");
  if (!choice.empty()) text += ", " + choice;
  return result.time.empty() ? text
                             : text + fmt::format(", from {:.4g} to {:.4g} s", result.time.front(), result.time.back());
}

std::string samples_text(const Facts& facts, const StoredResult& result) {
  const std::string fixed = facts.setting("analysis", "samples");
  if (from_tables(result)) return counted(result.evaluation.samples, "row of errors", "rows of errors");
  if (result.kind == "evaluate") return counted(result.cases.size(), "case", "cases");
  if (!fixed.empty()) return fixed;
  const std::string least = facts.setting("analysis", "samples.min");
  if (least.empty()) return {};
  return fmt::format("adaptive, {} to {}, until intervals are within +-{} of their value", least,
                     facts.setting("analysis", "samples.max"), facts.setting("analysis", "samples.relative_error"));
}

/// The sizes of a coupling study or of an identification.
std::string sizes_text(const StoredResult& result) {
  std::vector<std::string> names = result.coupling.size_names;
  for (const ErrorSize& group : result.groups) names.push_back(group.name);
  return fmt::format("{}", fmt::join(names, "; "));
}

/// How many of the errors are not drawn as the others of their unit are.
std::string own_distributions_text(const Facts& facts, const StoredResult& result) {
  const auto own = std::ranges::count_if(
      result.factors, [&](const NamedUnit& factor) { return !facts.setting("errors.override", factor.name).empty(); });
  if (own == 0) return {};
  return fmt::format("{} of {} errors have a distribution of their own", own, result.factors.size());
}

/// The distributions from which errors were drawn.
void add_distributions(Facts& facts, const StoredResult& result) {
  const bool drawn = draws(result);
  facts.add("linear errors", drawn ? facts.setting("errors", "linear") : "");
  facts.add("angular errors", drawn ? facts.setting("errors", "angular") : "");
  facts.add("other errors", drawn ? own_distributions_text(facts, result) : "");
}

std::string speed_text(const RunFacts& facts) {
  if (!(facts.wall_seconds > 0.0)) return {};
  const double speed = static_cast<double>(facts.solves) / facts.wall_seconds;
  return count_text(static_cast<std::uint64_t>(std::llround(speed)));
}

void add_study(Facts& facts, const StoredResult& result) {
  facts.add("title", result.title);
  facts.add("kind of study", result.kind);
  facts.add("mechanism", result.model);
  facts.add_setting("fidelity of the model", "mechanism", "fidelity");
  facts.add("poses", poses_text(facts, result));
  facts.add("errors", result.factors.empty() ? "" : count_text(result.factors.size()));
  add_distributions(facts, result);
  facts.add("sizes of the errors", sizes_text(result));
  facts.add("samples at each pose", samples_text(facts, result));
  facts.add("metric", metric_text(result));
  facts.add_setting("solver", "solver", "method");
  const std::string_view of = result.metric == "platform" ? "of the reach" : "rad, m";
  facts.add_setting(fmt::format("tolerance of the solver [{}]", of), "solver", "tolerance");
  facts.add_setting("most iterations", "solver", "max_iterations");
  facts.add_setting("samples not converged", "solver", "not_converged");
  facts.add("seed", draws(result) ? facts.setting("run", "seed") : "");
}

void add_run(Facts& facts, const StoredResult& result) {
  const RunFacts& run = result.facts;
  facts.add("poesy", result.poesy_version);
  facts.add("commit", result.git_commit);
  facts.add("date (UTC)", run.created);
  facts.add("machine", run.host);
  facts.add("processor", run.cpu);
  facts.add("threads", std::to_string(run.threads));
  facts.add("ranks", std::to_string(run.ranks));
  facts.add("wall time [s]", fmt::format("{:.2f}", run.wall_seconds));
  facts.add("solves", count_text(run.solves));
  facts.add("solves per second", speed_text(run));
  facts.add("content hash (SHA-256)",
            result.content_sha256 + (result.changed ? " (the content no longer has this hash)" : ""));
}

/// The facts of one result, or of two where they agree (same) or do not.
Table facts_table(std::span<const ReportedResult> results, bool same) {
  const bool two = results.size() == 2;
  Table table{.name = same ? "what_was_run_alike" : "what_was_run",
              .caption = !two   ? "What was run"
                         : same ? "What is the same in both runs"
                                : "What differs between the runs",
              .columns = {text_column("fact", "fact")},
              .rows = {},
              .notes = {}};
  std::vector<std::vector<RunFact>> columns;
  for (const ReportedResult& result : results) columns.push_back(run_facts(result));
  for (std::size_t n = 0; n < results.size(); ++n) {
    const std::string letter = two ? std::string(kLetters[n]) : "value";
    table.columns.push_back(text_column(letter, letter));
  }
  for (std::size_t fact = 0; fact < columns.front().size(); ++fact) {
    std::vector<Cell> row{text_cell(columns.front()[fact].label)};
    for (const std::vector<RunFact>& column : columns) row.push_back(text_cell(column[fact].text));
    if (two && (columns[0][fact].text == columns[1][fact].text) != same) continue;
    table.rows.push_back(std::move(row));
  }
  return table;
}

constexpr std::string_view kOfStudies =
    "The study below holds every setting, those that its author left out among them. With the same program on the same "
    "kind of processor it gives the same numbers for any number of threads.";
constexpr std::string_view kOfTables =
    "Of the study below, mechanism and solver were used; poses and errors came from tables, and are in the result "
    "file.";

}  // namespace

std::vector<RunFact> run_facts(const ReportedResult& result) {
  Facts facts(result.stored);
  facts.add("result file", result.path);
  add_study(facts, result.stored);
  add_run(facts, result.stored);
  return facts.take();
}

Section what_was_run(std::span<const ReportedResult> results) {
  Section section("what-was-run", "What was run");
  section.paragraph(from_tables(results.front().stored) ? kOfTables : kOfStudies);
  section.table(facts_table(results, false));
  if (results.size() == 2) section.folded("What is the same in both", facts_table(results, true));
  for (std::size_t n = 0; n < results.size(); ++n) {
    const std::string name = results.size() == 2 ? fmt::format("The study of {}", kLetters[n]) : "The study";
    section.folded_text(name + ", resolved", results[n].stored.study_text);
  }
  return section;
}

}  // namespace poesy
