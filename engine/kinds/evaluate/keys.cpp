#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include "engine/base/text.h"
#include "engine/kinds/evaluate/cases.h"
#include "engine/study/calibration.h"
#include "engine/study/calibration_keys.h"
#include "engine/study/study.h"
#include "engine/study/study_kind.h"
#include "engine/study/table_file.h"

namespace poesy::evaluate {
namespace {

constexpr std::array<std::string_view, 4> kKeys{"background", "limits", "calibration", "cases"};

void set_case_errors(const StudyValue& value, std::string_view key, const ModelDescription& model,
                     std::vector<double>& errors) {
  if (const auto factor = model.find_factor(key)) {
    errors[factor->value] = value.quantity(model.factors[factor->value].dimension);
    return;
  }
  const Dimension dimension = *std::ranges::find(kErrorDimensions, key, error_kind);
  const double size = value.quantity(dimension);
  for (std::size_t f = 0; f < errors.size(); ++f) {
    if (model.factors[f].dimension == dimension) errors[f] = size;
  }
}

/// The factor sets that a case names, larger sets first. Throws InputError if two sets overlap but neither contains the
/// other.
std::vector<const FactorSet*> sets_in_case(const StudySection& section, const ModelDescription& model) {
  std::vector<const FactorSet*> sets;
  for (const FactorSet& set : model.factor_sets) {
    if (section.find(set.name)) sets.push_back(&set);
  }
  std::ranges::stable_sort(sets, std::ranges::greater(), [](const FactorSet* set) { return set->factors.size(); });
  for (std::size_t wide = 0; wide < sets.size(); ++wide) {
    for (std::size_t narrow = wide + 1; narrow < sets.size(); ++narrow) {
      const auto& around = sets[wide]->factors;
      const auto& inside = sets[narrow]->factors;
      const auto shared = std::ranges::count_if(
          inside, [&](FactorIndex factor) { return std::ranges::find(around, factor) != around.end(); });
      if (shared == 0 || static_cast<std::size_t>(shared) == inside.size()) continue;
      section.find(sets[narrow]->name)
          ->fail("shares factors with '" + sets[wide]->name + "', and neither lies inside the other",
                 "name the factors that both have one by one");
    }
  }
  return sets;
}

/// The errors of a case. The keys `linear`, `angular` and `relative` set all errors of one dimension. Factor sets
/// override these keys, smaller sets override larger ones, and single factors override all. errors: values of the
/// errors that the case does not set.
std::vector<double> read_case_errors(const StudySection& section, const ModelDescription& model,
                                     std::vector<double> errors) {
  std::vector<std::string_view> known = names(model.factors);
  const std::vector<std::string_view> sets = names(model.factor_sets);
  known.insert(known.end(), sets.begin(), sets.end());
  for (const Dimension dimension : kErrorDimensions) known.push_back(error_kind(dimension));
  section.allow(known, "factor");
  for (const Dimension dimension : kErrorDimensions) {
    const std::string_view key = error_kind(dimension);
    if (const auto value = section.find(key)) set_case_errors(*value, key, model, errors);
  }
  for (const FactorSet* set : sets_in_case(section, model)) {
    const StudySection of_set = section.section(set->name);
    of_set.allow();
    if (of_set.empty()) section.find(set->name)->fail("gives no error", "write linear, angular or relative");
    std::vector<double> all = errors;
    for (const std::string& key : of_set.keys()) set_case_errors(*of_set.find(key), key, model, all);
    for (const FactorIndex factor : set->factors) errors[factor.value] = all[factor.value];
  }
  for (const Factor& factor : model.factors) {
    if (const auto value = section.find(factor.name)) set_case_errors(*value, factor.name, model, errors);
  }
  return errors;
}

void read_cases(const StudyValue& value, Study& study, const Reading&) {
  const std::vector<double> background = background_errors(study.analysis.background, study.model());
  std::vector<ErrorCase>& cases = asked_of<CaseOptions>(study.analysis).cases;
  for (const StudyValue& one : value.list()) {
    const StudySection section = one.section();
    section.allow();
    const std::string name = read_name(section, names(cases), "case " + std::to_string(cases.size() + 1));
    const StudySection errors = section.require("errors").section();
    if (errors.empty()) {
      throw InputError(errors.place(), "case '" + printable(name) + "' gives no error",
                       "write e.g. errors = { linear = \"0.1 mm\" }; zero is an error too");
    }
    cases.push_back({name, read_case_errors(errors, study.model(), background)});
  }
}

/// The cases as lines of a study file, in which every error is stated by name.
std::string cases_lines(const Study& study) {
  std::string text;
  for (const ErrorCase& one : asked_of<CaseOptions>(study.analysis).cases) {
    text += fmt::format("\n[[analysis.cases]]\nname = {}\n\n[analysis.cases.errors]\n", in_quotes(one.name));
    for (std::size_t f = 0; f < one.errors.size(); ++f) {
      const Factor& factor = study.model().factors[f];
      text += factor.name + " = " + exact_value(one.errors[f], factor.dimension) + "\n";
    }
  }
  return text;
}

std::string shown_cases(const TemplateLines& lines, const Study& study) {
  const ModelDescription& model = study.model();
  const std::string_view sizes = lines.example("analysis.cases", "errors");
  const std::string text = "\n" + lines.explanation_lines("analysis", "cases") + lines.keys_lines("analysis.cases") +
                           lines.keys_lines("analysis.cases.errors", 2) +
                           comment("    " + std::string(lines.meaning("analysis.cases.errors"))) +
                           lines.keys_lines("analysis.cases.errors.SET", 3) +
                           fmt::format("[[analysis.cases]]\nname = \"group 1\"\nerrors = {}\n", sizes);
  if (model.factors.empty()) return text;
  const Factor& factor = model.factors.front();
  return text +
         fmt::format("\n[[analysis.cases]]\nname = \"one error\"\nerrors = {{ {} = {} }}\n# errors = {{ {} = {} }}\n",
                     factor.name, example_size(factor.dimension, 0.1),
                     in_quotes(model.factor_sets.empty() ? factor.name : model.factor_sets.back().name), sizes);
}

std::vector<StudyRow> cases_rows() {
  return {StudyRow{.name = "cases",
                   .value = {.type = "list of tables"},
                   .required = true,
                   .meaning = "Fixed errors, each case with a name.",
                   .reader = read_cases,
                   .lines = cases_lines,
                   .late = 2,
                   .shown = shown_cases}};
}

StudyTables case_tables() {
  const StudyTable cases{
      .paths = {"analysis.cases"},
      .meaning = "For kind = \"evaluate\".",
      .keys = {{.name = "name", .type = "text", .usual = "case 1, case 2 and so on", .meaning = kNameMeaning},
               {.name = "errors",
                .type = "table",
                .required = true,
                .missing = "write e.g. {}",
                .example = "{ linear = \"0.1 mm\", angular = \"0.1 deg\" }",
                .meaning = "The errors that the case sets."}}};
  const StudyTable errors{.paths = {"analysis.cases.errors"},
                          .meaning = "The narrower wins. What is not set has the background's value, or is zero.",
                          .keys = {{.name = "FACTOR", .type = "quantity", .meaning = "One error."},
                                   {.name = "SET", .type = "table", .meaning = "The errors of a factor set."},
                                   {.name = "linear", .type = "length", .meaning = "All errors that are lengths."},
                                   {.name = "angular", .type = "angle", .meaning = "All errors that are angles."},
                                   {.name = "relative", .type = "number", .meaning = "All errors that are numbers."}}};
  const StudyTable of_set{
      .paths = {"analysis.cases.errors.SET"},
      .meaning = "At least one of them.",
      .keys = {{.name = "linear", .type = "length", .meaning = "All errors of the set that are lengths."},
               {.name = "angular", .type = "angle", .meaning = "All errors of the set that are angles."},
               {.name = "relative", .type = "number", .meaning = "All errors of the set that are numbers."}}};
  return {cases, errors, of_set};
}

/// Checks that a study has cases. Its list of varied factors is emptied, because the cases state all errors.
void complete_cases(Study& study, const Reading& reading) {
  study.analysis.factors.clear();
  if (reading.use == StudyUse::run) check_simulated(study, reading.root.section("analysis"));
  if (!asked_of<CaseOptions>(study.analysis).cases.empty() || reading.use != StudyUse::run) return;
  throw InputError(reading.root.section("analysis").place(), "kind = \"evaluate\" needs at least one case",
                   "write [[analysis.cases]] with name and errors, or use 'poesy evaluate' for a table of errors");
}

/// Refuses an error that is too large. The message points at the key that sets the error, at the key for all errors of
/// its dimension, or at the case if a factor set contains the error.
[[noreturn]] void refuse_case(const StudySection& errors, const std::string& name, const Factor& factor,
                              const std::string& problem) {
  for (const std::string_view key : {std::string_view(factor.name), error_kind(factor.dimension)}) {
    if (const auto value = errors.find(key)) value->fail(problem, kTooLargeRemedy);
  }
  throw InputError(errors.place(), "case '" + printable(name) + "' " + problem, kTooLargeRemedy);
}

void check_cases(const StudySection& analysis, const Study& study, const Model& model) {
  const std::vector<ErrorCase>& cases = asked_of<CaseOptions>(study.analysis).cases;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    for (std::size_t f = 0; f < cases[c].errors.size(); ++f) {
      const auto problem = beyond_bound(model, FactorIndex(f), cases[c].errors[f], "an error");
      if (!problem) continue;
      refuse_case(analysis.require("cases").list()[c].section().section("errors"), cases[c].name,
                  model.description().factors[f], *problem);
    }
  }
}

AtPose cases_at_pose(const Study& study) {
  const auto cases = static_cast<double>(asked_of<CaseOptions>(study.analysis).cases.size());
  return {cases, "cases", cases, "cases"};
}

}  // namespace

const StudyKind kStudy{.name = "evaluate",
                       .asks = "what named cases of fixed errors do",
                       .keys = kKeys,
                       .has_pose_before = true,
                       .overrides = "a case sets",
                       .rows = cases_rows,
                       .tables = case_tables,
                       .complete = complete_cases,
                       .check_errors = check_cases,
                       .at_pose = cases_at_pose};

}  // namespace poesy::evaluate
