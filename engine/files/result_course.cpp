#include "engine/files/result_parts.h"
#include "engine/study/study_kind.h"

/// Courses of estimates, and how adaptive samples came to their end.
namespace poesy {
namespace {

/// What a convergence says in addition to its course: one number for each quantity, or for each slot.
Fields<ConvergenceResult> end_fields(const CourseWords& words) {
  const Axes& all = words.group.fields.front().axes;  // of the quantities, and the milestones
  const Axes quantities(all.begin(), all.end() - 1);
  const Axes slots(all.begin() + 1, all.end() - 1);
  return {{"reached", &ConvergenceResult::reached, quantities, "1",
           "1: the half-width at the end is small enough; 0: it is not"},
          {"relative_half_width", &ConvergenceResult::relative_half_width, quantities, "1",
           "Half-width at the end over the magnitude of what it is for; NaN for zero over zero"},
          {"samples", &ConvergenceResult::samples, slots, "1", "Samples at each pose at the end"}};
}

CsvTable end_table(const StoredResult& result, const CourseWords& words, const ConvergenceResult& found) {
  const std::size_t slots = found.samples.size();
  CsvTable table{"convergence", {words.csv_slot, [&](std::size_t slot) { return result.varied[slot]; }}, slots};
  table.columns.push_back(list_column("samples", found.samples));
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const std::string& response = result.responses[r].name;
    table.columns.push_back(list_column(response + "_reached", found.reached, r * slots));
    table.columns.push_back(list_column(response + "_relative_half_width", found.relative_half_width, r * slots));
  }
  return table;
}

}  // namespace

CourseWords convergence_words(Axes axes, const std::string& name, const std::string& unit, const std::string& quantity,
                              const std::string& rule, const std::string& csv_slot) {
  axes.emplace_back("milestone");
  return {{"/convergence",
           rule + ". The half-width is the larger distance from the value to an end of its interval",
           kCourseLevel,
           {},
           {{name, &EstimateCourse::value, axes, unit, quantity + " at each milestone; NaN after its samples ended"},
            {"half_width", &EstimateCourse::half_width, axes, unit,
             "Half-width of its interval at each milestone; NaN after its samples ended"}}},
          "milestone",
          "Samples at each pose when the intervals were looked at",
          "convergence_",
          csv_slot,
          {name, "half_width"}};
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

void append_course_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words,
                          const EstimateCourse& found, std::span<const std::uint64_t> ends) {
  const std::size_t numbers = found.samples.size();
  for (std::size_t r = 0; r < result.responses.size(); ++r) {
    const NamedUnit& response = result.responses[r];
    const std::size_t lines = found.value.size() / result.responses.size();
    CsvTable table{words.csv + response.name,
                   {words.csv_slot, [&, numbers](std::size_t line) { return result.varied[line / numbers]; }},
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

void add_convergence(ResultBuilder& result, const CourseWords& words, const std::optional<ConvergenceResult>& found) {
  if (!found) return;
  add_course(result, words, found->course);
  write_fields(result, "/convergence", end_fields(words), *found);
  h5::File& file = result.file();
  file.set_attribute("/convergence", "relative_error", found->relative_error);
  const std::vector<std::uint64_t> limits{found->min, found->max};
  file.set_attribute("/convergence", "min", std::span(limits).first(1));
  file.set_attribute("/convergence", "max", std::span(limits).last(1));
}

std::optional<ConvergenceResult> read_convergence(const h5::File& file, const CourseWords& words) {
  if (!file.exists("/convergence")) return std::nullopt;
  ConvergenceResult found;
  found.course = read_course(file, words);
  const auto number = [&](const char* name) {
    return static_cast<std::size_t>(file.attribute<std::uint64_t>("/convergence", name).at(0));
  };
  found.min = number("min");
  found.max = number("max");
  found.relative_error = file.attribute<double>("/convergence", "relative_error").at(0);
  read_fields(file, "/convergence", end_fields(words), found);
  return found;
}

void append_convergence_tables(CsvTables& tables, const StoredResult& result, const CourseWords& words) {
  const std::optional<ConvergenceResult>& found = result.convergence;
  if (!found) return;
  tables.push_back(end_table(result, words, *found));
  append_course_tables(tables, result, words, found->course, found->samples);
}

}  // namespace poesy
