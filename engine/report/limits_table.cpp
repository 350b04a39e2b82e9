#include <fmt/format.h>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

constexpr int kDigits = 6;

std::string judged_by(const LimitVerdicts& verdicts) {
  if (!verdicts.judge) return "largest";
  if (*verdicts.judge == Judge::rms) return "rms";
  return percent_text(verdicts.share) + " of draws";
}

std::string rule(const LimitVerdicts& verdicts) {
  if (!verdicts.judge) {
    return "largest: the largest magnitude of any row of errors at any pose; a limit is kept if every row is within it "
           "at "
           "each pose; a pose that was not solved is not within it";
  }
  if (*verdicts.judge == Judge::rms) {
    return "rms: the root mean square over the draws of all poses; draws that were not solved are left out; within: "
           "the "
           "share of all draws that are within the limit";
  }
  return fmt::format(
      "value: within this magnitude stay {} of the draws at the worst pose; draws that were not solved stay within "
      "nothing; within: the share of the draws of all poses that are within the limit",
      percent_text(verdicts.share));
}

/// Where the value was found; empty where it is of all poses.
std::string place(const StoredResult& result, const LimitVerdict& verdict) {
  std::string text;
  if (verdict.row && !result.labels.names.empty()) {
    text = fmt::format("{} {}, ", result.labels.column, result.labels.names[*verdict.row]);
  } else if (verdict.row && result.pairing != Pairing::row_by_row) {
    text = result.cases.empty() ? fmt::format("sample {}, ", *verdict.row) : result.cases[*verdict.row] + ", ";
  }
  return verdict.pose ? text + place_text(result, *verdict.pose) : std::string();
}

}  // namespace

const std::optional<LimitVerdicts>& verdicts_of(const StoredResult& result) {
  return result.monte_carlo.verdicts ? result.monte_carlo.verdicts : result.evaluation.verdicts;
}

std::optional<Table> limits_table(const StoredResult& result) {
  const std::optional<LimitVerdicts>& verdicts = verdicts_of(result);
  if (!verdicts) return std::nullopt;
  std::size_t kept = 0;
  Table table{.name = "limits",
              .caption = {},
              .columns = {text_column("verdict", "limit kept"), text_column("response", "response"),
                          text_column("unit", "unit"), text_column("judged_by", "judged by"),
                          number_column("value", "value"), number_column("limit", "limit"),
                          percent_column("within", "within", 1), text_column("place", "where", 2)},
              .rows = {},
              .notes = {rule(*verdicts)}};
  for (const LimitVerdict& one : verdicts->limits) {
    const Unit& unit = display(result.responses[one.response]);
    const double share = static_cast<double>(one.within) / static_cast<double>(one.tried);
    kept += one.passed ? 1 : 0;
    table.rows.push_back({text_cell(one.passed ? "PASS" : "FAIL"), text_cell(result.responses[one.response].name),
                          text_cell(unit.name), text_cell(judged_by(*verdicts)),
                          number_cell(one.value / unit.si, kDigits), number_cell(one.limit / unit.si, kDigits),
                          percent_cell(share), text_cell(place(result, one))});
  }
  const std::size_t all = verdicts->limits.size();
  table.caption = kept == all ? fmt::format("PASS: {} kept", all == 1 ? "the limit is" : "all limits are")
                              : fmt::format("FAIL: {} of {} not kept", all - kept, counted(all, "limit", "limits"));
  return table;
}

}  // namespace poesy
