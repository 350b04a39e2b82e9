#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "engine/io/study_file_parts.h"
#include "engine/io/wording.h"

namespace poesy {
namespace {

using Shape = Distribution::Shape;

Distribution make_distribution(Shape shape, double sigma, double half_width) {
  switch (shape) {
    case Shape::normal:
      return Distribution::normal(sigma);
    case Shape::truncated_normal:
      return Distribution::truncated_normal(sigma, half_width);
    case Shape::uniform:
      return Distribution::uniform(half_width);
    case Shape::triangular:
      break;
  }
  return Distribution::triangular(half_width);
}

/// A parameter of a distribution; 0 and not allowed where the shape has none of that name.
double read_parameter(const StudySection& section, std::string_view key, bool belongs, Shape shape,
                      Dimension dimension) {
  const std::string owner = "the distribution \"" + std::string(name(shape)) + "\"";
  if (belongs) return section.require(key, owner + " needs it").positive_quantity(dimension);
  section.refuse(key, owner);
  return 0.0;
}

Distribution read_distribution(const StudyValue& value, Dimension dimension) {
  constexpr std::array kShapes{Shape::normal, Shape::truncated_normal, Shape::uniform, Shape::triangular};
  const StudySection section = value.section();
  section.allow({"distribution", "sigma", "half_width"});
  std::vector<std::string_view> words;
  for (const Shape shape : kShapes) words.push_back(name(shape));
  const Shape shape = kShapes[section.require("distribution", "write e.g. distribution = \"normal\"").word(words)];
  const bool has_sigma = shape == Shape::normal || shape == Shape::truncated_normal;
  const double sigma = read_parameter(section, "sigma", has_sigma, shape, dimension);
  const double half_width = read_parameter(section, "half_width", shape != Shape::normal, shape, dimension);
  try {
    return make_distribution(shape, sigma, half_width);
  } catch (const std::invalid_argument& reason) {
    value.fail(std::string("is impossible: ") + reason.what(), "correct its parameters");
  }
}

Distribution read_default(const StudySection& section, std::string_view key, Dimension dimension) {
  if (const auto value = section.find(key)) return read_distribution(*value, dimension);
  return Distribution::normal(display_unit(dimension).si);
}

FactorIndex factor_named(const StudyValue& value, const ModelDescription& model) {
  return FactorIndex(value.word(names(model.factors)));
}

std::vector<FactorIndex> all_factors(const ModelDescription& model) {
  std::vector<FactorIndex> factors;
  for (std::size_t f = 0; f < model.factors.size(); ++f) factors.emplace_back(f);
  return factors;
}

std::vector<FactorIndex> factors_of_set(const StudyValue& value, const ModelDescription& model) {
  const std::string written = value.text();
  if (const FactorSet* set = model.find_set(written)) return set->factors;
  if (written == "all") return all_factors(model);
  if (model.find_factor(written)) {
    value.fail("is '" + written + "', which is a factor, not a set", "write it as a list: [\"" + written + "\"]");
  }
  std::vector<std::string_view> known = names(model.factor_sets);
  if (model.find_set("all") == nullptr) known.push_back("all");
  value.fail("is '" + printable(written) + "', which is no factor set of the model", suggestion(written, known));
}

std::vector<FactorIndex> read_factors(const StudyValue& value, const ModelDescription& model) {
  if (value.is_text()) return factors_of_set(value, model);
  std::vector<FactorIndex> factors;
  for (const StudyValue& element : value.list()) {
    const FactorIndex factor = factor_named(element, model);
    if (std::find(factors.begin(), factors.end(), factor) != factors.end()) {
      element.fail("names '" + model.factors[factor.value].name + "' a second time, but factors must differ",
                   "remove one of them");
    }
    factors.push_back(factor);
  }
  if (factors.empty()) value.fail("is empty", "name at least one factor, or a factor set");
  return factors;
}

std::optional<Background> read_background(const StudySection& analysis, const ModelDescription& model) {
  if (!analysis.find("background")) return std::nullopt;
  const StudySection section = analysis.section("background");
  section.allow({"factors", "linear", "angular"});
  Background background;
  background.factors = read_factors(section.require("factors", "write a factor set or a list of factors"), model);
  if (const auto value = section.find("linear")) background.linear = value->quantity(Dimension::length);
  if (const auto value = section.find("angular")) background.angular = value->quantity(Dimension::angle);
  return background;
}

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

/// The errors of a case: `linear` and `angular` for all, then factor sets, then single factors, each over the last.
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
  for (const FactorSet& set : model.factor_sets) {
    if (!section.find(set.name)) continue;
    const StudySection sizes = section.section(set.name);
    sizes.allow({"linear", "angular"});
    std::vector<double> all = errors;
    for (const std::string& key : sizes.keys()) set_case_errors(*sizes.find(key), key, model, all);
    for (const FactorIndex factor : set.factors) errors[factor.value] = all[factor.value];
  }
  for (const Factor& factor : model.factors) {
    if (const auto value = section.find(factor.name)) set_case_errors(*value, factor.name, model, errors);
  }
  return errors;
}

/// The text of `name`, which no other of its kind may have.
template <class Named>
std::string read_name(const StudySection& section, const std::vector<Named>& others, const std::string& usual) {
  const auto value = section.find("name");
  const std::string name = value ? value->text() : usual;
  if (value && (name.empty() || name.find_first_of(",;\"\n\r\t") != std::string::npos)) {
    value->fail("is '" + printable(name) + "'",
                "a name is plain text without commas and quotes, for it stands in tables");
  }
  for (const Named& other : others) {
    if (other.name != name) continue;
    if (value) value->fail("is '" + printable(name) + "', which another one has", "give each a name of its own");
    throw InputError(section.place(), "it has no name, and '" + name + "' is taken", "write name = \"...\"");
  }
  return name;
}

std::vector<ErrorCase> read_cases(const StudySection& analysis, const ModelDescription& model,
                                  const std::vector<double>& background, StudyUse use) {
  std::vector<ErrorCase> cases;
  if (const auto value = analysis.find("cases")) {
    for (const StudyValue& one : value->list()) {
      const StudySection section = one.section();
      section.allow({"name", "errors"});
      const std::string name = read_name(section, cases, "case " + std::to_string(cases.size() + 1));
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
      section.allow({"name", "linear", "angular"});
      const std::string name = read_name(section, groups, "group " + std::to_string(groups.size() + 1));
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

/// A share between 0 and 1, both excluded.
double read_share(const StudyValue& value, std::string_view example) {
  const double share = value.number();
  if (!(share > 0.0 && share < 1.0)) {
    value.fail("is " + shortest(share), "it must lie between 0 and 1, e.g. " + std::string(example));
  }
  return share;
}

std::vector<double> read_quantiles(const StudyValue& value) {
  std::vector<double> quantiles;
  for (const StudyValue& one : value.list()) {
    quantiles.push_back(read_share(one, "0.95"));
    if (quantiles.size() > 1 && !(quantiles[quantiles.size() - 2] < quantiles.back())) {
      one.fail("is " + shortest(quantiles.back()) + ", not above the one before it", "write them in ascending order");
    }
  }
  if (quantiles.empty()) value.fail("is empty", "leave it out for 0.05, 0.5 and 0.95");
  return quantiles;
}

ToleranceReference read_reference(const StudyValue& value, const Analysis& analysis, const ModelDescription& model) {
  const StudySection section = value.section();
  section.allow({"factor", "tolerance"});
  const StudyValue factor = section.require("factor", "name the error from which tolerances are counted");
  ToleranceReference reference{factor_named(factor, model), 0.0};
  if (std::ranges::find(analysis.factors, reference.factor) == analysis.factors.end()) {
    factor.fail("is '" + model.factors[reference.factor.value].name + "', which this study does not vary",
                "name one of its factors");
  }
  const Dimension dimension = model.factors[reference.factor.value].dimension;
  const auto tolerance = section.find("tolerance");
  reference.tolerance = tolerance ? tolerance->positive_quantity(dimension) : display_unit(dimension).si;
  return reference;
}

Analysis::Kind read_kind(const StudySection& section) {
  std::vector<std::string_view> words;
  for (const Analysis::Kind kind : kKinds) words.push_back(name(kind));
  const auto value = section.find("kind");
  return value ? kKinds[value->word(words)] : Analysis::Kind::sensitivity;
}

/// Throws for a key that another kind of study has, but not this one.
void refuse_keys_of_other_kinds(const StudySection& section, Analysis::Kind kind) {
  using Kind = Analysis::Kind;
  struct Key {
    std::string_view name;
    std::initializer_list<Kind> kinds;
  };
  static const std::array kKeys{Key{"factors", {Kind::sensitivity, Kind::monte_carlo, Kind::identification}},
                                Key{"samples", {Kind::sensitivity, Kind::monte_carlo}},
                                Key{"conf_level", {Kind::sensitivity, Kind::monte_carlo}},
                                Key{"background", {Kind::sensitivity, Kind::monte_carlo, Kind::evaluate}},
                                Key{"reference", {Kind::sensitivity}},
                                Key{"quantiles", {Kind::monte_carlo}},
                                Key{"groups", {Kind::identification}},
                                Key{"pose_share", {Kind::identification}},
                                Key{"cases", {Kind::evaluate}}};
  for (const Key& key : kKeys) {
    if (std::ranges::find(key.kinds, kind) != key.kinds.end()) continue;
    section.refuse(key.name, "kind = \"" + std::string(name(kind)) + "\"");
  }
}

/// The factor set that a study of this kind takes when it names none.
std::vector<FactorIndex> usual_factors(Analysis::Kind kind, const ModelDescription& model) {
  const FactorSet* set = model.find_set("deforming");
  return kind == Analysis::Kind::sensitivity && set != nullptr ? set->factors : all_factors(model);
}

}  // namespace

ErrorModel read_error_model(const StudySection& root, const ModelDescription& model) {
  const StudySection section = root.section("errors");
  section.allow({"linear", "angular", "override"});
  const Distribution linear = read_default(section, "linear", Dimension::length);
  const Distribution angular = read_default(section, "angular", Dimension::angle);
  const StudySection overrides = section.section("override");
  overrides.allow(names(model.factors), "factor");
  ErrorModel errors;
  for (const Factor& factor : model.factors) {
    const auto value = overrides.find(factor.name);
    const Distribution& usual = factor.dimension == Dimension::length ? linear : angular;
    errors.by_factor.push_back(value ? read_distribution(*value, factor.dimension) : usual);
  }
  return errors;
}

Analysis read_analysis(const StudySection& root, const ModelDescription& model, StudyUse use) {
  using Kind = Analysis::Kind;
  const StudySection section = root.section("analysis");
  section.allow({"kind", "factors", "samples", "conf_level", "background", "reference", "quantiles", "groups",
                 "pose_share", "cases"});
  Analysis analysis;
  analysis.kind = read_kind(section);
  refuse_keys_of_other_kinds(section, analysis.kind);
  if (analysis.kind != Kind::evaluate) {
    const auto value = section.find("factors");
    analysis.factors = value ? read_factors(*value, model) : usual_factors(analysis.kind, model);
  }
  if (const auto value = section.find("samples")) {
    analysis.samples = static_cast<std::size_t>(value->whole_number(2, kMostSolves));
  }
  if (const auto value = section.find("conf_level")) analysis.conf_level = read_share(*value, "0.95");
  analysis.background = read_background(section, model);
  if (const auto value = section.find("reference")) analysis.reference = read_reference(*value, analysis, model);
  if (const auto value = section.find("quantiles")) analysis.quantiles = read_quantiles(*value);
  if (const auto value = section.find("pose_share")) analysis.pose_share = read_share(*value, "0.95");
  if (analysis.kind == Kind::identification) analysis.groups = read_groups(section);
  if (analysis.kind == Kind::evaluate) {
    analysis.cases = read_cases(section, model, background_errors(analysis.background, model), use);
  }
  return analysis;
}

}  // namespace poesy
