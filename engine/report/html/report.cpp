#include "engine/report/html/report.h"

#include <fmt/format.h>

#include "engine/base/contract.h"
#include "engine/report/display.h"
#include "engine/report/html/comparison.h"
#include "engine/report/html/glossary.h"
#include "engine/report/html/outcomes.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/sections.h"
#include "engine/report/html/warnings.h"
#include "engine/report/html/what_was_run.h"

namespace poesy {
namespace {

std::string subtitle(const StoredResult& result) {
  std::string text = fmt::format("{} of {}: ", result.kind, result.model);
  if (!result.factors.empty()) text += counted(result.factors.size(), "error", "errors") + ", ";
  text += counted(result.poses.size(), "pose", "poses");
  text += fmt::format(", {}", counted(result.facts.solves, "solve", "solves"));
  return result.metric.empty() ? text : text + "; metric: " + metric_text(result);
}

void add_sections_of_kind(const StoredResult& result, Page& page) {
  if (result.kind == "sensitivity") return add_sensitivity(result, page);
  if (result.kind == "monte-carlo") return add_monte_carlo(result, page);
  if (result.kind == "identification") return add_identification(result, page);
  if (result.kind == "coupling") return add_coupling(result, page);
  add_evaluation(result, page);
}

Page page_of(const ReportedResult& result) {
  Page page;
  page.title = result.stored.title.empty() ? result.path : result.stored.title;
  page.subtitle = subtitle(result.stored);
  page.warnings = warnings(result);
  add_responses(result.stored, page);
  add_sections_of_kind(result.stored, page);
  add_glossary(result.stored, page);
  add_outcomes(result, page);
  page.sections.push_back(what_was_run({&result, 1}));
  return page;
}

}  // namespace

std::string html_report(std::span<const ReportedResult> results) {
  POESY_EXPECTS(results.size() == 1 || results.size() == 2);
  return html_document(results.size() == 1 ? page_of(results.front()) : comparison_page(results));
}

}  // namespace poesy
