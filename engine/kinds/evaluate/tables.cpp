#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/evaluate/row_outcomes.h"
#include "engine/kinds/evaluate/stored.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"
#include "engine/run/evaluation.h"

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
  const LimitVerdict* verdict = verdict_on(result, r);
  return verdict == nullptr ? "" : fmt::format("; {} of {} pass", verdict->within, verdict->tried);
}

/// "part 17 is worst in linear_deformation: 0.123 mm at pose 4; 38 of 40 pass". Empty where rows have no labels or none
/// was solved.
std::string worst_note(const StoredResult& result, std::size_t r) {
  const RowLabels& labels = evaluation_of(result).labels;
  if (labels.names.empty()) return {};
  const std::vector<RowOutcome> outcomes = row_outcomes(evaluation_of(result), r);
  const std::size_t worst = worst_row(outcomes);
  if (worst == outcomes.size()) return {};
  const NamedUnit& response = result.responses[r];
  return fmt::format("{} {} is worst in {}: {} at {}{}", labels.column, labels.names[worst], response.name,
                     response_text(response, outcomes[worst].extreme), place_text(result, outcomes[worst].pose),
                     passes(result, r));
}

Table parts_table(const StoredResult& result) {
  const RowLabels& labels = evaluation_of(result).labels;
  Table table{.name = "parts",
              .caption = "Each " + labels.column + " over its poses: mean, and the value of the largest magnitude",
              .columns = {},
              .notes = {"poses: those that were solved"}};
  std::vector<std::vector<RowOutcome>> outcomes;  // of each response of the headline
  for (const std::size_t r : result.headline) outcomes.push_back(row_outcomes(evaluation_of(result), r));
  std::vector<FilledColumn> columns{
      {text_column("label", labels.column), [&](std::size_t row) { return text_cell(labels.names[row]); }},
      {number_column("poses", "poses"),
       [&](std::size_t row) { return count_cell(outcomes.empty() ? 0 : outcomes.front()[row].solved); }}};
  for (std::size_t h = 0; h < outcomes.size(); ++h) {
    const NamedUnit& response = result.responses[result.headline[h]];
    const std::vector<RowOutcome>& of = outcomes[h];
    const std::string_view unit = display(response).name;
    const int dispensable = 3 * static_cast<int>(h);  // the last response's columns go first
    columns.push_back({number_column(response.name + "_mean", response.name + " mean", unit, dispensable + 2),
                       [&](std::size_t row) { return value_cell(of[row].mean, response, kDigits); }});
    columns.push_back({number_column(response.name + "_extreme", response.name + " extreme", unit, dispensable),
                       [&](std::size_t row) { return value_cell(of[row].extreme, response, kDigits); }});
    columns.push_back(
        {number_column(response.name + "_extreme_pose", "at pose", "", dispensable + 1),
         [&](std::size_t row) { return of[row].solved == 0 ? text_cell("") : count_cell(of[row].pose); }});
  }
  fill(table, positions(labels.names.size()), columns);
  return table;
}

Table cases_table(const StoredResult& result) {
  const StoredEvaluation& found = evaluation_of(result);
  const std::size_t cases = found.cases.size();
  Table table{.name = "cases",
              .caption = "Each case over its poses: mean and largest value of the responses",
              .columns = {},
              .notes = {"poses: those whose solve counts"}};
  std::vector<FilledColumn> columns{
      {text_column("case", "case"), [&](std::size_t c) { return text_cell(found.cases[c]); }},
      {number_column("poses", "poses"), [&](std::size_t c) { return count_cell(found.count[c]); }}};
  int dispensable = 0;  // of the first response's columns; the last response's go first
  for (const std::size_t r : result.headline) {
    const NamedUnit& response = result.responses[r];
    const std::string_view unit = display(response).name;
    columns.push_back({number_column(response.name + "_mean", response.name + " mean", unit, dispensable),
                       [&, r](std::size_t c) { return value_cell(found.mean[r * cases + c], response, kDigits); }});
    columns.push_back(
        {number_column(response.name + "_max", response.name + " max", unit, dispensable == 0 ? 0 : dispensable + 1),
         [&, r](std::size_t c) { return value_cell(found.max[r * cases + c], response, kDigits); }});
    dispensable += 2;
  }
  fill(table, positions(cases), columns);
  return table;
}

}  // namespace

Table evaluation_table(const StoredResult& result) {
  std::vector<Summary> found;
  for (std::size_t r = 0; r < result.responses.size(); ++r)
    found.push_back(summary(evaluation_of(result).evaluation, r));
  const auto number = [&](const std::string& name, double Summary::*member) {
    return FilledColumn{number_column(name, name), [&, member](std::size_t r) {
                          return value_cell(found[r].*member, result.responses[r], kDigits);
                        }};
  };
  Table table{.name = "evaluation", .caption = "Responses over all samples that were solved", .columns = {}};
  fill(table, result.headline,
       {name_column(result.responses, "response"), unit_column(result.responses), number("mean", &Summary::mean),
        number("smallest", &Summary::smallest), number("largest", &Summary::largest)});
  for (const std::size_t r : result.headline) {
    if (std::string note = worst_note(result, r); !note.empty()) table.notes.push_back(std::move(note));
  }
  return table;
}

std::vector<Table> evaluation_tables(const StoredResult& result, const TableOptions&) {
  const StoredEvaluation& stored = evaluation_of(result);
  std::vector<Table> tables{stored.cases.empty() ? evaluation_table(result) : cases_table(result)};
  if (!stored.labels.names.empty()) tables.push_back(parts_table(result));
  return tables;
}

}  // namespace poesy
