#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/base/text.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

using Shape = Distribution::Shape;

/// SI. Fourth powers of an error, and of indices down to rounding times it, then are far above the smallest double.
constexpr double kSmallest = 1e-30;

/// What a study says of a distribution.
struct Parameters {
  Shape shape = Shape::normal;
  double sigma = 0.0;       ///< SI; 0 where the shape has none
  double half_width = 0.0;  ///< likewise
  Dimension dimension = Dimension::length;
};

Distribution distribution_of(const Parameters& parameters) {
  const auto& [shape, sigma, half_width, dimension] = parameters;
  if (shape == Shape::normal) return Distribution::normal(sigma);
  if (shape == Shape::truncated_normal) return Distribution::truncated_normal(sigma, half_width);
  return shape == Shape::uniform ? Distribution::uniform(half_width) : Distribution::triangular(half_width);
}

KeyValue<Parameters> size_at(double Parameters::*member) {
  const auto read = [=](const StudyValue& value, Parameters& parameters) {
    parameters.*member = value.positive_quantity(parameters.dimension);
    if (parameters.*member >= kSmallest) return;
    value.fail("is '" + printable(value.text()) + "', so small that squares of it lose their digits",
               "it must be at least 1e-30 m or 1e-30 rad");
  };
  return {.type = "quantity", .bounds = "at least 1e-30 m or rad", .read = read};
}

const InnerRows<Parameters>& distribution_keys() {
  static const InnerRows<Parameters> keys{
      .paths = {"errors.linear", "errors.angular", "errors.override.FACTOR"},
      .meaning = "A distribution about zero.",
      .chooser = "distribution",
      .owner = "the distribution",
      .rows = {InnerRow<Parameters>{
                   .name = "distribution",
                   .value = word_at<Shape>(
                       {{Shape::normal, "with sigma"},
                        {Shape::truncated_normal, "with sigma, cut off at -half_width and half_width"},
                        {Shape::uniform, "between -half_width and half_width"},
                        {Shape::triangular, "likeliest at 0, down to nothing at -half_width and half_width"}},
                       &Parameters::shape),
                   .missing = "write e.g. {}",
                   .example = "\"normal\"",
                   .meaning = "Shape of the distribution."},
               InnerRow<Parameters>{.name = "sigma",
                                    .value = size_at(&Parameters::sigma),
                                    .required = true,
                                    .only_for = {name(Shape::normal), name(Shape::truncated_normal)},
                                    .meaning = "Standard deviation, before it is cut off."},
               InnerRow<Parameters>{
                   .name = "half_width",
                   .value = size_at(&Parameters::half_width),
                   .required = true,
                   .only_for = {name(Shape::truncated_normal), name(Shape::uniform), name(Shape::triangular)},
                   .meaning = "Largest possible size of the error."}}};
  return keys;
}

Distribution read_distribution(const StudyValue& value, Dimension dimension) {
  const StudySection section = value.section();
  Parameters parameters{.dimension = dimension};
  read_keys(distribution_keys(), section, parameters, Nothing());
  const std::string word = chosen_word(distribution_keys(), parameters);
  for (const auto& row : distribution_keys().rows) {
    if (!row.required || !holds_for(row.only_for, word)) continue;
    static_cast<void>(section.require(row.name, "the distribution \"" + word + "\" needs it"));
  }
  try {
    return distribution_of(parameters);
  } catch (const std::invalid_argument& reason) {
    value.fail(std::string("is impossible: ") + reason.what(), "correct its parameters");
  }
}

Distribution default_distribution(Dimension dimension) { return Distribution::normal(display_unit(dimension).si); }

template <Dimension kDimension>
void read_usual(const StudyValue& value, Study& study, const Reading&) {
  const Distribution distribution = read_distribution(value, kDimension);
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    if (study.model().factors[f].dimension == kDimension) study.errors.by_factor[f] = distribution;
  }
}

void read_override(const StudyValue& value, Study& study, const Reading&) {
  const std::vector<Factor>& factors = study.model().factors;
  read_named(value.section(), factors, "factor", [&](std::size_t f, const StudyValue& own) {
    study.errors.by_factor[f] = read_distribution(own, factors[f].dimension);
  });
}

std::string distribution_text(const Distribution& distribution, Dimension dimension, ValueText value) {
  const Shape shape = distribution.shape();
  std::string text = fmt::format("{{ distribution = {}", in_quotes(name(shape)));
  if (shape == Shape::normal || shape == Shape::truncated_normal) {
    text += ", sigma = " + value(distribution.sigma(), dimension);
  }
  if (shape != Shape::normal) text += ", half_width = " + value(distribution.half_width(), dimension);
  return text + " }";
}

/// The distribution that most factors of this dimension have: what `linear` or `angular` is set to.
Distribution commonest_distribution(const Study& study, Dimension dimension) {
  const std::vector<Factor>& factors = study.model().factors;
  std::vector<Distribution> all;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].dimension == dimension) all.push_back(study.errors.by_factor[f]);
  }
  const auto uses = [&](const Distribution& distribution) { return std::ranges::count(all, distribution); };
  const auto commonest = std::ranges::max_element(all, {}, uses);
  return commonest == all.end() ? default_distribution(dimension) : *commonest;
}

template <Dimension kDimension>
std::string usual_line(const Study& study) {
  return fmt::format("{} = {}\n", error_kind(kDimension),
                     distribution_text(commonest_distribution(study, kDimension), kDimension, exact_value));
}

std::string override_lines(const Study& study) {
  const Distribution linear = commonest_distribution(study, Dimension::length);
  const Distribution angular = commonest_distribution(study, Dimension::angle);
  std::string text;
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    const Factor& factor = study.model().factors[f];
    const Distribution& own = study.errors.by_factor[f];
    if (own == (factor.dimension == Dimension::length ? linear : angular)) continue;
    text += factor.name + " = " + distribution_text(own, factor.dimension, exact_value) + "\n";
  }
  return text.empty() ? "" : "\n[errors.override]\n" + text;
}

std::string shown_override(const TemplateLines& lines, const Study& study) {
  if (study.model().factors.empty()) return {};
  const Factor& factor = study.model().factors.front();
  return lines.explained("errors", "override",
                         fmt::format("# override = {{ {} = {{ distribution = \"uniform\", half_width = {} }} }}",
                                     factor.name, example_size(factor.dimension, 0.5)));
}

template <Dimension kDimension>
StudyRow usual_row(std::string_view meaning) {
  return {.name = error_kind(kDimension),
          .value = {.type = "table"},
          .usual = "`" + distribution_text(default_distribution(kDimension), kDimension, readable_value) + "`",
          .meaning = meaning,
          .reader = read_usual<kDimension>,
          .lines = usual_line<kDimension>};
}

/// At what gives the factor its distribution.
[[noreturn]] void refuse_distribution(const StudySection& root, const Factor& factor, const std::string& problem) {
  const StudySection errors = root.section("errors");
  const auto own = errors.section("override").find(factor.name);
  const auto value = own ? own : errors.find(error_kind(factor.dimension));
  if (!value) refuse_error(errors, error_kind(factor.dimension), problem);
  const StudySection distribution = value->section();
  refuse_error(distribution, distribution.find("half_width") ? "half_width" : "sigma", problem);
}

/// Of the distributions of what varies: the largest possible error, for a normal its standard deviation.
void check_distributions(const StudySection& root, const Study& study, const Model& model) {
  for (const FactorIndex factor : study.analysis.factors) {
    const Distribution& distribution = study.errors.by_factor[factor.value];
    const bool bounded = std::isfinite(distribution.half_width());
    const auto problem =
        beyond_bound(model, factor, bounded ? distribution.half_width() : distribution.standard_deviation(),
                     bounded ? "a largest error" : "a standard deviation");
    if (problem) refuse_distribution(root, model.description().factors[factor.value], *problem);
  }
}

}  // namespace

const StudyRows& errors_keys() {
  static const StudyRows keys{.paths = {"errors"},
                              .meaning = "How the errors that vary scatter about zero, by their dimension.",
                              .rows = {usual_row<Dimension::length>("Distribution of every length."),
                                       usual_row<Dimension::angle>("Distribution of every angle."),
                                       StudyRow{.name = "override",
                                                .value = {.type = "table"},
                                                .usual = "none",
                                                .meaning = "Single errors with a distribution of their own.",
                                                .reader = read_override,
                                                .lines = override_lines,
                                                .shown = shown_override}}};
  return keys;
}

StudyTables errors_tables() {
  return {described(errors_keys()),
          {.paths = {"errors.override"},
           .meaning = "'poesy models MODEL' lists the errors.",
           .keys = {{.name = "FACTOR",
                     .type = "table",
                     .usual = "that of its dimension",
                     .meaning = "Distribution of this error."}}},
          described(distribution_keys())};
}

Distribution usual_distribution(const StudySection& root, Dimension dimension) {
  const auto value = root.section("errors").find(error_kind(dimension));
  return value ? read_distribution(*value, dimension) : default_distribution(dimension);
}

void read_errors_section(Study& study, const Reading& reading) {
  for (const Factor& factor : study.model().factors) {
    study.errors.by_factor.push_back(default_distribution(factor.dimension));
  }
  read_keys(errors_keys(), reading.root.section("errors"), study, reading);
}

void refuse_error(const StudySection& section, std::string_view key, const std::string& problem) {
  if (const auto value = section.find(key)) value->fail(problem, kTooLargeRemedy);
  throw InputError(section.place(), "the default of " + std::string(key) + " " + problem, kTooLargeRemedy);
}

void check_error_size(const Model& model, FactorIndex factor, double linear, double angular,
                      const StudySection& section) {
  const Dimension dimension = model.description().factors[factor.value].dimension;
  const double size = dimension == Dimension::length ? linear : angular;
  if (const auto problem = beyond_bound(model, factor, size, "an error")) {
    refuse_error(section, error_kind(dimension), *problem);
  }
}

void check_error_bounds(const StudySection& root, const Study& study, const Model& model) {
  const StudySection analysis = root.section("analysis");
  const StudyKind& kind = *study.analysis.kind;
  if (kind.varies != Varies::none) check_distributions(root, study, model);
  if (const auto& held = study.analysis.background) {
    for (const FactorIndex factor : held->factors) {
      check_error_size(model, factor, held->linear, held->angular, analysis.section("background"));
    }
  }
  if (kind.check_errors != nullptr) kind.check_errors(analysis, study, model);
}

}  // namespace poesy
