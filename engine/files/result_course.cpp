#include "engine/files/result_parts.h"
#include "engine/study/study_kind.h"

/// Courses of estimates: the history of indices of a study with a fixed number of samples, and how adaptive samples
/// came to their end.
namespace poesy {
namespace {

/// A course in the words of its group.
struct CourseWords {
  Group<EstimateCourse> group;
  std::string samples_axis;              ///< of the numbers of samples
  std::string samples_description;       ///< of that axis
  std::string csv;                       ///< names of files begin so
  std::string csv_slot;                  ///< heading of what the samples were of
  std::vector<std::string> csv_columns;  ///< of the rows
};

const Axes kHistoryAxes{"response", "factor", "samples"};
const std::vector<Attribute<EstimateCourse>> kCourseLevel{{"conf_level", &EstimateCourse::conf_level}};

const CourseWords kHistory{
    {"/sensitivity/history",
     "The global indices after the first samples of each pose: what a study with so many samples finds; NaN where "
     "undefined",
     kCourseLevel,
     {},
     {{"global", &EstimateCourse::value, kHistoryAxes, kIndexUnit, "Global index after so many samples at each pose"},
      {"global_ci_low", &EstimateCourse::ci_low, kHistoryAxes, kIndexUnit, "Lower end of the interval of global", "",
       kCourseLevel},
      {"global_ci_high", &EstimateCourse::ci_high, kHistoryAxes, kIndexUnit, "Upper end of the interval of global", "",
       kCourseLevel}}},
    "samples",
    "Samples at each pose; the last is the study's number",
    "history_",
    "factor",
    {"index", "index_ci_low", "index_ci_high"}};

/// axes: of what an interval is for. name: of the dataset of the quantities.
Group<EstimateCourse> convergence_group(Axes axes, const std::string& name, const std::string& unit,
                                        const std::string& quantity, const std::string& rule) {
  axes.emplace_back("milestone");
  return {"/convergence",
          rule + ". The half-width is the larger distance from the value to an end of its interval",
          kCourseLevel,
          {},
          {{name, &EstimateCourse::value, axes, unit, quantity + " at each milestone; NaN after its samples ended"},
           {"half_width", &EstimateCourse::half_width, axes, unit,
            "Half-width of its interval at each milestone; NaN after its samples ended"}}};
}

constexpr const char* kMilestoneMeaning = "Samples at each pose when the intervals were looked at";

const CourseWords kIndexConvergence{
    convergence_group(
        {"response", "factor"}, "index", kIndexUnit, "Global index",
        "An error got samples until, at a milestone, the half-width of every response's global index was at most "
        "relative_error of the index, or the index rounding (below 1e-10), or max was there"),
    "milestone",
    kMilestoneMeaning,
    "convergence_",
    "factor",
    {"index", "half_width"}};

const CourseWords kMeanConvergence{
    convergence_group({"response"}, "mean", kResponseUnit, "Mean over the samples of all poses",
                      "Every pose got samples until, at a milestone, the half-width of the mean of every response of "
                      "the headline was at most relative_error of its magnitude, or max was there"),
    "milestone",
    kMilestoneMeaning,
    "convergence_",
    "errors",
    {"mean", "half_width"}};

bool of_indices(const StudyKind& kind) { return kind.varies == Varies::one_by_one; }

const CourseWords& convergence_words(const StudyKind& kind) {
  return of_indices(kind) ? kIndexConvergence : kMeanConvergence;
}

/// What a convergence says in addition to its course: one number for each quantity, or for each slot.
Fields<ConvergenceResult> end_fields(const StudyKind& kind) {
  const Axes quantities = of_indices(kind) ? Axes{"response", "factor"} : Axes{"response"};
  const Axes slots = of_indices(kind) ? Axes{"factor"} : Axes{};
  return {{"reached", &ConvergenceResult::reached, quantities, "1",
           "1: the half-width at the end is small enough; 0: it is not"},
          {"relative_half_width", &ConvergenceResult::relative_half_width, quantities, "1",
           "Half-width at the end over the magnitude of what it is for; NaN for zero over zero"},
          {"samples", &ConvergenceResult::samples, slots, "1", "Samples at each pose at the end"}};
}

void add_course(ResultBuilder& result, const CourseWords& words, const EstimateCourse& found) {
  result.add_axis(words.samples_axis, found.samples, {"1", words.samples_description});
  write_group(result, words.group, found);
}

EstimateCourse read_course(const h5::File& file, const CourseWords& words) {
  EstimateCourse found;
  found.samples = file.read<std::uint64_t>("/" + words.samples_axis);
  read_group(file, words.group, found);
  return found;
}

/// In a Monte Carlo study all errors are one slot.
std::string slot_name(const StoredResult& result, const CourseWords& words, std::size_t slot) {
  return words.csv_slot == "factor" ? result.factors[slot].name : std::string(kAllFactors);
}

/// A table for each response with a line for each slot and number of samples. ends: [slots] samples at each pose at
/// the end; empty where all went through the whole course.
void append_course_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words,
                          const EstimateCourse& found, std::span<const std::uint64_t> ends) {
  const std::size_t numbers = found.samples.size();
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    const std::size_t lines = found.value.size() / result.responses.size();
    CsvTable table{
        words.csv + response.name,
        {words.csv_slot, [&, numbers](std::size_t line) { return slot_name(result, words, line / numbers); }},
        lines};
    table.columns.push_back(
        {"samples", [&, numbers](std::size_t line) { return static_cast<double>(found.samples[line % numbers]); }});
    for (std::size_t k = 0; k < words.group.fields.size(); ++k) {
      const FieldRow<EstimateCourse>& field = words.group.fields[k];
      const std::string unit = csv_unit(field.unit, result, &response);
      table.columns.push_back(field_column(with_unit(words.csv_columns[k], unit), field, found, r * lines));
    }
    if (!ends.empty()) {
      table.has = [&found, ends, numbers](std::size_t line) {
        return found.samples[line % numbers] <= ends[line / numbers];
      };
    }
    tables.push_back(std::move(table));
  }
}

CsvTable end_table(const StoredResult& result, const CourseWords& words, const ConvergenceResult& found) {
  const std::size_t slots = found.samples.size();
  CsvTable table{
      "convergence", {words.csv_slot, [&](std::size_t slot) { return slot_name(result, words, slot); }}, slots};
  table.columns.push_back(list_column("samples", found.samples));
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const std::string& response = result.responses[r].name;
    table.columns.push_back(list_column(response + "_reached", found.reached, r * slots));
    table.columns.push_back(list_column(response + "_relative_half_width", found.relative_half_width, r * slots));
  }
  return table;
}

}  // namespace

void add_convergence(ResultBuilder& result, const StudyKind& kind, const std::optional<ConvergenceResult>& found) {
  if (!found) return;
  add_course(result, convergence_words(kind), found->course);
  write_fields(result, "/convergence", end_fields(kind), *found);
  h5::File& file = result.file();
  file.set_attribute("/convergence", "relative_error", found->relative_error);
  const std::vector<std::uint64_t> limits{found->min, found->max};
  file.set_attribute("/convergence", "min", std::span(limits).first(1));
  file.set_attribute("/convergence", "max", std::span(limits).last(1));
}

std::optional<ConvergenceResult> read_convergence(const h5::File& file, const StudyKind& kind) {
  if (!file.exists("/convergence")) return std::nullopt;
  ConvergenceResult found;
  found.course = read_course(file, convergence_words(kind));
  const auto number = [&](const char* name) {
    return static_cast<std::size_t>(file.attribute<std::uint64_t>("/convergence", name).at(0));
  };
  found.min = number("min");
  found.max = number("max");
  found.relative_error = file.attribute<double>("/convergence", "relative_error").at(0);
  read_fields(file, "/convergence", end_fields(kind), found);
  return found;
}

void append_convergence_tables(CsvTables& tables, const StoredResult& result, const StudyKind& kind,
                               const std::optional<ConvergenceResult>& found) {
  if (!found) return;
  const CourseWords& words = convergence_words(kind);
  tables.push_back(end_table(result, words, *found));
  append_course_tables(tables, result, words, found->course, found->samples);
}

void add_history(ResultBuilder& result, const std::optional<EstimateCourse>& found) {
  if (found) add_course(result, kHistory, *found);
}

std::optional<EstimateCourse> read_history(const h5::File& file) {
  if (!file.exists(kHistory.group.path)) return std::nullopt;
  return read_course(file, kHistory);
}

void append_history_tables(CsvTables& tables, const StoredResult& result) {
  const auto& found = result.sensitivity.history;
  if (found) append_course_tables(tables, result, kHistory, *found, {});
}

}  // namespace poesy
