#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/kinds/calibration/figures.h"
#include "engine/kinds/calibration/kind.h"
#include "engine/kinds/calibration/residuals.h"
#include "engine/kinds/calibration/result.h"
#include "engine/kinds/calibration/words.h"
#include "engine/report/display.h"
#include "engine/report/drawn_errors.h"
#include "engine/report/signs.h"
#include "engine/report/tables.h"

namespace poesy::calibration {
namespace {

/// A note that explains the columns of the table of fitted errors.
std::string fitted_legend(const Result& found) {
  return fmt::format(
      "estimate: the error that was fitted, in its unit; low, high: its {} interval; sd: its standard deviation; {}",
      percent_text(found.conf_level),
      found.has_tolerances != 0
          ? "tolerance/sd: the sigma of [errors] over it; below 1 the tolerance says more than the measurements"
          : "scale/sd: a usual size (1 mm, or 1 mm over the reach) over it");
}

Table fitted_table(const Result& found) {
  Table table{.name = "fitted", .caption = measured_text(found), .columns = {}};
  const auto value = [&](const std::string& name, const auto& array, int dispensable = 0) {
    return FilledColumn{number_column(name, name, "", dispensable),
                        [&](std::size_t n) { return value_cell(array(n), found.fitted[n]); }};
  };
  fill(table, positions(found.fitted.size()),
       {name_column(found.fitted, "fitted"),
        unit_column(found.fitted),
        value("estimate", found.estimate),
        value("low", found.low, 1),
        value("high", found.high, 1),
        value("sd", found.sd),
        {number_column("scale_over_sd", found.has_tolerances != 0 ? "tolerance/sd" : "scale/sd"),
         [&](std::size_t n) { return number_cell(found.scale(n) / found.sd(n), 2); }}});
  if (found.noise_is_known != 0) table.notes.push_back(fitted_legend(found));
  if (found.converged != 0) table.notes.push_back(residual_text(found));
  for (std::string& warning : calibration_warnings(found)) table.notes.push_back(std::move(warning));
  if (const std::string typed = typed_text(found); !typed.empty()) table.notes.push_back(typed);
  for (std::string& note : estimate_notes(found)) table.notes.push_back(std::move(note));
  for (std::string& note : left_notes(found)) table.notes.push_back(std::move(note));
  return table;
}

Table frame_table(const Result& found) {
  Table table{
      .name = "frame",
      .caption = "The unknown frame of the measuring device, and the target",
      .columns = {},
      .notes = {
          "x, y, z, height, target_x, ...: places in m; rho_x, ...: rotation vectors in rad; slopes have no unit"}};
  fill(table, positions(found.frame_parts.size()),
       {{text_column("number", "number"), [&](std::size_t n) { return text_cell(found.frame_parts[n]); }},
        {number_column("value", "value"), [&](std::size_t n) { return number_cell(found.frame(n), 6); }}});
  return table;
}

Table next_table(const StoredResult& result, const Result& found) {
  Table table{
      .name = "next",
      .caption = "Poses to measure next, the best first",
      .columns = {},
      .notes = {"gain: information about the fitted errors beyond that of the measurements and the poses above; "
                "1 bit halves the volume of what they may be"}};
  std::vector<FilledColumn> columns;
  for (std::size_t c = 0; c < result.pose_coordinates.size(); ++c) {
    const NamedUnit& own = result.pose_coordinates[c];
    columns.push_back({number_column(own.name, own.name, unit_text(own)),
                       [&found, &own, c](std::size_t n) { return value_cell(found.next_pose(n, c), own, 6); }});
  }
  columns.push_back(
      {number_column("gain", "gain", "bit"), [&](std::size_t n) { return number_cell(found.gain(n), 3); }});
  fill(table, positions(found.gain.size()), columns);
  return table;
}

std::vector<Table> calibration_result_tables(const StoredResult& result, const TableOptions&) {
  const Result& found = calibration_of(result);
  std::vector<Table> tables{fitted_table(found)};
  if (!found.frame_parts.empty()) tables.push_back(frame_table(found));
  if (found.converged != 0 && !found.gain.empty()) tables.push_back(next_table(result, found));
  tables.push_back(residuals_table(result));
  return tables;
}

SolveTally tally(const StoredResult&) { return {"", {"all errors"}, 1, {SolveCounts()}}; }

/// Converts a text for the terminal to a sentence for the page: "to type in: 2 +- 0.1 mm" to "To type in: 2 ± 0.1 mm."
std::string sentence(std::string_view text) { return as_sentence(typographic(text)); }

StudyWords words(const StoredResult& result) {
  StudyWords made{.from_tables = true, .fitted = true, .samples = "measurements"};
  made.sizes = drawn_sizes(result, made);
  return made;
}

MethodWords method(const StoredResult& result) {
  const Result& found = calibration_of(result);
  return {fmt::format("{} fitted to {} that were measured at {}. {}",
                      counted(found.fitted.size(), "number was", "numbers were"), values_text(found),
                      counted(found.measured_poses, "pose", "poses"), as_sentence(residual_text(found)))};
}

/// A fitted value with half of its interval: "rods -0.1494 +- 0.1018 mm".
std::string estimate_text(const Result& found, std::size_t n) {
  const Unit& unit = display(found.fitted[n]);
  const double half = (found.high(n) - found.estimate(n)) / unit.si;
  const std::string text = fmt::format("{} {}", found.fitted[n].name, number_text(found.estimate(n) / unit.si, 4));
  return text + (std::isnan(half) ? "" : fmt::format(" +- {}", number_text(half, 2))) +
         (unit.dimension == Dimension::number ? "" : " " + std::string(unit.name));
}

/// A text on how sure the fitted values are: the residuals, and what the intervals do not show.
std::string sure_text(const Result& found) {
  std::string text = sentence(residual_text(found));
  for (const std::string& note : unsure_notes(found)) text += " " + sentence(note);
  return text;
}

/// Advice for measurements that contradict the fitted errors: what to do before the fitted values are used.
std::string contradiction_text(const Result& found) {
  const bool has_outlier = std::ranges::any_of(found.outlier.all(), [](auto is) { return is != 0; });
  return has_outlier ? "First find out why the outlier is so far off: the fitted values rest on it."
         : found.unfitted > 0
             ? "First find out why the measurements contradict the fitted errors: fit more of the errors."
             : "First find out why the measurements contradict the fitted errors: the noise, or their tolerances.";
}

/// Advice on the parameters to type into the controller, and on what to measure next.
std::string advice_text(const Result& found) {
  if (found.converged == 0) return sentence(kNotConvergedRemedy);
  const std::string typed = typed_text(found);
  std::string text = sentence(typed.empty() ? "give the controller the fitted values" : typed);
  if (is_contradicted(found)) {
    text = contradiction_text(found) + " Then give the controller the fitted values" +
           (typed.empty() ? "." : fmt::format(" ({}).", typographic(typed)));
  }
  if (!found.gain.empty()) return text + " To know them better, measure at the first of the poses to measure next.";
  if (unsure_notes(found).empty()) return text;
  text += found.unfitted > 0 ? " To know them better, measure more, so that the other errors can be fitted too"
                             : " To know them better, measure more or more precisely";
  if (found.noise_is_known == 0) return text + ".";  // without noise, no next poses are chosen
  return text + ": next = 5 in [analysis.calibration] names the poses that tell most.";
}

/// A text with the fitted values, and with the displacement that remains after calibration.
std::string found_text(const Result& found) {
  constexpr std::size_t kMostValues = 6;
  std::vector<std::string> values;
  for (std::size_t n = 0; n < found.fitted.size(); ++n) {
    values.push_back(estimate_text(found, n));
  }
  const std::vector<std::string> left = left_notes(found);
  const std::string interval =
      found.noise_is_known == 0 ? "" : fmt::format(" ({} intervals)", percent_text(found.conf_level));
  return fmt::format("fitted: {}{}{}", some_names(values, kMostValues), interval,
                     left.empty() ? "" : "; " + left.front());
}

/// The summary at the top of the report. Warnings come first, because all other lines depend on the fitted errors.
Answer answer(const StoredResult& result) {
  const Result& found = calibration_of(result);
  Answer lines;
  for (const std::string& warning : calibration_warnings(found)) lines.emplace_back("Caution", sentence(warning));
  if (const std::string kept = kept_text(found); !kept.empty()) lines.emplace_back("Limits", sentence(kept));
  if (found.converged != 0) lines.emplace_back("Answer", sentence(found_text(found)));
  // The text begins with "file", so that sentence() does not capitalise the name of the file.
  lines.emplace_back("Measured", sentence("file " + measured_text(found)));
  lines.emplace_back("How sure", sure_text(found));
  lines.emplace_back(kWhatToDo, advice_text(found));
  return lines;
}

void add_page(const StoredResult& result, std::span<const Table> tables, Page& page) {
  Section& section = page.add_section("fitted", "The fitted errors");
  for (const char* name : {"fitted", "frame", "next"}) section.table(tables, name);
  add_calibration_figures(result, tables, page);
}

Comparable comparable(const StoredResult& result, const StoredResult&) {
  const Result& found = calibration_of(result);
  std::vector<std::vector<std::string>> units(1);
  std::vector<double> values;
  for (std::size_t n = 0; n < found.fitted.size(); ++n) {
    const Unit& unit = display(found.fitted[n]);
    units.front().emplace_back(unit.name);
    values.push_back(found.estimate(n) / unit.si);
  }
  return {.option_word = "calibration",
          .options = {"estimates"},
          .item_word = "fitted error",
          .items = names_of(found.fitted),
          .quantities = {{"estimate", "estimate", std::move(units), std::move(values)}}};
}

/// Runs nothing, because no study has the kind `calibration`.
std::optional<StudyResult> run_nothing(const StudyRun&) { return std::nullopt; }

AtPose nothing_at_pose(const Study&) { return {0.0, "values", 0.0, "solves"}; }

const StudyKind kStudy{.name = "calibration",
                       .asks = "which errors a machine has that was measured",
                       .keys = {},
                       .at_pose = nothing_at_pose};

}  // namespace

constinit const ReportKind kReport{.tally = tally,
                                   .tables = calibration_result_tables,
                                   .words = words,
                                   .method = method,
                                   .answer = answer,
                                   .shown_cells = [](const StoredResult& result) { return shown_cells(result, 1); },
                                   .page = add_page,
                                   .comparable = comparable};

constinit const Kind kKind{.study = kStudy, .run = {run_nothing, nullptr, nullptr}, .file = kFile, .report = kReport};

}  // namespace poesy::calibration
