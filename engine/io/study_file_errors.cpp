#include <array>
#include <stdexcept>

#include "engine/base/text.h"
#include "engine/io/study_file_parts.h"
#include "engine/io/study_keys.h"

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

/// SI. Fourth powers of an error, and of indices down to rounding times it, then are far above the smallest double.
constexpr double kSmallest = 1e-30;

double read_size(const StudyValue& value, Dimension dimension) {
  const double size = value.positive_quantity(dimension);
  if (size >= kSmallest) return size;
  value.fail("is '" + printable(value.text()) + "', so small that squares of it lose their digits",
             "it must be at least 1e-30 m or 1e-30 rad");
}

/// A parameter of a distribution; 0 and not allowed where the shape has none of that name.
double read_parameter(const StudySection& section, std::string_view key, Shape shape, Dimension dimension) {
  const std::string owner = "the distribution \"" + std::string(name(shape)) + "\"";
  if (holds_for(study_key("errors.linear", key), name(shape)))
    return read_size(section.require(key, owner + " needs it"), dimension);
  section.refuse(key, owner);
  return 0.0;
}

Distribution read_distribution(const StudyValue& value, Dimension dimension) {
  constexpr std::array kShapes{Shape::normal, Shape::truncated_normal, Shape::uniform, Shape::triangular};
  const StudySection section = value.section();
  section.allow();
  std::vector<std::string_view> words;
  for (const Shape shape : kShapes) words.push_back(name(shape));
  const Shape shape = kShapes[section.require("distribution", "write e.g. distribution = \"normal\"").word(words)];
  const double sigma = read_parameter(section, "sigma", shape, dimension);
  const double half_width = read_parameter(section, "half_width", shape, dimension);
  try {
    return make_distribution(shape, sigma, half_width);
  } catch (const std::invalid_argument& reason) {
    value.fail(std::string("is impossible: ") + reason.what(), "correct its parameters");
  }
}

}  // namespace

Distribution read_usual_distribution(const StudySection& root, Dimension dimension) {
  if (const auto value = root.section("errors").find(error_kind(dimension)))
    return read_distribution(*value, dimension);
  return Distribution::normal(display_unit(dimension).si);
}

ErrorModel read_error_model(const StudySection& root, const ModelDescription& model) {
  const StudySection section = root.section("errors");
  section.allow();
  const Distribution linear = read_usual_distribution(root, Dimension::length);
  const Distribution angular = read_usual_distribution(root, Dimension::angle);
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

}  // namespace poesy
