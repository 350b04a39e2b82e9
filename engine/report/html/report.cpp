#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "engine/base/contract.h"
#include "engine/model/calibrated.h"
#include "engine/report/display.h"
#include "engine/report/html/forces.h"
#include "engine/report/one_study.h"
#include "engine/report/report_kind.h"
#include "engine/study/mechanism_doubts.h"

namespace poesy {
namespace {

/// The condition number above which a report calls a pose close to singular. By default a study refuses poses above
/// 1e8.
constexpr double kIllConditioned = 1e4;

using Warnings = std::vector<std::string>;

void warn_of_changes(const ReportedResult& result, Warnings& list) {
  if (result.stored.changed) {
    list.push_back(fmt::format(
        "{} was changed since it was written: its content no longer has its hash, so these numbers may not be what was "
        "computed. 'poesy verify' says which hash it has now.",
        result.path));
  }
  if (result.stored.git_commit.ends_with("-dirty")) {
    list.push_back(fmt::format(
        "The program that computed this result was built from a source tree with changes of its own ({}), so its "
        "commit alone does not give the program again.",
        result.stored.git_commit));
  }
}

void warn_of_mechanism(const ReportedResult& result, Warnings& list) {
  if (result.model == nullptr || result.study == nullptr) return;
  for (const std::string& doubt : mechanism_doubts(result.study->mechanism, *result.model))
    list.push_back("The mechanism: " + doubt);
  if (const std::string doubt = zones_doubt(*result.study); !doubt.empty()) list.push_back("The errors: " + doubt);
}

void warn_of_workspace(const ReportKind& kind, const ReportedResult& result, Warnings& list) {
  if (result.study == nullptr || !kind.words(result.stored).own_poses) return;
  std::ranges::move(workspace_doubts(*result.study, result.stored.poses), std::back_inserter(list));
}

void warn_of_unsolved(const StoredResult& result, const SolveTally& tally, Warnings& list) {
  const SolveCounts total = tally.total();
  if (many_not_converged(result, total.not_converged(), total.total())) list.push_back(unsolved_text(result, tally));
  const std::optional<SecondFidelity>& second = tally.second;
  if (!second || !many_not_converged(result, second->not_converged, second->total)) return;
  list.push_back(fmt::format("{} of {} solves at fidelity \"{}\" ({}) did not converge.",
                             count_text(second->not_converged), count_text(second->total), second->second,
                             percent_text(share_of(second->not_converged, second->total))));
}

void warn_of_unsolved_poses(const SolveTally& tally, Warnings& list) {
  std::vector<std::string> poses;
  const std::vector<double> shares = tally.shares_by_pose();
  for (std::size_t m = 0; m < shares.size(); ++m) {
    if (shares[m] == 1.0) poses.push_back(std::to_string(m));
  }
  if (poses.empty()) return;
  list.push_back(fmt::format("Nothing was solved at {}: {}.", counted(poses.size(), "pose", "poses"),
                             "number " + some_names(poses)));
}

void warn_of_poses(const StoredResult& result, Warnings& list) {
  if (const std::string rejected = rejected_text(result); !rejected.empty()) {
    list.push_back(rejected + ".");
  }
  const auto ill = std::ranges::count_if(result.condition, [](double value) { return value > kIllConditioned; });
  if (ill == 0) return;
  const auto worst = std::ranges::max_element(result.condition);
  list.push_back(fmt::format(
      "{} close to singular: {} a condition number above {:.0e}, the largest is {:.3g} at {}. There small errors do "
      "much, and linear estimates say little.",
      ill == 1 ? "1 pose is" : fmt::format("{} poses are", ill), ill == 1 ? "it has" : "they have", kIllConditioned,
      *worst, place_text(result, static_cast<std::size_t>(worst - result.condition.begin()))));
}

void warn_of_fidelity(const StoredResult& result, const SolveTally& tally, Warnings& list) {
  if (tally.second && tally.second->not_linear > 0) {
    list.push_back(
        fmt::format("{} of {} errors are not linear at the size the study sets: fidelity \"{}\" does not "
                    "stand for \"{}\" there.",
                    tally.second->not_linear, tally.second->errors, tally.second->second, tally.second->first));
  }
  if (is_first_order(result)) {
    list.push_back(
        "The model was solved to first order in the errors. What grows with their square is not in these numbers; a "
        "sensitivity study that compares two fidelities shows how much that is.");
  }
}

void warn_of_calibration(const StoredResult& result, Warnings& list) {
  if (readable_setting(result.study_text, "analysis", "calibrated").empty()) return;
  list.push_back(fmt::format("Calibrated: responses are {}.", kLeftByCalibration));
}

/// The warnings for the reader of a result, each one or two sentences.
std::vector<std::string> warnings(const ReportKind& kind, const ReportedResult& result) {
  const StoredResult& stored = result.stored;
  const SolveTally tally = kind.tally(stored);
  Warnings list;
  warn_of_changes(result, list);
  warn_of_mechanism(result, list);
  warn_of_workspace(kind, result, list);
  warn_of_unsolved(stored, tally, list);
  warn_of_unsolved_poses(tally, list);
  warn_of_calibration(stored, list);
  if (kind.far_limits != nullptr) {
    for (const std::string& note : kind.far_limits(stored)) list.push_back(note + ".");
  }
  if (kind.warn != nullptr) kind.warn(stored, list);
  warn_of_poses(stored, list);
  warn_of_fidelity(stored, tally, list);
  return list;
}

/// The number of errors, for the subtitle: "41 errors, ", or "7 fitted errors, " if errors were fitted to measurements;
/// empty if there are none.
std::string errors_text(const ReportKind& kind, const StoredResult& result) {
  if (result.factors.empty()) return {};
  if (!kind.words(result).fitted) return counted(result.factors.size(), "error", "errors") + ", ";
  const Comparable fitted = kind.comparable(result, result);
  return counted(fitted.items.size(), fitted.item_word, fitted.item_word + "s") + ", ";
}

std::string subtitle(const ReportKind& kind, const StoredResult& result) {
  std::string text = fmt::format("{} of {}: {}", result.kind, result.model, errors_text(kind, result));
  text += counted(result.poses.size(), "pose", "poses");
  const RunFacts& run = result.facts;
  text += fmt::format(", {}", counted_samples(run.samples(), run.by_series));
  return result.metric.empty() ? text : text + "; metric: " + metric_text(result);
}

constexpr std::string_view kHowSure = "How sure";

/// The kind's summary of a result, with a sentence on how the solves ended appended to the line "How sure".
Answer answer(const ReportKind& kind, const StoredResult& result) {
  Answer lines = kind.answer(result);
  const auto sure = std::ranges::find(lines, kHowSure, &AnswerLine::first);
  if (sure == lines.end()) return lines;
  const SolveCounts solves = kind.tally(result).total();
  if (solves.total() == 0) return lines;
  const std::string all = counted_samples(solves.total(), solves.by_series());
  sure->second += solves.not_converged() == 0
                      ? fmt::format(" All {} converged.", all)
                      : fmt::format(" {} of {} {} ({}).", count_text(solves.not_converged()), all, why_unsolved(solves),
                                    percent_text(share_not_converged(solves)));
  return lines;
}

/// Adds to the page the section with pictures of the mechanism, the places of its errors, and the mechanism's file.
void add_mechanism(const ReportKind& kind, const ReportedResult& result, Page& page) {
  Section section("mechanism", "The mechanism");
  const ErrorShares shares = kind.error_shares == nullptr ? ErrorShares() : kind.error_shares(result.stored);
  const std::string design = kind.words(result.stored).design;
  if (has_pictures(result) && !design.empty()) section.paragraph("The picture shows the first design: " + design + ".");
  add_robot(result, shares, page, section);
  add_forces(kind, result, section);
  if (!result.stored.mechanism_text.empty()) section.folded_text("Its file", result.stored.mechanism_text);
  if (!section.body().empty()) page.sections.push_back(std::move(section));
}

/// Adds to the page the section with the features of the drawing, if there are any.
void add_features(std::span<const Table> tables, Page& page) {
  Section section("features", "The features of the drawing");
  section.table(tables, "features");
  if (!section.body().empty()) page.sections.push_back(std::move(section));
}

/// The page of a report on one result.
Page page_of(const ReportKind& kind, const ReportedResult& result) {
  Page page;
  const StoredResult& stored = result.stored;
  page.title = stored.title.empty() ? fmt::format("Study of {} ({})", stored.model, stored.kind) : stored.title;
  page.subtitle = subtitle(kind, result.stored);
  page.answer = answer(kind, result.stored);
  page.warnings = warnings(kind, result);
  add_responses(result.stored, page);
  add_mechanism(kind, result, page);
  const std::vector<Table> tables = result_tables(kind, result.stored, {default_ranking(result.stored)});
  add_features(tables, page);
  kind.page(result.stored, tables, page);
  if (kind.solved_page != nullptr && result.study != nullptr && has_pictures(result)) kind.solved_page(result, page);
  add_glossary(result.stored, page);
  add_outcomes(kind, result, page);
  add_what_was_run(kind, {&result, 1}, page);
  return page;
}

/// Adds to the page a table that shows how the solves of the results A and B ended.
void add_unsolved(const SolveCounts& of_a, const SolveCounts& of_b, Page& page) {
  Table table{.name = "solves",
              .caption = "How the solves of A and B ended",
              .columns = {text_column("status", "status"), number_column("a", "solves of A"),
                          percent_column("share_a", "share"), number_column("b", "solves of B"),
                          percent_column("share_b", "share")}};
  const auto share = [](const SolveCounts& solves, std::size_t status) {
    return percent_cell(share_of(solves.by_status[status], solves.total()));
  };
  for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
    table.rows.push_back({text_cell(kStatusNames[status]), count_cell(of_a.by_status[status]), share(of_a, status),
                          count_cell(of_b.by_status[status]), share(of_b, status)});
  }
  page.add_section("not-solved", "What was not solved").table(table);
}

std::string name_of(const ReportedResult& result) {
  return result.stored.title.empty() ? result.path : fmt::format("{} ({})", result.stored.title, result.path);
}

/// Adds to the page a section on which result is better, by how much, and whether this is certain.
void add_merits(std::span<const ReportedResult> results, std::span<const std::vector<Merit>> found, Page& page) {
  const std::optional<Table> table = merits_table(found);
  if (!table) return;
  Section& section = page.add_section("which-is-better", "Which is better");
  for (std::size_t n = 0; n < results.size(); ++n) {
    section.paragraph(fmt::format("{}: {}", letter_of(n), name_of(results[n])));
  }
  section.table(*table);
  for (std::size_t n = 1; n < results.size(); ++n) {
    const std::string sweep = sweep_text(results[0].stored, results[n].stored, letter_of(n));
    if (!sweep.empty()) section.paragraph(sweep);
  }
}

/// Adds to the page a section on the differences between the studies, because these explain differences between the
/// results.
void add_studies(std::span<const ReportedResult> results, Page& page) {
  Section& section = page.add_section("studies", "How the studies differ");
  const StoredResult& a = results.front().stored;
  for (std::size_t n = 1; n < results.size(); ++n) {
    const Table differing = settings_table(a, results[n].stored, n, false);
    if (differing.rows.empty()) {
      section.paragraph(fmt::format("The studies of A and {} have the same settings.", letter_of(n)));
    } else {
      section.table(differing);
    }
  }
  if (results.size() == 2) {
    section.folded("Settings that are the same in both", settings_table(a, results[1].stored, 1, true));
  }
}

/// The line "Answer" of a comparison by figures of merit. Empty if the results have no figure of merit in common.
Answer merits_answer(std::span<const std::vector<Merit>> found) {
  std::string text;
  for (std::size_t n = 1; n < found.size(); ++n) {
    const std::string sentences = merit_sentences(found.front(), found[n], letter_of(n));
    if (!sentences.empty()) text += (text.empty() ? "" : " ") + sentences;
  }
  return text.empty() ? Answer() : Answer{{"Answer", text}};
}

/// Adds to the page the comparison of two results by their items, such as errors.
void add_two(const ReportKind& kind, const ReportedResult& a, const ReportedResult& b, Page& page) {
  const Comparison compared = comparison(kind, a, b);
  for (auto& line : comparison_answer(compared)) {
    const bool known = line.first == "Answer" && !page.answer.empty();
    const std::string other = compared.a.ranked ? "Largest effects" : "Changes";
    page.answer.emplace_back(known ? other : line.first, std::move(line.second));
  }
  if (kind.compare != nullptr) {
    kind.compare(a, b, compared, page);
  } else {
    add_comparison(compared, page);
  }
}

/// The warnings of several results. Warnings with the same text become one: "A and B: The model was solved to first
/// order ...".
std::vector<std::string> common_warnings(const ReportKind& kind, std::span<const ReportedResult> results) {
  std::vector<std::pair<std::string, std::vector<char>>> list;  // texts, each with the letters of its results
  for (std::size_t n = 0; n < results.size(); ++n) {
    for (std::string& text : warnings(kind, results[n])) {
      auto at = std::ranges::find(list, text, [](const auto& one) { return one.first; });
      if (at == list.end()) at = list.insert(list.end(), {std::move(text), {}});
      if (at->second.empty() || at->second.back() != letter_of(n)) at->second.push_back(letter_of(n));
    }
  }
  std::vector<std::string> texts;
  for (const auto& [text, letters] : list) texts.push_back(fmt::format("{}: {}", fmt::join(letters, " and "), text));
  return texts;
}

/// The page of a report that compares two or more results.
Page comparison_page(const ReportKind& kind, std::span<const ReportedResult> results) {
  const ReportedResult& a = results.front();
  Page page;
  page.title = fmt::format("{} results compared", results.size() == 2 ? "Two" : std::to_string(results.size()));
  std::vector<const StoredResult*> stored;
  for (std::size_t n = 0; n < results.size(); ++n) {
    check_comparable(a.stored, a.path, results[n].stored, results[n].path);
    page.subtitle +=
        fmt::format("{}{}: {} of {}", n == 0 ? "" : "; ", letter_of(n), name_of(results[n]), results[n].stored.model);
    stored.push_back(&results[n].stored);
  }
  page.warnings = common_warnings(kind, results);
  const std::vector<std::vector<Merit>> found = compared_merits(kind, stored);
  page.answer = merits_answer(found);
  add_merits(results, found, page);
  add_studies(results, page);
  add_responses(a.stored, page);
  if (results.size() == 2) add_two(kind, a, results[1], page);
  add_glossary(a.stored, page);
  if (results.size() == 2) add_unsolved(kind.tally(a.stored).total(), kind.tally(*stored[1]).total(), page);
  add_what_was_run(kind, results, page);
  return page;
}

}  // namespace

std::string html_report(const ReportKind& kind, std::span<const ReportedResult> results) {
  POESY_EXPECTS(!results.empty());
  return html_document(results.size() == 1 ? page_of(kind, results.front()) : comparison_page(kind, results));
}

}  // namespace poesy
