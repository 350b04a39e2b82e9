#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/report/display.h"
#include "engine/report/html/comparison.h"
#include "engine/report/html/glossary.h"
#include "engine/report/html/outcomes.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/pose_order.h"
#include "engine/report/html/study_facts.h"
#include "engine/report/html/warnings.h"
#include "engine/report/html/what_was_run.h"
#include "engine/report/ranking.h"
#include "engine/report/tables.h"
#include "engine/report/two_rankings.h"
#include "engine/stats/rounding.h"

namespace poesy {
namespace {

bool same_poses(const StoredResult& a, const StoredResult& b) {
  if (a.poses.size() != b.poses.size() || a.poses.coordinates() != b.poses.coordinates()) return false;
  for (std::size_t c = 0; c < a.poses.coordinates(); ++c) {
    if (a.poses.column(c) != b.poses.column(c)) return false;
  }
  return true;
}

/// Local index x sigma of B less that of A, of the errors that both have, [rows x M].
std::vector<double> local_differences(const StoredResult& a, const StoredResult& b, const Common& factors,
                                      std::pair<std::size_t, std::size_t> response) {
  const auto effect = [](const StoredResult& of, std::size_t r, std::size_t p, std::size_t m) {
    const double index = of.sensitivity.local[(r * of.factors.size() + p) * of.poses.size() + m];
    return without_rounding(of, index, r, p) * of.factor_sigma[p];
  };
  std::vector<double> list;
  for (const auto& [pa, pb] : factors) {
    const double sigma = std::max(a.factor_sigma[pa], b.factor_sigma[pb]);
    for (std::size_t m = 0; m < a.poses.size(); ++m) {
      const double difference = effect(b, response.second, pb, m) - effect(a, response.first, pa, m);
      list.push_back(std::abs(difference) < kIndexRounding * sigma ? 0.0 : difference);
    }
  }
  return list;
}

/// The errors that both have, the one that is most important in A first.
Common ranked_common(const StoredResult& a, const StoredResult& b) {
  Common factors = common(names_of(a.factors), names_of(b.factors));
  const std::vector<std::size_t> ranks = ranked_errors(a, default_ranking(a)).ranks;
  std::ranges::sort(factors, {}, [&](const auto& both) { return ranks[both.first]; });
  return factors;
}

/// Where indices differ, of results at the same poses.
void add_where(const StoredResult& a, const StoredResult& b, Page& page) {
  Section section("where", "Where in the workspace they differ");
  if (!same_poses(a, b)) {
    section.paragraph("A and B were not solved at the same poses, so they cannot be compared pose by pose.");
    page.sections.push_back(std::move(section));
    return;
  }
  ArrayPool& pool = page.figures.pool;
  const ShownCells shown = shown_cells(a);
  const Common factors = ranked_common(a, b);
  HeatMap map{{}, {}, "pose", column_coordinates(a, shown, pool), pose_numbers(shown, pool)};
  for (const auto& both : factors) map.rows.push_back(a.factors[both.first].name);
  std::vector<Field> fields;
  for (const auto& both : common(names_of(a.responses, shown.responses), names_of(b.responses))) {
    const std::size_t r = shown.responses[both.first];
    const NamedUnit& response = a.responses[r];
    const std::vector<double> values = local_differences(a, b, factors, {r, both.second});
    const ArrayName array = pool.add(fmt::format("difference/{}", r), shown.at_poses(values), display(response).si);
    if (map.layers.empty()) map.order = first_order(a, values);
    map.layers.push_back({"B - A, effect on " + response.name, unit_text(response), array, true});
    fields.push_back({map.layers.back().label, map.layers.back().unit, array, map.rows, true});
  }
  if (map.layers.empty()) return;
  section.paragraph("The effect of each error at each pose in B, less that in A.");
  if (!shown.note().empty()) section.paragraph(shown.note());
  add_figure(page, section, "heat", std::move(map),
             "A row for each error that both have, the most important in A first, a column for each pose.");
  add_figure(page, section, "workspace",
             WorkspaceMap{pose_coordinates(a, shown, pool), std::move(fields), pose_numbers(shown, pool)},
             "Each dot is a pose, coloured by what is chosen.");
  page.sections.push_back(std::move(section));
}

/// Their rankings beside each other.
void add_rankings(const ReportedResult& a, const ReportedResult& b, Page& page) {
  const RankedResult ranked_a{a.stored, a.path, default_ranking(a.stored)};
  const RankedResult ranked_b{b.stored, b.path, default_ranking(b.stored)};
  const TwoRankings rankings = two_rankings(ranked_a, ranked_b);
  Section section("rankings", "The two rankings");
  section.paragraph(ranked_text('A', ranked_a) + ".");
  section.paragraph(ranked_text('B', ranked_b) + ".");
  for (const std::string& remark : rankings.remarks) section.paragraph(remark);
  section.table(rankings.table);
  if (differ_in_metric(a.stored, b.stored)) {
    section.paragraph("Below, responses of the same name are compared. Two metrics do not mean the same by them.");
  }
  page.sections.push_back(std::move(section));
}

/// How the solves of both ended.
void add_unsolved(const ReportedResult& a, const ReportedResult& b, Page& page) {
  const SolveCounts of_a = sum_of(tally_of(a.stored).cells);
  const SolveCounts of_b = sum_of(tally_of(b.stored).cells);
  Table table{.name = "solves",
              .caption = "How the solves of A and B ended",
              .columns = {text_column("status", "status"), number_column("a", "solves of A"),
                          percent_column("share_a", "share"), number_column("b", "solves of B"),
                          percent_column("share_b", "share")},
              .rows = {},
              .notes = {}};
  const auto share = [](const SolveCounts& solves, std::size_t status) {
    return percent_cell(static_cast<double>(solves.by_status[status]) / static_cast<double>(solves.total()));
  };
  for (std::size_t status = 0; status < kStatusNames.size(); ++status) {
    table.rows.push_back({text_cell(kStatusNames[status]), count_cell(of_a.by_status[status]), share(of_a, status),
                          count_cell(of_b.by_status[status]), share(of_b, status)});
  }
  Section section("not-solved", "What was not solved");
  section.table(table);
  page.sections.push_back(std::move(section));
}

/// What both studies set where they differ (same: where they agree), in the order of A.
Table settings_table(const StoredResult& a, const StoredResult& b, bool same) {
  Table table{.name = same ? "settings_alike" : "settings",
              .caption = same ? "Settings that are the same" : "Settings that differ",
              .columns = {text_column("setting", "setting"), text_column("a", "A"), text_column("b", "B")},
              .rows = {},
              .notes = {}};
  const std::vector<StudySetting> of_a = study_settings(a.study_text);
  std::vector<StudySetting> of_b = study_settings(b.study_text);
  const auto add = [&](const std::string& name, const std::string& in_a, const std::string& in_b) {
    if ((in_a == in_b) == same) table.rows.push_back({text_cell(name), text_cell(in_a), text_cell(in_b)});
  };
  for (const StudySetting& setting : of_a) {
    const auto at = std::ranges::find(of_b, setting.name, &StudySetting::name);
    add(setting.name, setting.text, at == of_b.end() ? std::string() : at->text);
    if (at != of_b.end()) of_b.erase(at);
  }
  for (const StudySetting& setting : of_b) add(setting.name, {}, setting.text);
  return table;
}

/// What differs between the studies, which is why their numbers do.
void add_studies(const StoredResult& a, const StoredResult& b, Page& page) {
  Section section("studies", "How the studies differ");
  const Table differing = settings_table(a, b, false);
  if (differing.rows.empty()) {
    section.paragraph("Both studies have the same settings.");
  } else {
    section.table(differing);
  }
  section.folded("Settings that are the same in both", settings_table(a, b, true));
  page.sections.push_back(std::move(section));
}

std::string name_of(const ReportedResult& result) {
  return result.stored.title.empty() ? result.path : fmt::format("{} ({})", result.stored.title, result.path);
}

}  // namespace

Page comparison_page(std::span<const ReportedResult> results) {
  const ReportedResult& a = results[0];
  const ReportedResult& b = results[1];
  check_comparable(a.stored, a.path, b.stored, b.path);
  Page page;
  page.title = fmt::format("Two results of {} compared", a.stored.model);
  page.subtitle = fmt::format("A: {}; B: {}", name_of(a), name_of(b));
  for (const auto& [letter, result] : {std::pair(kLetters[0], &a), std::pair(kLetters[1], &b)}) {
    for (const std::string& warning : warnings(*result))
      page.warnings.push_back(fmt::format("{}: {}", letter, warning));
  }
  add_studies(a.stored, b.stored, page);
  add_responses(a.stored, page);
  const Comparison compared = comparison(a, b);
  if (a.stored.kind == "sensitivity") add_rankings(a, b, page);
  add_comparison(compared, page);
  if (a.stored.kind == "sensitivity") add_where(a.stored, b.stored, page);
  add_glossary(a.stored, page);
  add_unsolved(a, b, page);
  page.sections.push_back(what_was_run(results));
  return page;
}

}  // namespace poesy
