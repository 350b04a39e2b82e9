#include "engine/report/html/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/contract.h"
#include "engine/report/display.h"
#include "engine/report/html/comparison.h"
#include "engine/report/html/sections.h"
#include "engine/report/study_settings.h"

namespace poesy {
namespace {

std::string subtitle(const StoredResult& result) {
  std::string text = fmt::format("{} of {}: ", result.kind, result.model);
  if (!result.factors.empty()) text += counted(result.factors.size(), "error", "errors") + ", ";
  text += counted(result.poses.size(), "pose", "poses");
  text += fmt::format(", {}", counted(result.facts.solves, "solve", "solves"));
  return result.metric.empty() ? text : text + "; metric: " + metric_text(result);
}

/// Of one result.
Page page_of(const ReportKind& kind, const ReportedResult& result) {
  Page page;
  page.title = result.stored.title.empty() ? result.path : result.stored.title;
  page.subtitle = subtitle(result.stored);
  page.warnings = warnings(kind, result);
  add_responses(result.stored, page);
  kind.page(result.stored, result_tables(kind, result.stored, {default_ranking(result.stored)}), page);
  add_glossary(result.stored, page);
  add_outcomes(kind, result, page);
  add_what_was_run(kind, {&result, 1}, page);
  return page;
}

/// How the solves of both ended.
void add_unsolved(const SolveCounts& of_a, const SolveCounts& of_b, Page& page) {
  Table table{.name = "solves",
              .caption = "How the solves of A and B ended",
              .columns = {text_column("status", "status"), number_column("a", "solves of A"),
                          percent_column("share_a", "share"), number_column("b", "solves of B"),
                          percent_column("share_b", "share")}};
  const auto share = [](const SolveCounts& solves, std::size_t status) {
    return percent_cell(static_cast<double>(solves.by_status[status]) / static_cast<double>(solves.total()));
  };
  for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
    table.rows.push_back({text_cell(kStatusNames[status]), count_cell(of_a.by_status[status]), share(of_a, status),
                          count_cell(of_b.by_status[status]), share(of_b, status)});
  }
  page.add_section("not-solved", "What was not solved").table(table);
}

/// Names and readable values, without those at the top: format and title.
std::vector<std::pair<std::string, std::string>> named_settings(const StoredResult& result) {
  std::vector<std::pair<std::string, std::string>> list;
  for (const StudySetting& one : study_settings(result.study_text)) {
    if (!one.section.empty()) list.emplace_back(one.section + "." + one.key, readable_setting(one.value));
  }
  return list;
}

/// What both studies set where they differ (same: where they agree), in the order of A.
Table settings_table(const StoredResult& a, const StoredResult& b, bool same) {
  Table table{.name = same ? "settings_alike" : "settings",
              .caption = same ? "Settings that are the same" : "Settings that differ",
              .columns = {text_column("setting", "setting"), text_column("a", "A"), text_column("b", "B")}};
  auto of_b = named_settings(b);
  const auto add = [&](const std::string& name, const std::string& in_a, const std::string& in_b) {
    if ((in_a == in_b) == same) table.rows.push_back({text_cell(name), text_cell(in_a), text_cell(in_b)});
  };
  for (const auto& [name, value] : named_settings(a)) {
    const auto at = std::ranges::find(of_b, name, [](const auto& setting) { return setting.first; });
    add(name, value, at == of_b.end() ? std::string() : at->second);
    if (at != of_b.end()) of_b.erase(at);
  }
  for (const auto& [name, value] : of_b) add(name, {}, value);
  return table;
}

/// What differs between the studies, which is why their numbers do.
void add_studies(const StoredResult& a, const StoredResult& b, Page& page) {
  Section& section = page.add_section("studies", "How the studies differ");
  const Table differing = settings_table(a, b, false);
  if (differing.rows.empty()) {
    section.paragraph("Both studies have the same settings.");
  } else {
    section.table(differing);
  }
  section.folded("Settings that are the same in both", settings_table(a, b, true));
}

std::string name_of(const ReportedResult& result) {
  return result.stored.title.empty() ? result.path : fmt::format("{} ({})", result.stored.title, result.path);
}

/// Of two results.
Page comparison_page(const ReportKind& kind, std::span<const ReportedResult> results) {
  const ReportedResult& a = results[0];
  const ReportedResult& b = results[1];
  check_comparable(a.stored, a.path, b.stored, b.path);
  Page page;
  page.title = fmt::format("Two results of {} compared", a.stored.model);
  page.subtitle = fmt::format("A: {}; B: {}", name_of(a), name_of(b));
  for (const auto& [letter, result] : {std::pair(kLetters[0], &a), std::pair(kLetters[1], &b)}) {
    for (const std::string& warning : warnings(kind, *result))
      page.warnings.push_back(fmt::format("{}: {}", letter, warning));
  }
  add_studies(a.stored, b.stored, page);
  add_responses(a.stored, page);
  const Comparison compared = comparison(kind, a, b);
  if (kind.compare != nullptr) {
    kind.compare(a, b, compared, page);
  } else {
    add_comparison(compared, page);
  }
  add_glossary(a.stored, page);
  add_unsolved(kind.tally(a.stored).total(), kind.tally(b.stored).total(), page);
  add_what_was_run(kind, results, page);
  return page;
}

}  // namespace

std::string html_report(const ReportKind& kind, std::span<const ReportedResult> results) {
  POESY_EXPECTS(results.size() == 1 || results.size() == 2);
  return html_document(results.size() == 1 ? page_of(kind, results.front()) : comparison_page(kind, results));
}

}  // namespace poesy
