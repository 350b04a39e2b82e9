#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "engine/base/text.h"
#include "engine/study/keys.h"

namespace poesy {
namespace {

void set_case_errors(const StudyValue& value, std::string_view key, const ModelDescription& model,
                     std::vector<double>& errors) {
  if (const auto factor = model.find_factor(key)) {
    errors[factor->value] = value.quantity(model.factors[factor->value].dimension);
    return;
  }
  const Dimension dimension = key == "linear" ? Dimension::length : Dimension::angle;
  const double size = value.quantity(dimension);
  for (std::size_t f = 0; f < errors.size(); ++f) {
    if (model.factors[f].dimension == dimension) errors[f] = size;
  }
}

/// The factor sets that a case names, each before those that lie inside it. Throws where two overlap otherwise.
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

/// The errors of a case: `linear` and `angular` for all, then factor sets from wide to narrow, then single factors,
/// each over the last.
std::vector<double> read_case_errors(const StudySection& section, const ModelDescription& model,
                                     std::vector<double> errors) {
  std::vector<std::string_view> known = names(model.factors);
  const std::vector<std::string_view> sets = names(model.factor_sets);
  known.insert(known.end(), sets.begin(), sets.end());
  known.insert(known.end(), {"linear", "angular"});
  section.allow(known, "factor");
  for (const std::string_view key : {"linear", "angular"}) {
    if (const auto value = section.find(key)) set_case_errors(*value, key, model, errors);
  }
  for (const FactorSet* set : sets_in_case(section, model)) {
    const StudySection sizes = section.section(set->name);
    sizes.allow();
    if (sizes.empty()) section.find(set->name)->fail("gives no error", "write linear, angular, or both");
    std::vector<double> all = errors;
    for (const std::string& key : sizes.keys()) set_case_errors(*sizes.find(key), key, model, all);
    for (const FactorIndex factor : set->factors) errors[factor.value] = all[factor.value];
  }
  for (const Factor& factor : model.factors) {
    if (const auto value = section.find(factor.name)) set_case_errors(*value, factor.name, model, errors);
  }
  return errors;
}

void read_cases(const StudyValue& value, Study& study, const Reading&) {
  if (study.analysis.kind != Analysis::Kind::evaluate) return;  // `evaluate` passes over them
  const std::vector<double> background = background_errors(study.analysis.background, study.model());
  std::vector<ErrorCase>& cases = study.analysis.cases;
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

/// Every error by name.
std::string cases_lines(const Study& study) {
  std::string text;
  for (const ErrorCase& one : study.analysis.cases) {
    text += fmt::format("\n[[analysis.cases]]\nname = {}\n\n[analysis.cases.errors]\n", in_quotes(one.name));
    for (std::size_t f = 0; f < one.errors.size(); ++f) {
      const Factor& factor = study.model().factors[f];
      text += factor.name + " = " + exact_value(one.errors[f], factor.dimension) + "\n";
    }
  }
  return text;
}

const InnerRows<ErrorSize>& group_keys() {
  static const InnerRows<ErrorSize> keys{
      .paths = {"analysis.groups"},
      .meaning = "For kind = \"identification\".",
      .rows = {InnerRow<ErrorSize>{.name = "name",
                                   .value = text_at(&ErrorSize::name),
                                   .usual = "group 1, group 2 and so on",
                                   .meaning = "Name of the group, without commas and quotes."},
               InnerRow<ErrorSize>{.name = "linear",
                                   .value = positive_at(Dimension::length, &ErrorSize::linear),
                                   .missing = "a group sets both",
                                   .meaning = "Size of errors that are lengths."},
               InnerRow<ErrorSize>{.name = "angular",
                                   .value = positive_at(Dimension::angle, &ErrorSize::angular),
                                   .missing = "a group sets both",
                                   .meaning = "Size of errors that are angles."}}};
  return keys;
}

void read_groups(const StudyValue& value, Study& study, const Reading&) {
  if (study.analysis.kind != Analysis::Kind::identification) return;  // `evaluate` passes over them
  std::vector<ErrorSize>& groups = study.analysis.groups;
  for (const StudyValue& one : value.list()) {
    ErrorSize group{};
    read_keys(group_keys(), one.section(), group, Nothing());
    group.name = read_name(one.section(), names(groups), "group " + std::to_string(groups.size() + 1));
    groups.push_back(std::move(group));
  }
  if (groups.empty()) value.fail("is empty", "leave it out for one group of 1 mm and 1 deg");
}

std::string groups_lines(const Study& study) {
  std::string text;
  for (const ErrorSize& group : study.analysis.groups) {
    text += "\n[[analysis.groups]]\n" + keys_text(group_keys(), group);
  }
  return text;
}

}  // namespace

std::string read_name(const StudySection& section, std::span<const std::string_view> taken, const std::string& usual) {
  const auto value = section.find("name");
  const std::string name = value ? value->text() : usual;
  if (value && (name.empty() || name.find_first_of(",;\"\n\r\t") != std::string::npos)) {
    value->fail("is '" + printable(name) + "'",
                "a name is plain text without commas and quotes, for it stands in tables");
  }
  if (std::ranges::find(taken, name) == taken.end()) return name;
  if (value) value->fail("is '" + printable(name) + "', which another one has", "give each a name of its own");
  throw InputError(section.place(), "it has no name, and '" + name + "' is taken", "write name = \"...\"");
}

ErrorSize usual_group() { return {"group 1", display_unit(Dimension::length).si, display_unit(Dimension::angle).si}; }

StudyRow groups_row() {
  const ErrorSize group = usual_group();
  return {.name = "groups",
          .value = {.type = "list of tables"},
          .usual = fmt::format("`[{{ name = {}, linear = {}, angular = {} }}]`", in_quotes(group.name),
                               readable_value(group.linear, Dimension::length),
                               readable_value(group.angular, Dimension::angle)),
          .meaning = "The sizes at which errors are set; each group gives verdicts of its own.",
          .reader = read_groups,
          .lines = groups_lines,
          .late = 2};
}

StudyTable group_table() { return described(group_keys()); }

StudyRow cases_row() {
  return {.name = "cases",
          .value = {.type = "list of tables"},
          .required = true,
          .meaning = "Fixed errors, each case with a name.",
          .reader = read_cases,
          .lines = cases_lines,
          .late = 2};
}

StudyTables case_tables() {
  const StudyTable cases{.paths = {"analysis.cases"},
                         .meaning = "For kind = \"evaluate\".",
                         .keys = {{.name = "name",
                                   .type = "text",
                                   .usual = "case 1, case 2 and so on",
                                   .meaning = "Name of the case, without commas and quotes."},
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
                                   {.name = "angular", .type = "angle", .meaning = "All errors that are angles."}}};
  const StudyTable of_set{
      .paths = {"analysis.cases.errors.SET"},
      .meaning = "At least one of them.",
      .keys = {{.name = "linear", .type = "length", .meaning = "All errors of the set that are lengths."},
               {.name = "angular", .type = "angle", .meaning = "All errors of the set that are angles."}}};
  return {cases, errors, of_set};
}

}  // namespace poesy
