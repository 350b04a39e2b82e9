#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/report/display.h"
#include "engine/report/html/sections.h"
#include "engine/report/study_settings.h"

namespace poesy {
namespace {

/// A fact about a run with its label; empty where it is not known or does not apply.
using RunFact = std::pair<std::string, std::string>;

/// Reads settings of a result's study.
class Settings {
 public:
  explicit Settings(const StoredResult& result) : study_(result.study_text) {}

  std::string operator()(std::string_view section, std::string_view key) const {
    return readable_setting(study_, section, key);
  }

 private:
  std::string_view study_;
};

std::string poses_text(const Settings& setting, const StoredResult& result, const StudyWords& words) {
  std::string text = count_text(result.poses.size());
  if (words.from_tables) return text + ", from a table";
  const std::string choice = setting("poses", "select");
  if (!choice.empty()) text += ", " + choice;
  return result.time.empty() ? text
                             : text + fmt::format(", from {:.4g} to {:.4g} s", result.time.front(), result.time.back());
}

std::string samples_text(const Settings& setting, const StudyWords& words) {
  if (!words.samples.empty()) return words.samples;
  const std::string fixed = setting("analysis", "samples");
  if (!fixed.empty()) return fixed;
  const std::string least = setting("analysis", "samples.min");
  if (least.empty()) return {};
  return fmt::format("adaptive, {} to {}, until intervals are within +-{} of their value", least,
                     setting("analysis", "samples.max"), setting("analysis", "samples.relative_error"));
}

/// How many of the errors are not drawn as the others of their unit are.
std::string own_distributions_text(const Settings& setting, const StoredResult& result) {
  const auto own = std::ranges::count_if(
      result.factors, [&](const NamedUnit& factor) { return !setting("errors.override", factor.name).empty(); });
  if (own == 0) return {};
  return fmt::format("{} of {} errors have a distribution of their own", own, result.factors.size());
}

std::string speed_text(const RunFacts& run) {
  if (!(run.wall_seconds > 0.0)) return {};
  const double speed = static_cast<double>(run.solves) / run.wall_seconds;
  return count_text(static_cast<std::uint64_t>(std::llround(speed)));
}

/// How and where the result came into being: the same labels in the same order for every result.
std::vector<RunFact> run_facts(const ReportKind& kind, const ReportedResult& reported) {
  const StoredResult& result = reported.stored;
  const RunFacts& run = result.facts;
  const Settings setting(result);
  const StudyWords words = kind.words(result);
  const std::string tolerance_unit = result.metric == "platform" ? "of the reach" : "rad, m";
  return {
      {"result file", reported.path},
      {"title", result.title},
      {"kind of study", result.kind},
      {"mechanism", result.model},
      {"fidelity of the model", setting("mechanism", "fidelity")},
      {"poses", poses_text(setting, result, words)},
      {"errors", result.factors.empty() ? "" : count_text(result.factors.size())},
      {"linear errors", words.draws ? setting("errors", "linear") : ""},
      {"angular errors", words.draws ? setting("errors", "angular") : ""},
      {"other errors", words.draws ? own_distributions_text(setting, result) : ""},
      {"sizes of the errors", fmt::format("{}", fmt::join(words.sizes, "; "))},
      {"samples at each pose", samples_text(setting, words)},
      {"metric", metric_text(result)},
      {"solver", setting("solver", "method")},
      {fmt::format("tolerance of the solver [{}]", tolerance_unit), setting("solver", "tolerance")},
      {"most iterations", setting("solver", "max_iterations")},
      {"samples not converged", setting("solver", "not_converged")},
      {"seed", words.draws ? setting("run", "seed") : ""},
      {"poesy", result.poesy_version},
      {"commit", result.git_commit},
      {"date (UTC)", run.created},
      {"machine", run.host},
      {"processor", run.cpu},
      {"threads", std::to_string(run.threads)},
      {"ranks", std::to_string(run.ranks)},
      {"wall time [s]", fmt::format("{:.2f}", run.wall_seconds)},
      {"solves", count_text(run.solves)},
      {"solves per second", speed_text(run)},
      {"content hash (SHA-256)",
       result.content_sha256 + (result.changed ? " (the content no longer has this hash)" : "")},
  };
}

/// The facts of one result, or of two where they agree (same) or do not.
Table facts_table(const ReportKind& kind, std::span<const ReportedResult> results, bool same) {
  const bool two = results.size() == 2;
  Table table{.name = same ? "what_was_run_alike" : "what_was_run",
              .caption = !two   ? "What was run"
                         : same ? "What is the same in both runs"
                                : "What differs between the runs",
              .columns = {text_column("fact", "fact")}};
  std::vector<std::vector<RunFact>> facts;
  for (const ReportedResult& result : results) {
    const std::string letter(two ? kLetters[facts.size()] : "value");
    table.columns.push_back(text_column(letter, letter));
    facts.push_back(run_facts(kind, result));
  }
  for (std::size_t n = 0; n < facts.front().size(); ++n) {
    if (two && (facts[0][n].second == facts[1][n].second) != same) continue;
    std::vector<Cell>& row = table.rows.emplace_back();
    row.push_back(text_cell(facts.front()[n].first));
    for (const std::vector<RunFact>& of_result : facts) row.push_back(text_cell(of_result[n].second));
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

void add_what_was_run(const ReportKind& kind, std::span<const ReportedResult> results, Page& page) {
  const StoredResult& first = results.front().stored;
  Section& section = page.add_section("what-was-run", "What was run");
  section.paragraph(kind.words(first).from_tables ? kOfTables : kOfStudies);
  section.table(facts_table(kind, results, false));
  if (results.size() == 2) section.folded("What is the same in both", facts_table(kind, results, true));
  for (std::size_t n = 0; n < results.size(); ++n) {
    const std::string name = results.size() == 2 ? fmt::format("The study of {}", kLetters[n]) : "The study";
    section.folded_text(name + ", resolved", results[n].stored.study_text);
  }
}

}  // namespace poesy
