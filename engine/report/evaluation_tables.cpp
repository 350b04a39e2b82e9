#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/io/row_outcomes.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"
#include "engine/report/tolerance_table.h"

namespace poesy {
namespace {

constexpr int kDigits = 6;

/// Mean and extremes of a response over the solved samples; NaN where none is.
struct Summary {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double smallest = mean;
  double largest = mean;
};

Summary summary(const EvaluationResult& found, std::size_t r) {
  const std::size_t all = found.poses * found.samples;
  double sum = 0.0;
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  std::size_t count = 0;
  for (std::size_t n = 0; n < all; ++n) {
    if (!solved(found.status[n])) continue;
    const double value = found.response[r * all + n];
    sum += value;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
    ++count;
  }
  return count == 0 ? Summary() : Summary{sum / static_cast<double>(count), smallest, largest};
}

/// "; 38 of 40 pass" where the study limits the response.
std::string passes(const StoredResult& result, std::size_t r) {
  if (!result.evaluation.verdicts) return {};
  const std::vector<LimitVerdict>& limits = result.evaluation.verdicts->limits;
  const auto verdict = std::ranges::find(limits, r, &LimitVerdict::response);
  return verdict == limits.end() ? "" : fmt::format("; {} of {} pass", verdict->within, verdict->tried);
}

/// "part 17 is worst in linear_deformation: 0.123 mm at pose 4; 38 of 40 pass". Empty where rows have no labels or none
/// was solved.
std::string worst_note(const StoredResult& result, std::size_t r) {
  if (result.labels.names.empty()) return {};
  const std::vector<RowOutcome> outcomes = row_outcomes(result, r);
  const std::size_t worst = worst_row(outcomes);
  if (worst == outcomes.size()) return {};
  const NamedUnit& response = result.responses[r];
  return fmt::format("{} {} is worst in {}: {} at {}{}", result.labels.column, result.labels.names[worst],
                     response.name, response_text(response, outcomes[worst].extreme),
                     place_text(result, outcomes[worst].pose), passes(result, r));
}

/// One line of parts_table. outcomes: for each response of the headline.
std::vector<Cell> part_row(const StoredResult& result, const std::vector<std::vector<RowOutcome>>& outcomes,
                           std::size_t row) {
  std::vector<Cell> cells{text_cell(result.labels.names[row])};
  cells.push_back(count_cell(outcomes.empty() ? 0 : outcomes.front()[row].solved));
  for (std::size_t h = 0; h < outcomes.size(); ++h) {
    const RowOutcome& outcome = outcomes[h][row];
    const double unit = display(result.responses[result.headline[h]]).si;
    cells.push_back(number_cell(outcome.mean / unit, kDigits));
    cells.push_back(number_cell(outcome.extreme / unit, kDigits));
    cells.push_back(outcome.solved == 0 ? text_cell("") : count_cell(outcome.pose));
  }
  return cells;
}

}  // namespace

Table evaluation_table(const StoredResult& result) {
  Table table{
      .name = "evaluation",
      .caption = "Responses over all samples that were solved",
      .columns = {text_column("response", "response"), text_column("unit", "unit"), number_column("mean", "mean"),
                  number_column("smallest", "smallest"), number_column("largest", "largest")},
      .rows = {},
      .notes = {}};
  for (const std::size_t r : result.headline) {
    const Unit& unit = display(result.responses[r]);
    const Summary found = summary(result.evaluation, r);
    table.rows.push_back({text_cell(result.responses[r].name), text_cell(unit.name),
                          number_cell(found.mean / unit.si, kDigits), number_cell(found.smallest / unit.si, kDigits),
                          number_cell(found.largest / unit.si, kDigits)});
    if (std::string note = worst_note(result, r); !note.empty()) table.notes.push_back(std::move(note));
  }
  return table;
}

std::optional<Table> parts_table(const StoredResult& result) {
  const RowLabels& labels = result.labels;
  if (labels.names.empty()) return std::nullopt;
  Table table{.name = "parts",
              .caption = "Each " + labels.column + " over its poses: mean, and the value of the largest magnitude",
              .columns = {text_column("label", labels.column), number_column("poses", "poses")},
              .rows = {},
              .notes = {"poses: those that were solved"}};
  std::vector<std::vector<RowOutcome>> outcomes;
  for (const std::size_t r : result.headline) {
    const NamedUnit& response = result.responses[r];
    const std::string_view unit = display(response).name;
    const int dispensable = 3 * static_cast<int>(outcomes.size());  // the last response's columns go first
    table.columns.push_back(number_column(response.name + "_mean", response.name + " mean", unit, dispensable + 2));
    table.columns.push_back(number_column(response.name + "_extreme", response.name + " extreme", unit, dispensable));
    table.columns.push_back(number_column(response.name + "_extreme_pose", "at pose", "", dispensable + 1));
    outcomes.push_back(row_outcomes(result, r));
  }
  for (std::size_t row = 0; row < labels.names.size(); ++row) {
    table.rows.push_back(part_row(result, outcomes, row));
  }
  return table;
}

Table cases_table(const StoredResult& result) {
  const CaseResult& found = result.case_result;
  Table table{.name = "cases",
              .caption = "Each case over its poses: mean and largest value of the responses",
              .columns = {text_column("case", "case"), number_column("poses", "poses")},
              .rows = {},
              .notes = {"poses: those whose solve counts"}};
  int dispensable = 0;  // of the first response's columns; the last response's go first
  for (const std::size_t r : result.headline) {
    const NamedUnit& response = result.responses[r];
    const std::string_view unit = display(response).name;
    table.columns.push_back(number_column(response.name + "_mean", response.name + " mean", unit, dispensable));
    table.columns.push_back(
        number_column(response.name + "_max", response.name + " max", unit, dispensable == 0 ? 0 : dispensable + 1));
    dispensable += 2;
  }
  for (std::size_t c = 0; c < result.cases.size(); ++c) {
    std::vector<Cell> row{text_cell(result.cases[c]), count_cell(found.count[c])};
    for (const std::size_t r : result.headline) {
      const std::size_t at = r * result.cases.size() + c;
      const double unit = display(result.responses[r]).si;
      row.push_back(number_cell(found.mean[at] / unit, kDigits));
      row.push_back(number_cell(found.max[at] / unit, kDigits));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace poesy
