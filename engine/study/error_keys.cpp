#include <fmt/format.h>

#include <stdexcept>

#include "engine/base/text.h"
#include "engine/study/keys.h"
#include "engine/study/study_text.h"

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

/// What a study says of a distribution.
struct Parameters {
  Shape shape = Shape::normal;
  double sigma = 0.0;       ///< SI; 0 where the shape has none
  double half_width = 0.0;  ///< likewise
  Dimension dimension = Dimension::length;
};

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
    return make_distribution(parameters.shape, parameters.sigma, parameters.half_width);
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
  const StudySection overrides = value.section();
  const std::vector<Factor>& factors = study.model().factors;
  overrides.allow(names(factors), "factor");
  for (std::size_t f = 0; f < factors.size(); ++f) {
    const auto own = overrides.find(factors[f].name);
    if (own) study.errors.by_factor[f] = read_distribution(*own, factors[f].dimension);
  }
}

bool same(const Distribution& a, const Distribution& b) {
  return a.shape() == b.shape() && a.sigma() == b.sigma() && a.half_width() == b.half_width();
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
  const std::vector<Distribution>& all = study.errors.by_factor;
  const std::vector<Factor>& factors = study.model().factors;
  Distribution usual = default_distribution(dimension);
  std::ptrdiff_t most = 0;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].dimension != dimension) continue;
    std::ptrdiff_t shared = 0;
    for (std::size_t g = 0; g < factors.size(); ++g) {
      shared += factors[g].dimension == dimension && same(all[f], all[g]) ? 1 : 0;
    }
    if (shared <= most) continue;
    usual = all[f];
    most = shared;
  }
  return usual;
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
    if (same(own, factor.dimension == Dimension::length ? linear : angular)) continue;
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
  const StudyTable overrides{.paths = {"errors.override"},
                             .meaning = "'poesy models MODEL' lists the errors.",
                             .keys = {{.name = "FACTOR",
                                       .type = "table",
                                       .usual = "that of its dimension",
                                       .meaning = "Distribution of this error."}}};
  return {described(errors_keys()), overrides, described(distribution_keys())};
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

}  // namespace poesy
