#include <algorithm>
#include <functional>

#include "engine/base/text.h"
#include "engine/io/study_file_parts.h"

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

std::vector<ErrorCase> read_cases(const StudySection& analysis, const ModelDescription& model,
                                  const std::vector<double>& background, StudyUse use) {
  std::vector<ErrorCase> cases;
  if (const auto value = analysis.find("cases")) {
    for (const StudyValue& one : value->list()) {
      const StudySection section = one.section();
      section.allow();
      const std::string name = read_name(section, names(cases), "case " + std::to_string(cases.size() + 1));
      const StudySection errors =
          section.require("errors", "write e.g. errors = { linear = \"0.1 mm\", angular = \"0.1 deg\" }").section();
      if (errors.empty()) {
        throw InputError(errors.place(), "case '" + printable(name) + "' gives no error",
                         "write e.g. errors = { linear = \"0.1 mm\" }; zero is an error too");
      }
      cases.push_back({name, read_case_errors(errors, model, background)});
    }
  }
  if (cases.empty() && use == StudyUse::run) {
    throw InputError(analysis.place(), "kind = \"evaluate\" needs at least one case",
                     "write [[analysis.cases]] with name and errors, or use 'poesy evaluate' for a table of errors");
  }
  return cases;
}

std::vector<ErrorSize> read_groups(const StudySection& analysis) {
  std::vector<ErrorSize> groups;
  if (const auto value = analysis.find("groups")) {
    for (const StudyValue& one : value->list()) {
      const StudySection section = one.section();
      section.allow();
      const std::string name = read_name(section, names(groups), "group " + std::to_string(groups.size() + 1));
      const auto size = [&](std::string_view key, Dimension dimension) {
        return section.require(key, "a group sets both").positive_quantity(dimension);
      };
      groups.push_back({name, size("linear", Dimension::length), size("angular", Dimension::angle)});
    }
    if (groups.empty()) value->fail("is empty", "leave it out for one group of 1 mm and 1 deg");
  }
  if (groups.empty()) {
    groups.push_back({"group 1", display_unit(Dimension::length).si, display_unit(Dimension::angle).si});
  }
  return groups;
}

}  // namespace poesy
