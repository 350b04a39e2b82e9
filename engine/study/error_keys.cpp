#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "engine/base/name_pattern.h"
#include "engine/base/text.h"
#include "engine/study/bare_numbers.h"
#include "engine/study/study_kind.h"
#include "engine/study/table_file.h"

namespace poesy {
namespace {

using Shape = Distribution::Shape;

/// The smallest size, SI. Fourth powers of an error, and of indices down to rounding times it, are then far above the
/// smallest double.
constexpr double kSmallest = 1e-30;

/// The largest number of values of a measured distribution, because they become part of every result.
constexpr std::size_t kMostMeasured = 10'000;

/// The parameters of a distribution in a study.
struct Parameters {
  Shape shape = Shape::normal;
  double sigma = 0.0;       ///< SI; 0 if the shape has none
  double half_width = 0.0;  ///< SI; 0 if the shape has none
  double shift = 0.0;       ///< SI
  Dimension dimension = Dimension::length;
  std::string file = {};            ///< file of measured values
  std::string column = {};          ///< column of the file
  std::vector<double> values = {};  ///< measured values, SI
  std::string doubt = {};           ///< doubt about their unit
};

/// The distribution without its shift.
Distribution centred_distribution_of(const Parameters& parameters) {
  switch (parameters.shape) {
    case Shape::normal:
      return Distribution::normal(parameters.sigma);
    case Shape::truncated_normal:
      return Distribution::truncated_normal(parameters.sigma, parameters.half_width);
    case Shape::uniform:
      return Distribution::uniform(parameters.half_width);
    case Shape::triangular:
      return Distribution::triangular(parameters.half_width);
    case Shape::measured:
      break;
  }
  if (parameters.values.size() > kMostMeasured) {
    throw std::invalid_argument(fmt::format("values must be at most {}", kMostMeasured));
  }
  Distribution measured = Distribution::measured(parameters.values);
  if (measured.standard_deviation() < kSmallest) {
    throw std::invalid_argument(
        "values are so close to each other that squares of their differences lose their digits");
  }
  return measured;
}

/// A key of a size. read_size: StudyValue::positive_quantity or half_width.
KeyValue<Parameters> size_at(double Parameters::*member, double (StudyValue::*read_size)(Dimension) const) {
  const auto read = [=](const StudyValue& value, Parameters& parameters) {
    parameters.*member = (value.*read_size)(parameters.dimension);
    if (parameters.*member >= kSmallest) return;
    value.fail("is '" + printable(value.text()) + "', so small that squares of it lose their digits",
               "it must be at least 1e-30 m or 1e-30 rad");
  };
  return {.type = "quantity", .bounds = "at least 1e-30 m or rad", .read = read};
}

KeyValue<Parameters> shift_value() {
  const auto read = [](const StudyValue& value, Parameters& parameters) {
    parameters.shift = value.quantity(parameters.dimension);
    if (parameters.shift >= 0.0) return;
    value.fail("is '" + printable(value.text()) + "', below zero",
               "it must be at least 0, because the mean is off to either side as often");
  };
  return {.type = "quantity", .bounds = "at least 0", .read = read};
}

KeyValue<Parameters> values_value() {
  const auto read = [](const StudyValue& value, Parameters& parameters) {
    for (const StudyValue& one : value.list()) parameters.values.push_back(one.quantity(parameters.dimension));
    if (parameters.values.size() >= Distribution::kLeastMeasured) return;
    value.fail(fmt::format("has {} values", parameters.values.size()),
               fmt::format("a distribution is made of at least {}", Distribution::kLeastMeasured));
  };
  return {.type = "list of quantities", .bounds = "at least 8", .read = read};
}

const InnerRows<Parameters>& distribution_keys() {
  static const InnerRows<Parameters> keys{
      .paths = {"errors.linear", "errors.angular", "errors.override.FACTOR"},
      .meaning = "A distribution about zero, or of measured values.",
      .chooser = "distribution",
      .owner = "the distribution",
      .rows = {InnerRow<Parameters>{
                   .name = "distribution",
                   .value = word_at<Shape>(
                       {{Shape::normal, "with sigma"},
                        {Shape::truncated_normal, "with sigma, cut off at -half_width and half_width"},
                        {Shape::uniform, "between -half_width and half_width"},
                        {Shape::triangular, "likeliest at 0, down to nothing at -half_width and half_width"},
                        {Shape::measured,
                         "as parts that were measured: with the mean and the standard deviation (n - 1) of their "
                         "values"}},
                       &Parameters::shape),
                   .missing = "write e.g. {}",
                   .example = "\"normal\"",
                   .meaning = "Shape of the distribution."},
               InnerRow<Parameters>{.name = "sigma",
                                    .value = size_at(&Parameters::sigma, &StudyValue::positive_quantity),
                                    .required = true,
                                    .only_for = {name(Shape::normal), name(Shape::truncated_normal)},
                                    .meaning = "Standard deviation, before it is cut off."},
               InnerRow<Parameters>{
                   .name = "half_width",
                   .value = size_at(&Parameters::half_width, &StudyValue::half_width),
                   .required = true,
                   .only_for = {name(Shape::truncated_normal), name(Shape::uniform), name(Shape::triangular)},
                   .meaning = "Largest possible size of the error, but for its shift; a +- before it, as on a "
                              "drawing, may stay."},
               InnerRow<Parameters>{.name = "shift",
                                    .value = shift_value(),
                                    .usual = "none",
                                    .only_for = {name(Shape::normal), name(Shape::truncated_normal),
                                                 name(Shape::uniform), name(Shape::triangular)},
                                    .meaning = "The mean of the errors is off by this, as often up as down."},
               InnerRow<Parameters>{.name = "file",
                                    .value = text_at(&Parameters::file),
                                    .usual = "",
                                    .only_for = {name(Shape::measured)},
                                    .meaning = "Table with measured values, relative to the study's folder: CSV, the "
                                               "first line names its columns."},
               InnerRow<Parameters>{.name = "column",
                                    .value = text_at(&Parameters::column),
                                    .usual = "",
                                    .only_for = {name(Shape::measured)},
                                    .meaning = "The column of the file; its numbers are in SI (m, rad) unless its name "
                                               "has a unit behind it: hole [mm]."},
               InnerRow<Parameters>{.name = "values",
                                    .value = values_value(),
                                    .usual = "",
                                    .only_for = {name(Shape::measured)},
                                    .meaning = "Instead of file and column: the values. A resolved study has them."}}};
  return keys;
}

Distribution default_distribution(Dimension dimension) { return Distribution::normal(display_unit(dimension).si); }

/// Reads the values of a file if the study names one; returns whether there are any. Files are opened only for a run.
/// usual: the distribution of other errors of this dimension.
bool take_values(const StudySection& section, StudyUse use, const Distribution& usual, Parameters& parameters) {
  if (section.find("values")) {
    for (const std::string_view key : {"file", "column"}) section.refuse(key, "a distribution with values");
    return true;
  }
  static_cast<void>(section.require("file", "write file = \"parts.csv\" and column = \"...\", or values = [...]"));
  static_cast<void>(section.require("column", "name the column of the file that has the values"));
  if (use != StudyUse::run) return false;
  const std::string path = beside_study(section, parameters.file);
  MeasuredColumn column = read_column(path, parameters.column, parameters.dimension);
  parameters.doubt = bare_column_text(parameters.file, column, parameters.dimension, usual);
  parameters.values = std::move(column.values);
  if (parameters.values.size() >= Distribution::kLeastMeasured) return true;
  throw InputError(
      {path},
      fmt::format("column '{}' has too few values for a distribution: {}", printable(parameters.column),
                  parameters.values.size()),
      fmt::format("measure at least {} parts, or write a distribution with sigma", Distribution::kLeastMeasured));
}

/// Reads a distribution. usual: that of other errors of this dimension. doubts: receives doubts about a file of
/// measured values.
Distribution read_distribution(const StudyValue& value, Dimension dimension, StudyUse use, const Distribution& usual,
                               std::vector<std::string>& doubts) {
  const StudySection section = value.section();
  Parameters parameters{.dimension = dimension};
  read_keys(distribution_keys(), section, parameters, Nothing());
  const std::string word = chosen_word(distribution_keys(), parameters);
  for (const auto& row : distribution_keys().rows) {
    if (!row.required || !holds_for(row.only_for, word)) continue;
    static_cast<void>(section.require(row.name, "the distribution \"" + word + "\" needs it"));
  }
  if (parameters.shape == Shape::measured && !take_values(section, use, usual, parameters)) {
    return default_distribution(dimension);
  }
  if (!parameters.doubt.empty()) doubts.push_back(parameters.doubt);
  try {
    return centred_distribution_of(parameters).shifted(parameters.shift);
  } catch (const std::invalid_argument& reason) {
    value.fail(std::string("is impossible: ") + reason.what(), "correct its parameters");
  }
}

template <Dimension kDimension>
void read_usual(const StudyValue& value, Study& study, const Reading& reading) {
  const Distribution distribution =
      read_distribution(value, kDimension, reading.use, default_distribution(kDimension), study.doubts);
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    if (study.model().factors[f].dimension == kDimension) study.errors.by_factor[f] = distribution;
  }
}

/// What [errors.override] says of a factor: the last key in the file that is its name or a pattern of it.
std::optional<StudyValue> override_of(const StudySection& overrides, const std::string& factor) {
  const auto place = [](const StudyValue& value) { return std::pair(value.place().line, value.place().column); };
  std::optional<StudyValue> last;
  for (const std::string& key : overrides.keys()) {
    if (key != factor && !(is_pattern(key) && matches(key, factor))) continue;
    StudyValue own = overrides.require(key);
    if (!last || place(own) > place(*last)) last = std::move(own);
  }
  return last;
}

/// Throws for a key that is the name of no factor, and for a pattern that none matches.
void check_override(const StudySection& overrides, const ModelDescription& model) {
  const std::vector<std::string> keys = overrides.keys();
  std::vector<std::string_view> known = names(model.factors);
  for (const std::string& key : keys) {
    if (!is_pattern(key)) continue;
    known.push_back(key);
    if (std::ranges::any_of(model.factors, [&](const Factor& factor) { return matches(key, factor.name); })) continue;
    overrides.require(key).fail("matches no error of the mechanism", "'poesy models " + model.name + "' lists them");
  }
  overrides.allow(known, "factor");
}

void read_override(const StudyValue& value, Study& study, const Reading& reading) {
  const StudySection overrides = value.section();
  check_override(overrides, study.model());
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    const Factor& factor = study.model().factors[f];
    Distribution& distribution = study.errors.by_factor[f];
    if (const auto own = override_of(overrides, factor.name)) {
      distribution = read_distribution(*own, factor.dimension, reading.use, distribution, study.doubts);
    }
  }
}

/// The values as a TOML list over several lines, to keep lines of a study file short.
std::string values_text(std::span<const double> values, Dimension dimension, ValueText value) {
  constexpr std::size_t kOfLine = 5;
  std::string text = "[";
  for (std::size_t k = 0; k < values.size(); ++k) {
    text += (k % kOfLine == 0 ? "\n  " : " ") + value(values[k], dimension) + ",";
  }
  return text + "\n]";
}

std::string distribution_text(const Distribution& distribution, Dimension dimension, ValueText value) {
  const auto sigma = [&] { return ", sigma = " + value(distribution.sigma(), dimension); };
  const auto half_width = [&] { return ", half_width = " + value(distribution.half_width(), dimension); };
  std::string text = fmt::format("{{ distribution = {}", in_quotes(name(distribution.shape())));
  switch (distribution.shape()) {
    case Shape::normal:
      text += sigma();
      break;
    case Shape::truncated_normal:
      text += sigma() + half_width();
      break;
    case Shape::uniform:
    case Shape::triangular:
      text += half_width();
      break;
    case Shape::measured:
      text += ", values = " + values_text(distribution.parts()->values(), dimension, value);
      break;
  }
  if (distribution.shift() > 0.0) text += ", shift = " + value(distribution.shift(), dimension);
  return text + " }";
}

/// The distribution that most factors of this dimension have, to which `linear` or `angular` is set.
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

/// Refuses at the value that determines the factor's distribution: the first of these keys that it has, or else sigma.
[[noreturn]] void refuse_distribution(const StudySection& root, const Factor& factor, const std::string& problem,
                                      std::span<const std::string_view> keys) {
  const StudySection errors = root.section("errors");
  const auto own = override_of(errors.section("override"), factor.name);
  const auto value = own ? own : errors.find(error_kind(factor.dimension));
  if (!value) refuse_error(errors, error_kind(factor.dimension), problem);
  const StudySection distribution = value->section();
  for (const std::string_view key : keys) {
    if (distribution.find(key)) refuse_error(distribution, key, problem);
  }
  refuse_error(distribution, "sigma", problem);
}

/// Checks the distributions of the factors that vary by their largest possible error, or the standard deviation of a
/// normal.
void check_distributions(const StudySection& root, const Study& study, const Model& model) {
  for (const FactorIndex factor : study.analysis.factors) {
    const Distribution& distribution = study.errors.by_factor[factor.value];
    const bool bounded = std::isfinite(distribution.half_width());
    const std::string_view what = bounded ? "a largest error" : "a standard deviation";
    const double size = error_size(distribution);
    const auto problem = beyond_bound(model, factor, size, what);
    if (!problem) continue;
    constexpr std::array<std::string_view, 4> kKeys{"shift", "half_width", "values", "column"};
    const double without_shift = bounded ? distribution.half_width() : distribution.sigma();
    const bool too_large_without = beyond_bound(model, factor, without_shift, what).has_value();
    refuse_distribution(root, model.description().factors[factor.value], *problem,
                        std::span(kKeys).subspan(too_large_without ? 1 : 0));
  }
}

}  // namespace

const StudyRows& errors_keys() {
  static const StudyRows keys{.paths = {"errors"},
                              .meaning = "How the errors that vary scatter, by their dimension.",
                              .rows = {usual_row<Dimension::length>("Distribution of every length."),
                                       usual_row<Dimension::angle>("Distribution of every angle."),
                                       StudyRow{.name = "override",
                                                .value = {.type = "table"},
                                                .usual = "none",
                                                .meaning = "Errors with a distribution of their own.",
                                                .reader = read_override,
                                                .lines = override_lines,
                                                .shown = shown_override},
                                       correlated_row()}};
  return keys;
}

StudyTables errors_tables() {
  return {described(errors_keys()),
          {.paths = {"errors.override"},
           .meaning = "'poesy models MODEL' lists the errors.",
           .keys = {{.name = "FACTOR",
                     .type = "table",
                     .usual = "that of its dimension",
                     .meaning = "Distribution of this error, or of all whose names match \"rod_*\", with '*' for any "
                                "letters and '?' for one; the last key of the file that fits an error counts."}}},
          described(distribution_keys()),
          correlated_table()};
}

Distribution usual_distribution(const Reading& reading, Dimension dimension) {
  const auto value = reading.root.section("errors").find(error_kind(dimension));
  std::vector<std::string> said_with_the_errors;
  return value
             ? read_distribution(*value, dimension, reading.use, default_distribution(dimension), said_with_the_errors)
             : default_distribution(dimension);
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
