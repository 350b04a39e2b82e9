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

void check_case(const StudySection& section, const ModelDescription& model) {
  section.allow({"name", "errors"});
  if (const auto value = section.find("name")) static_cast<void>(value->text());
  const StudySection errors = section.section("errors");
  std::vector<std::string_view> known = names(model.factors);
  known.insert(known.end(), {"linear", "angular"});
  errors.allow(known, "factor");
  for (const std::string& key : errors.keys()) {
    const auto factor = model.find_factor(key);
    const Dimension by_key = key == "linear" ? Dimension::length : Dimension::angle;
    static_cast<void>(errors.find(key)->quantity(factor ? model.factors[factor->value].dimension : by_key));
  }
}

Analysis::Kind read_kind(const StudySection& section, const ModelDescription& model, StudyUse use) {
  using Kind = Analysis::Kind;
  constexpr std::array kKinds{Kind::sensitivity, Kind::identification, Kind::evaluate, Kind::monte_carlo};
  std::vector<std::string_view> words;
  for (const Kind kind : kKinds) words.push_back(name(kind));
  const auto value = section.find("kind");
  const Kind kind = value ? kKinds[value->word(words)] : Kind::sensitivity;
  if (use == StudyUse::run && kind != Kind::sensitivity) {
    value->fail("is \"" + std::string(name(kind)) + "\", which is not available yet in this version",
                "use \"sensitivity\"");
  }
  if (kind != Kind::evaluate) section.refuse("cases", "kind = \"" + std::string(name(kind)) + "\"");
  if (const auto cases = section.find("cases")) {
    for (const StudyValue& one : cases->list()) check_case(one.section(), model);
  }
  return kind;
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
  const StudySection section = root.section("analysis");
  section.allow({"kind", "factors", "samples", "conf_level", "background", "cases"});
  Analysis analysis;
  analysis.kind = read_kind(section, model, use);
  if (const auto value = section.find("factors")) {
    analysis.factors = read_factors(*value, model);
  } else {
    const FactorSet* usual = model.find_set("deforming");
    analysis.factors = usual != nullptr ? usual->factors : all_factors(model);
  }
  if (const auto value = section.find("samples")) {
    analysis.samples = static_cast<std::size_t>(value->whole_number(2, kMostSolves));
  }
  if (const auto value = section.find("conf_level")) {
    analysis.conf_level = value->number();
    if (!(analysis.conf_level > 0.0 && analysis.conf_level < 1.0)) {
      value->fail("is " + shortest(analysis.conf_level), "it must lie between 0 and 1, e.g. 0.95");
    }
  }
  analysis.background = read_background(section, model);
  return analysis;
}

}  // namespace poesy
