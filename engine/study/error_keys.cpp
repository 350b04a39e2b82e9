#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/base/name_pattern.h"
#include "engine/base/text.h"
#include "engine/fits/fit.h"
#include "engine/study/bare_numbers.h"
#include "engine/study/override_keys.h"
#include "engine/study/study_kind.h"
#include "engine/study/table_file.h"

namespace poesy {
namespace {

using Shape = Distribution::Shape;

/// The smallest size of an error that a study may state, SI. If an error has no effect, the responses to it are
/// rounding errors of about 1e-16 times the error. Even the fourth power of a response to the smallest error, 1e-184,
/// is far above the smallest double, so that no moment of a response underflows.
constexpr double kSmallest = 1e-30;

/// The largest number of values of a measured distribution. Every result stores them, so they must stay few.
constexpr std::size_t kMostMeasured = 10'000;

/// The distribution of an error as the keys of a study state it.
struct Parameters {
  Shape shape = Shape::normal;
  double sigma = 0.0;  ///< standard deviation before the distribution is cut off, SI; 0 if the shape has no such key
  double half_width = 0.0;  ///< largest magnitude before shift and mean are added, SI; 0 if the shape has no such key
  double shift = 0.0;       ///< the errors scatter about -shift or +shift with probability 1/2 each; SI
  double mean = 0.0;        ///< mean, SI
  /// The key `limits`: ends of the distribution, SI; none if it is not stated. take_limits() computes from it the mean,
  /// and half_width or, for a normal distribution, sigma.
  std::optional<SizeLimits> limits = {};
  /// For a normal distribution with limits: distance from the mean to a limit, in standard deviations.
  double sigmas = 0.0;
  Draws draws = Draws::per_machine;
  Dimension dimension = Dimension::length;
  std::string file = {};            ///< name of the file with measured values, as in the study
  std::string column = {};          ///< title of the column with measured values in this file
  std::vector<double> values = {};  ///< measured values, SI
  std::string doubt = {};           ///< warning about the unit of the measured values; empty if there is none
};

/// The distribution that the parameters state, before shift and mean are added.
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
    case Shape::given:
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

/// The KeyValue of a key that states the size of an error. read_size: the function that reads the quantity,
/// StudyValue::positive_quantity or half_width.
KeyValue<Parameters> size_at(double Parameters::*member, double (StudyValue::*read_size)(Dimension) const) {
  const auto read = [=](const StudyValue& value, Parameters& parameters) {
    parameters.*member = (value.*read_size)(parameters.dimension);
    if (parameters.*member >= kSmallest) return;
    value.fail("is '" + printable(value.text()) + "', so small that squares of it lose their digits",
               "it must be at least 1e-30 m or 1e-30 rad");
  };
  return {.type = "quantity", .bounds = "at least 1e-30 m or rad", .read = read};
}

/// An example of the key `limits`, for messages.
std::string_view example_limits(Dimension dimension) {
  if (dimension == Dimension::number) return "[\"-0.1 %\", 0]";
  return dimension == Dimension::angle ? "[\"-0.1 deg\", 0]" : "[\"-0.1 mm\", 0]";
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

/// Reads one end of the key `limits`, SI: a quantity, or 0 without a unit.
double limit_of(const StudyValue& value, Dimension dimension) {
  return value.is_zero() ? 0.0 : value.quantity(dimension);
}

/// Reads the limits of an error from a size with its tolerance zone of ISO 286, as on a drawing: "217 h6".
SizeLimits read_size_limits(const StudyValue& value, Dimension dimension) {
  if (dimension != Dimension::length) {
    value.fail("is '" + printable(value.text()) + "', but zones of ISO 286 are of lengths",
               "write two quantities: " + std::string(example_limits(dimension)));
  }
  try {
    return size_limits(value.text());
  } catch (const std::invalid_argument& reason) {
    value.fail(std::string("cannot be read: ") + reason.what(),
               "write \"217 h6\", or two quantities: " + std::string(example_limits(dimension)));
  }
}

SizeLimits read_two_limits(const StudyValue& value, Dimension dimension) {
  const auto ends = value.list(2, "write two, e.g. " + std::string(example_limits(dimension)));
  const SizeLimits limits{limit_of(ends[0], dimension), limit_of(ends[1], dimension)};
  if (limits.upper - limits.lower >= 2.0 * kSmallest) return limits;
  const std::string problem = limits.lower < limits.upper ? "are so close that squares lose their digits"
                                                          : "have the second no larger than the first";
  value.fail(problem, "write the smaller limit first, e.g. " + std::string(example_limits(dimension)));
}

KeyValue<Parameters> limits_value() {
  const auto read = [](const StudyValue& value, Parameters& parameters) {
    parameters.limits =
        value.is_text() ? read_size_limits(value, parameters.dimension) : read_two_limits(value, parameters.dimension);
  };
  return {.type = "two quantities, or a text", .bounds = "the smaller one first", .read = read};
}

KeyValue<Parameters> mean_value() {
  const auto read = [](const StudyValue& value, Parameters& parameters) {
    parameters.mean = value.is_zero() ? 0.0 : value.quantity(parameters.dimension);
  };
  return {.type = "quantity", .read = read};
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

InnerRow<Parameters> draws_row() {
  return {.name = "draws",
          .value = word_at<Draws>(
              {{Draws::per_machine, "a machine has the same error at every pose"},
               {Draws::per_pose, "a machine has another error at each pose: end stops, backlash, repeatability"}},
              &Parameters::draws),
          .meaning =
              "When the error is drawn in a study of machines (draws = \"per machine\" in [analysis]); alone in "
              "a table of [errors.override] it leaves the distribution as it is."};
}

const InnerRows<Parameters>& distribution_keys() {
  static const InnerRows<Parameters> keys{
      .paths = {"errors.linear", "errors.angular", "errors.relative", "errors.override.FACTOR"},
      .meaning = "A distribution about zero or a mean, between limits, or of measured values.",
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
                                    .besides = " (a normal may have limits instead)",
                                    .only_for = {name(Shape::normal), name(Shape::truncated_normal)},
                                    .meaning = "Standard deviation, before it is cut off."},
               InnerRow<Parameters>{
                   .name = "half_width",
                   .value = size_at(&Parameters::half_width, &StudyValue::half_width),
                   .required = true,
                   .besides = " (or limits instead)",
                   .only_for = {name(Shape::truncated_normal), name(Shape::uniform), name(Shape::triangular)},
                   .meaning = "Largest possible size of the error, but for its shift and mean; a +- before it, as on "
                              "a drawing, may stay."},
               InnerRow<Parameters>{.name = "mean",
                                    .value = mean_value(),
                                    .usual = "`0`",
                                    .only_for = {name(Shape::normal), name(Shape::truncated_normal),
                                                 name(Shape::uniform), name(Shape::triangular)},
                                    .meaning = "The middle of the distribution, with its sign: all errors are off by "
                                               "this."},
               InnerRow<Parameters>{
                   .name = "limits",
                   .value = limits_value(),
                   .usual = "",
                   .example = "[\"-0.1 mm\", 0]",
                   .only_for = {name(Shape::normal), name(Shape::truncated_normal), name(Shape::uniform),
                                name(Shape::triangular)},
                   .meaning = "Instead of mean and half_width, of a normal of mean and sigma: the smallest and the "
                              "largest error, or those of a size with its zone in ISO 286, \"217 h6\" (mm; holes H, "
                              "shafts d, e, f, g, h, up to 500 mm)."},
               InnerRow<Parameters>{.name = "sigmas",
                                    .value = number_at(above_zero("3"), &Parameters::sigmas),
                                    .usual = "",
                                    .only_for = {name(Shape::normal)},
                                    .meaning = "Standard deviations of a normal from its mean to each of its limits: "
                                               "3 lets 0.27 % of the errors lie beyond them."},
               InnerRow<Parameters>{.name = "shift",
                                    .value = shift_value(),
                                    .usual = "none",
                                    .only_for = {name(Shape::normal), name(Shape::truncated_normal),
                                                 name(Shape::uniform), name(Shape::triangular)},
                                    .meaning = "The mean of the errors is off by this, as often up as down."},
               draws_row(),
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

/// The distribution of errors for which the study states no distribution: normal, with a standard deviation of 1 mm, 1
/// deg or 0.1 %.
Distribution default_distribution(Dimension dimension) {
  return Distribution::normal(dimension == Dimension::number ? 1e-3 : display_unit(dimension).si);
}

bool has_errors_of(Dimension dimension, const ModelDescription& model) {
  return std::ranges::find(model.factors, dimension, &Factor::dimension) != model.factors.end();
}

/// Reads the measured values of a distribution from the file that the study names, if the study is read for a run; for
/// other uses, files stay closed. usual: the distribution of other errors of this dimension. Returns true if the values
/// are known, from the file or from the study itself.
bool take_values(const StudySection& section, StudyUse use, const Distribution& usual, Parameters& parameters) {
  if (section.find("values")) {
    for (const std::string_view key : {"file", "column"}) section.refuse(key, "a distribution with values");
    return true;
  }
  const StudyValue file = section.require("file", "write file = \"parts.csv\" and column = \"...\", or values = [...]");
  static_cast<void>(section.require("column", "name the column of the file that has the values"));
  if (use != StudyUse::run) return false;
  const std::string path = named_file(file);
  MeasuredColumn column = read_column(path, parameters.column, parameters.dimension);
  parameters.doubt = bare_column_text(parameters.file, column, parameters.dimension, usual);
  if (parameters.doubt.empty()) {
    parameters.doubt = odd_value_text(parameters.file, column.name, parameters.dimension, column.values);
  }
  parameters.values = std::move(column.values);
  if (parameters.values.size() >= Distribution::kLeastMeasured) return true;
  throw InputError(
      {path},
      fmt::format("column '{}' has too few values for a distribution: {}", printable(parameters.column),
                  parameters.values.size()),
      fmt::format("measure at least {} parts, or write a distribution with sigma", Distribution::kLeastMeasured));
}

/// The distribution of an error, and whether it is drawn at each pose or once for each machine.
struct StatedError {
  Distribution distribution;
  Draws draws = Draws::per_machine;

  friend bool operator==(const StatedError&, const StatedError&) = default;
};

/// Computes the mean and the size (sigma or half_width) of a distribution from the key `limits`, if it is stated.
/// Throws InputError if other keys state the mean or the size, too.
void take_limits(const StudySection& section, Parameters& parameters) {
  const bool is_normal = parameters.shape == Shape::normal;
  if (!parameters.limits) {
    if (const auto sigmas = section.find("sigmas")) sigmas->fail("is set without limits", "write limits, or sigma");
    return;
  }
  for (const std::string_view key : {"mean", "shift", "half_width"}) {
    section.refuse(key, "a distribution with limits");
  }
  if (is_normal) {
    section.refuse("sigma", "a normal distribution with limits");
    static_cast<void>(section.require("sigmas", "a normal distribution with limits needs it, e.g. sigmas = 3"));
  }
  const auto [lower, upper] = *parameters.limits;
  parameters.mean = 0.5 * (lower + upper);
  (is_normal ? parameters.sigma : parameters.half_width) =
      is_normal ? (upper - lower) / (2.0 * parameters.sigmas) : 0.5 * (upper - lower);
}

/// Throws InputError if a key is missing that the distribution needs. word: name of the distribution in the study file.
void require_sizes(const StudySection& section, const std::string& word, const Parameters& parameters) {
  for (const auto& row : distribution_keys().rows) {
    if (!row.required || !holds_for(row.only_for, word)) continue;
    const bool has_limits = parameters.limits && (row.name == "half_width" || parameters.shape == Shape::normal);
    if (!has_limits) static_cast<void>(section.require(row.name, "the distribution \"" + word + "\" needs it"));
  }
}

/// A uniform distribution as TOML, with a half-width that a user wrote as on a drawing, such as "+-0.02 mm". If
/// `written` cannot be read, or is not greater than zero, an example replaces it.
std::string uniform_line(std::string_view written, Dimension dimension) {
  std::string size = dimension == Dimension::number ? "0.1 %" : fmt::format("0.02 {}", display_unit(dimension).name);
  for (const std::string_view sign : {"", "+-", "+/-", "\u00b1"}) {
    if (!written.starts_with(sign)) continue;
    try {
      const std::string_view bare = trimmed(written.substr(sign.size()));
      const Quantity quantity = parse_quantity(bare, dimension);
      if (quantity.dimension == dimension && quantity.si > 0.0) size = bare;
    } catch (const QuantityError&) {  // `size` stays the example
    }
  }
  return fmt::format("{{ distribution = \"uniform\", half_width = \"{}\" }}", size);
}

/// Throws InputError if the value is a text, such as a size, instead of a table with a distribution.
void refuse_size(const StudyValue& value, Dimension dimension) {
  if (!value.is_text()) return;
  const std::string written = printable(value.text());
  value.fail(fmt::format("is the text '{}'", written),
             "write a distribution, e.g. " + uniform_line(written, dimension));
}

/// Reads the distribution of an error, and whether it is drawn at each pose or once for each machine. usual: the
/// distribution of other errors of this dimension. doubts: receives a warning if the unit of measured values looks
/// wrong.
StatedError read_error(const StudyValue& value, Dimension dimension, StudyUse use, const Distribution& usual,
                       std::vector<std::string>& doubts) {
  refuse_size(value, dimension);
  const StudySection section = value.section();
  Parameters parameters{.dimension = dimension};
  read_keys(distribution_keys(), section, parameters, Nothing());
  require_sizes(section, chosen_word(distribution_keys(), parameters), parameters);
  take_limits(section, parameters);
  if (parameters.shape == Shape::measured && !take_values(section, use, usual, parameters)) {
    return {default_distribution(dimension), parameters.draws};
  }
  if (!parameters.doubt.empty()) doubts.push_back(parameters.doubt);
  try {
    return {centred_distribution_of(parameters).shifted(parameters.shift).about(parameters.mean), parameters.draws};
  } catch (const std::invalid_argument& reason) {
    value.fail(std::string("is impossible: ") + reason.what(), "correct its parameters");
  }
}

/// The distribution of this factor in a study, and whether it is drawn at each pose or once for each machine.
StatedError stated_error(const ErrorModel& errors, std::size_t f) {
  return {errors.by_factor[f], errors.is_per_pose(FactorIndex(f)) ? Draws::per_pose : Draws::per_machine};
}

void set_error(const StatedError& error, std::size_t f, ErrorModel& errors) {
  errors.by_factor[f] = error.distribution;
  std::erase(errors.per_pose, FactorIndex(f));
  if (error.draws == Draws::per_machine) return;
  errors.per_pose.insert(std::ranges::upper_bound(errors.per_pose, FactorIndex(f)), FactorIndex(f));
}

template <Dimension kDimension>
void read_usual(const StudyValue& value, Study& study, const Reading& reading) {
  if (kDimension == Dimension::number && !has_errors_of(kDimension, study.model())) {
    value.fail("has no meaning for " + study.model().name + ", whose errors are lengths and angles",
               "remove it; errors with grows_with are numbers");
  }
  const StatedError error = read_error(value, kDimension, reading.use, default_distribution(kDimension), study.doubts);
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    if (study.model().factors[f].dimension == kDimension) set_error(error, f, study.errors);
  }
  set_by_zones(study);
}

/// Throws InputError for a key that names no factor, and for a pattern that matches none.
void check_override(const StudySection& overrides, const Study& study) {
  const ModelDescription& model = study.model();
  const std::vector<std::string> keys = overrides.keys();
  std::vector<std::string_view> known = names(model.factors);
  for (const std::string& key : keys) {
    if (!is_pattern(key)) continue;
    known.push_back(key);
    if (std::ranges::any_of(model.factors, [&](const Factor& factor) { return matches(key, factor.name); })) continue;
    overrides.require(key).fail("matches no error of the mechanism", listed_by_models(study));
  }
  overrides.allow(known, "factor");
}

/// Throws InputError for a key that has no effect, because later keys fit all errors that it fits. counting: the keys
/// that have an effect (override_key()).
void check_counting(const StudySection& overrides, const std::set<std::string>& counting,
                    const ModelDescription& model) {
  for (const std::string& key : overrides.keys()) {
    if (counting.contains(key)) continue;
    const auto first =
        std::ranges::find_if(model.factors, [&](const Factor& factor) { return is_key_of(key, factor.name); });
    overrides.require(key).fail(fmt::format("has no effect, because later keys, such as '{}', are for all its errors",
                                            *override_key(overrides, first->name)),
                                "write it after them, or remove it");
  }
}

/// Returns true if a value of [errors.override] has only the key `draws`, so that it does not state a size.
bool has_only_draws(const StudyValue& value) {
  return value.is_section() && value.section().keys() == std::vector<std::string>{"draws"};
}

/// Reads a value of [errors.override]. usual: the distribution and the draws of the error if [errors.override] does not
/// name it. If has_only_draws(), the error keeps the usual distribution.
StatedError read_own_error(const StudyValue& value, Dimension dimension, StudyUse use, const StatedError& usual,
                           std::vector<std::string>& doubts) {
  if (!has_only_draws(value)) return read_error(value, dimension, use, usual.distribution, doubts);
  Parameters parameters;
  read_key(row_of(distribution_keys(), "draws"), value.section().require("draws"), parameters, Nothing());
  return {usual.distribution, parameters.draws};
}

void read_override(const StudyValue& value, Study& study, const Reading& reading) {
  const StudySection overrides = value.section();
  check_override(overrides, study);
  std::set<std::string> counting;
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    const Factor& factor = study.model().factors[f];
    const auto key = override_key(overrides, factor.name);
    if (!key) continue;
    counting.insert(*key);
    set_error(read_own_error(overrides.require(*key), factor.dimension, reading.use, stated_error(study.errors, f),
                             study.doubts),
              f, study.errors);
  }
  if (reading.use == StudyUse::run) check_counting(overrides, counting, study.model());
}

/// The largest number of values (machines times errors) in a table of given machines. Every result stores these values,
/// so they must stay few.
constexpr std::size_t kMostGiven = 200'000;

/// The table [errors.machines]: the errors of given machines, which are not drawn.
struct GivenRows {
  std::vector<std::string> columns = {};
  std::vector<std::vector<double>> rows = {};  ///< [machines][columns] errors of each machine, SI
};

KeyValue<GivenRows> columns_value() {
  const auto read = [](const StudyValue& value, GivenRows& given) {
    for (const StudyValue& one : value.list()) given.columns.push_back(one.text());
  };
  return {.type = "list of texts", .read = read};
}

KeyValue<GivenRows> rows_value() {
  const auto read = [](const StudyValue& value, GivenRows& given) {
    for (const StudyValue& row : value.list()) {
      given.rows.emplace_back();
      for (const StudyValue& one : row.list()) given.rows.back().push_back(one.number());
      if (given.rows.back().size() == given.columns.size()) continue;
      row.fail(fmt::format("has {} numbers, but there are {} columns", given.rows.back().size(), given.columns.size()),
               "write one number for each column");
    }
  };
  return {.type = "list of lists of numbers", .read = read};
}

const InnerRows<GivenRows>& machines_keys() {
  static const InnerRows<GivenRows> keys{
      .paths = {"errors.machines"},
      .meaning = "The errors of given machines, instead of a file. A resolved study has them.",
      .rows = {InnerRow<GivenRows>{.name = "columns",
                                   .value = columns_value(),
                                   .missing = "write the names of errors, e.g. {}",
                                   .example = "[\"delta_1\"]",
                                   .meaning = "Names of errors."},
               InnerRow<GivenRows>{.name = "rows",
                                   .value = rows_value(),
                                   .missing = "write a list of numbers for each machine, e.g. {}",
                                   .example = "[[0.001], [-0.002]]",
                                   .meaning = "A list for each machine: its errors in the order of columns, SI."}}};
  return keys;
}

ErrorTable table_of(const StudyValue& value, const ModelDescription& model) {
  GivenRows given;
  const StudySection section = value.section();
  read_keys(machines_keys(), section, given, Nothing());
  ErrorTable table{.factors = {}, .values = {}, .rows = given.rows.size()};
  for (const StudyValue& column : section.require("columns").list()) {
    const auto factor = model.find_factor(column.text());
    if (!factor)
      column.fail("is '" + printable(column.text()) + "', which is not an error of the mechanism",
                  suggestion(column.text(), names(model.factors)));
    table.factors.push_back(*factor);
  }
  for (const std::vector<double>& row : given.rows) table.values.insert(table.values.end(), row.begin(), row.end());
  return table;
}

/// Stores a table of given machines, and gives each error of the table its column as the distribution.
void take_machines(const StudyValue& value, ErrorTable table, Study& study) {
  if (table.values.size() > kMostGiven) {
    value.fail(fmt::format("has {} numbers", table.values.size()),
               fmt::format("a study has at most {} numbers of given machines", kMostGiven));
  }
  for (const FactorIndex factor : table.factors) {
    const std::string column = "has the column '" + study.model().factors[factor.value].name + "', ";
    if (study.errors.is_per_pose(factor)) {
      value.fail(column + "which [errors] draws per pose", "remove the column, or its draws = \"per pose\"");
    }
    try {
      study.errors.by_factor[factor.value] = Distribution::given(table.column(factor));
    } catch (const std::invalid_argument& reason) {
      value.fail(column + "whose " + reason.what(),
                 "remove it; an error that is the same in all machines is held by analysis.background");
    }
  }
  study.analysis.samples = table.rows;
  study.errors.machines = std::move(table);
}

/// Reads given machines from a file, or from a table in the study. A file is opened only if the study is read for a
/// run.
void read_machines(const StudyValue& value, Study& study, const Reading& reading) {
  if (value.is_section()) return take_machines(value, table_of(value, study.model()), study);
  const std::string file = value.text();
  if (reading.use != StudyUse::run) return;
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  ErrorTable table = read_errors(named_file(value), *model);
  std::ranges::move(error_table_doubts(file, table, study), std::back_inserter(study.doubts));
  take_machines(value, std::move(table), study);
}

std::string machines_lines(const Study& study) {
  if (!study.errors.machines) return {};
  const ErrorTable& table = *study.errors.machines;
  std::string text = "machines.columns = " + factor_list_text(table.factors, study.model()) + "\nmachines.rows = [\n";
  for (std::size_t row = 0; row < table.rows; ++row) {
    std::vector<std::string> numbers;
    for (std::size_t v = 0; v < table.factors.size(); ++v) {
      numbers.push_back(shortest(table.values[row * table.factors.size() + v]));
    }
    text += "  " + list_text(numbers) + ",\n";
  }
  return text + "]\n";
}

/// Returns true if given machines state the error with index f, so that it is not drawn.
bool is_given(const Study& study, std::size_t f) {
  return study.errors.by_factor[f].shape() == Distribution::Shape::given;
}

/// The values as a TOML list over several lines, because a line of a study file may not be too long (parse_toml()).
std::string values_text(std::span<const double> values, Dimension dimension, ValueText value) {
  constexpr std::size_t kOfLine = 5;
  std::string text = "[";
  for (std::size_t k = 0; k < values.size(); ++k) {
    text += (k % kOfLine == 0 ? "\n  " : " ") + value(values[k], dimension) + ",";
  }
  return text + "\n]";
}

std::string error_text(const StatedError& error, Dimension dimension, ValueText value) {
  const Distribution& distribution = error.distribution;
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
    case Shape::given:
      break;  // the table of machines has the values
    case Shape::measured:
      text += ", values = " + values_text(distribution.parts()->values(), dimension, value);
      break;
  }
  if (distribution.shift() > 0.0) text += ", shift = " + value(distribution.shift(), dimension);
  if (distribution.centre() != 0.0) text += ", mean = " + value(distribution.centre(), dimension);
  if (error.draws == Draws::per_pose) text += ", draws = " + in_quotes(name(error.draws));
  return text + " }";
}

/// The distribution that most factors of this dimension have, and whether they are drawn at each pose or once for each
/// machine. Factors whose distribution follows from a tolerance zone, and factors that given machines state, do not
/// count. The study's resolved_text() states the result once, as `linear`, `angular` or `relative`.
StatedError commonest_error(const Study& study, Dimension dimension) {
  const std::vector<Factor>& factors = study.model().factors;
  const std::vector<std::optional<Distribution>> zones = distributions_by_zones(study);
  std::vector<StatedError> all;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].dimension != dimension || zones[f] || is_given(study, f)) continue;
    all.push_back(stated_error(study.errors, f));
  }
  const auto uses = [&](const StatedError& error) { return std::ranges::count(all, error); };
  const auto commonest = std::ranges::max_element(all, {}, uses);
  return commonest == all.end() ? StatedError{default_distribution(dimension)} : *commonest;
}

template <Dimension kDimension>
std::string usual_line(const Study& study) {
  if (kDimension == Dimension::number && !has_errors_of(kDimension, study.model())) return {};
  return fmt::format("{} = {}\n", error_kind(kDimension),
                     error_text(commonest_error(study, kDimension), kDimension, exact_value));
}

std::string override_lines(const Study& study) {
  const StatedError linear = commonest_error(study, Dimension::length);
  const StatedError angular = commonest_error(study, Dimension::angle);
  const StatedError relative = commonest_error(study, Dimension::number);
  const std::vector<std::optional<Distribution>> zones = distributions_by_zones(study);
  const std::vector<FactorIndex> loose = clearance_errors(study.model());
  std::string text;
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    const Factor& factor = study.model().factors[f];
    const StatedError own = stated_error(study.errors, f);
    const StatedError& usual = factor.dimension == Dimension::length  ? linear
                               : factor.dimension == Dimension::angle ? angular
                                                                      : relative;
    const Draws draws = std::ranges::binary_search(loose, FactorIndex(f)) ? Draws::per_pose : Draws::per_machine;
    if (is_given(study, f) || own == (zones[f] ? StatedError{*zones[f], draws} : usual)) continue;
    text += factor.name + " = " + error_text(own, factor.dimension, exact_value) + "\n";
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

std::string shown_machines(const TemplateLines& lines, const Study&) {
  return lines.explanation_lines("errors", "machines") + lines.keys_lines("errors.machines") +
         "# machines = \"parts.csv\"\n";
}

/// Returns true if a template needs the size of all errors of this dimension: some of them do not get their
/// distribution from errors.zones, which a template states.
bool uses_usual_size(Dimension dimension, Study shown) {
  shown.errors.zones.emplace();
  const std::vector<std::optional<Distribution>> zones = distributions_by_zones(shown);
  const std::vector<Factor>& factors = shown.model().factors;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    if (factors[f].dimension == dimension && !zones[f]) return true;
  }
  return false;
}

template <Dimension kDimension>
std::string shown_usual(const TemplateLines& lines, const Study& study) {
  return lines.usual("errors", error_kind(kDimension), uses_usual_size(kDimension, study) ? "" : "# ");
}

template <Dimension kDimension>
StudyRow usual_row(std::string_view meaning) {
  return {.name = error_kind(kDimension),
          .value = {.type = "table"},
          .usual = "`" + error_text({default_distribution(kDimension)}, kDimension, readable_value) + "`",
          .meaning = meaning,
          .reader = read_usual<kDimension>,
          .lines = usual_line<kDimension>,
          .shown = shown_usual<kDimension>};
}

std::string shown_relative(const TemplateLines& lines, const Study& study) {
  return has_errors_of(Dimension::number, study.model()) ? lines.usual("errors", "relative") : "";
}

StudyRow relative_row() {
  StudyRow row = usual_row<Dimension::number>(
      "Distribution of every number: of errors that grow with the displacement of a joint, \"0.1 %\" or \"50 um/m\".");
  row.shown = shown_relative;
  return row;
}

/// Throws InputError at the value that determines the factor's distribution: at errors.zones for an error in a
/// tolerance zone, otherwise at the first of `keys` that its distribution has, or at sigma if it has none of them.
[[noreturn]] void refuse_distribution(const StudySection& root, const Factor& factor, bool is_in_zone,
                                      const std::string& problem, std::span<const std::string_view> keys) {
  const StudySection errors = root.section("errors");
  const auto own = override_of(errors.section("override"), factor.name);
  if (!own && is_in_zone) refuse_error(errors, "zones", "makes " + factor.name + ", which " + problem);
  const auto value = own ? own : errors.find(error_kind(factor.dimension));
  if (!value) refuse_error(errors, error_kind(factor.dimension), problem);
  const StudySection distribution = value->section();
  for (const std::string_view key : keys) {
    if (distribution.find(key)) refuse_error(distribution, key, problem);
  }
  refuse_error(distribution, "sigma", problem);
}

/// Throws InputError if the mean or the size of a varied factor is too large for the model. The size is the largest
/// possible error, or the standard deviation if the distribution has no largest error.
void check_distributions(const StudySection& root, const Study& study, const Model& model) {
  constexpr std::array<std::string_view, 6> kKeys{"mean", "shift", "limits", "half_width", "values", "column"};
  const std::span keys(kKeys);
  const std::vector<std::optional<Distribution>> zones = distributions_by_zones(study);
  for (const FactorIndex factor : study.analysis.factors) {
    const Distribution& distribution = study.errors.by_factor[factor.value];
    if (distribution.shape() == Distribution::Shape::given) {
      if (const auto problem = beyond_bound(model, factor, distribution.largest(), "an error")) {
        refuse_error(root.section("errors"), "machines", *problem);
      }
      continue;
    }
    const auto refuse = [&](const std::optional<std::string>& problem, std::span<const std::string_view> at) {
      if (!problem) return;
      refuse_distribution(root, model.description().factors[factor.value], zones[factor.value].has_value(), *problem,
                          at);
    };
    const bool bounded = std::isfinite(distribution.half_width());
    const std::string_view what = bounded ? "a largest error" : "a standard deviation";
    const double size = bounded ? distribution.largest() : distribution.standard_deviation();
    const auto problem = beyond_bound(model, factor, size, what);
    refuse(beyond_bound(model, factor, std::abs(distribution.centre()), "a mean"), std::array{keys[0], keys[2]});
    const double without_shift = bounded ? distribution.half_width() : distribution.sigma();
    const bool too_large_without = beyond_bound(model, factor, without_shift, what).has_value();
    refuse(problem, keys.subspan(too_large_without ? 2 : 0));
  }
}

/// Throws InputError if errors of calibrated machines are drawn anew at each pose. The model's correction at each pose
/// would remove such errors, which no real calibration can do.
void check_calibrated(const StudySection& analysis, const Study& study) {
  if (!study.mechanism.calibrated || study.analysis.draws != Draws::per_machine) return;
  for (const FactorIndex factor : study.analysis.factors) {
    if (!study.errors.is_per_pose(factor)) continue;
    analysis.require("calibrated")
        .fail("is true, but the error '" + study.model().factors[factor.value].name +
                  "' is drawn per pose, which no calibration removes",
              "leave such errors out of analysis.factors here, and study them without calibrated");
  }
}

}  // namespace

const StudyRows& errors_keys() {
  static const StudyRows keys{
      .paths = {"errors"},
      .meaning = "How the errors that vary scatter, by their dimension.",
      .rows = {usual_row<Dimension::length>("Distribution of every length; the default is a unit, so state your own."),
               usual_row<Dimension::angle>("Distribution of every angle; the default is a unit, so state your own."),
               relative_row(), zones_row(),
               StudyRow{.name = "override",
                        .value = {.type = "table"},
                        .usual = "none",
                        .meaning = "Errors with a distribution of their own.",
                        .reader = read_override,
                        .lines = override_lines,
                        .late = 1,
                        .shown = shown_override},
               StudyRow{.name = "machines",
                        .value = {.type = "text or table"},
                        .usual = "drawn",
                        .example = "\"parts.csv\"",
                        .meaning = "Machines that are given, for a Monte Carlo study with draws = "
                                   "\"per machine\": a CSV file with a row for each machine and "
                                   "columns as `poesy evaluate --errors` reads them, relative to "
                                   "the study's folder. Errors without a column are drawn.",
                        .reader = read_machines,
                        .lines = machines_lines,
                        .shown = shown_machines},
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
          zones_table(),
          described(machines_keys()),
          correlated_table()};
}

Distribution usual_distribution(const Reading& reading, Dimension dimension) {
  const auto value = reading.root.section("errors").find(error_kind(dimension));
  std::vector<std::string> said_with_the_errors;
  return value ? read_error(*value, dimension, reading.use, default_distribution(dimension), said_with_the_errors)
                     .distribution
               : default_distribution(dimension);
}

void read_errors_section(Study& study, const Reading& reading) {
  for (const Factor& factor : study.model().factors) {
    study.errors.by_factor.push_back(default_distribution(factor.dimension));
  }
  set_by_zones(study);
  read_keys(errors_keys(), reading.root.section("errors"), study, reading);
}

void check_machines(const Study& study, const Reading& reading) {
  if (!study.errors.machines) return;
  const StudyValue machines = reading.root.section("errors").require("machines");
  const StudyKind& kind = *study.analysis.kind;
  if (kind.varies != Varies::together || study.analysis.draws != Draws::per_machine || kind.draws_machines_anew) {
    machines.fail("is set, but this study does not take machines as they are",
                  "take kind = \"monte-carlo\" with draws = \"per machine\", or remove it");
  }
  for (const FactorIndex factor : study.errors.machines->factors) {
    if (std::ranges::find(study.analysis.factors, factor) != study.analysis.factors.end()) continue;
    machines.fail("has the column '" + study.model().factors[factor.value].name + "', which the study does not vary",
                  "name it in analysis.factors, or remove the column");
  }
  const std::size_t rows = study.errors.machines->rows;
  if (study.analysis.samples <= rows) return;
  reading.root.section("analysis")
      .require("samples")
      .fail(fmt::format("asks for {} machines, but errors.machines has {}", study.analysis.samples, rows),
            "write no more, or leave it out to take all of them");
}

/// Returns true if [errors.override] states the size of the factor.
static bool overrides_size(const StudySection& errors, const Factor& factor) {
  const auto own = override_of(errors.section("override"), factor.name);
  return own && !has_only_draws(*own);
}

bool states_size(const StudySection& errors, const Factor& factor) {
  return errors.find(error_kind(factor.dimension)) || overrides_size(errors, factor);
}

/// Throws InputError, because an error of a feature varies although nothing states its size.
[[noreturn]] static void refuse_missing_size(const Place& place, const std::string& error, const std::string& feature,
                                             bool has_zones) {
  const std::string which = "'" + error + "' of the feature '" + feature + "' varies, ";
  if (has_zones) {
    throw InputError(
        place, which + "but no zone of the feature limits it, and the study does not say its size",
        "give the feature a zone in the mechanism's file, or write the size of all lengths as "
        "errors.linear, or leave the error out of analysis.factors (in an allocation: put it into a part)");
  }
  throw InputError(place,
                   "key 'errors.zones' is missing: " + which +
                       "and the study says neither how much of its zone is used nor another size",
                   "write errors.zones = { distribution = \"normal\", sigmas = 3 }, or the size of all lengths as "
                   "errors.linear");
}

/// A warning that the study does not state the sizes of these errors, so that they have the default. Precondition:
/// there is at least one error, and all have this dimension.
static std::string default_text(std::span<const FactorIndex> errors, Dimension dimension, const Study& study) {
  const std::string& first = study.model().factors[errors.front().value].name;
  const std::string which = errors.size() == 1   ? "of the error " + first
                            : errors.size() == 2 ? fmt::format("of {} and one more error", first)
                                                 : fmt::format("of {} and {} more errors", first, errors.size() - 1);
  return fmt::format("[errors] does not state the size {}, so it is the default, {}; write errors.{}", which,
                     error_text({default_distribution(dimension)}, dimension, readable_value), error_kind(dimension));
}

/// Name of the first feature that has a zone although one of its errors varies with the size of all lengths; empty if
/// there is none. of_parts: errors whose sizes an allocation finds.
static std::string feature_without_zone(const Study& study, const StudySection& errors,
                                        std::span<const FactorIndex> of_parts) {
  for (const Feature& feature : study.model().features) {
    if (study.errors.zones || (!feature.location && !feature.orientation)) continue;
    for (const FactorIndex error : feature.errors()) {
      const bool varies = std::ranges::find(study.analysis.factors, error) != study.analysis.factors.end();
      const bool is_of_part = std::ranges::find(of_parts, error) != of_parts.end();
      const bool has_own_size =
          is_given(study, error.value) || overrides_size(errors, study.model().factors[error.value]);
      if (varies && !is_of_part && !has_own_size) return feature.name;
    }
  }
  return {};
}

void check_error_sizes(Study& study, const Reading& reading, std::span<const FactorIndex> of_parts) {
  const StudySection errors = reading.root.section("errors");
  study.errors.unused_zone = feature_without_zone(study, errors, of_parts);
  if (reading.use != StudyUse::run) return;
  const std::vector<std::optional<Distribution>> by_zones = distributions_by_zones(study);
  std::vector<FactorIndex> without_size;
  std::ranges::copy_if(study.analysis.factors, std::back_inserter(without_size), [&](FactorIndex error) {
    return !by_zones[error.value] && std::ranges::find(of_parts, error) == of_parts.end() &&
           !is_given(study, error.value) && !states_size(errors, study.model().factors[error.value]);
  });
  for (const Feature& feature : study.model().features) {
    if (feature.clearance) continue;
    const std::vector<FactorIndex> list = feature.errors();
    const auto error = std::ranges::find_first_of(list, without_size);
    if (error == list.end()) continue;
    refuse_missing_size(errors.place(), study.model().factors[error->value].name, feature.name,
                        study.errors.zones.has_value());
  }
  if (!study.mechanism.file) return;  // the built-in mechanisms have the sizes of their paper
  for (const Dimension dimension : {Dimension::length, Dimension::angle, Dimension::number}) {
    std::vector<FactorIndex> alike;
    std::ranges::copy_if(without_size, std::back_inserter(alike),
                         [&](FactorIndex error) { return study.model().factors[error.value].dimension == dimension; });
    if (!alike.empty()) study.doubts.push_back(default_text(alike, dimension, study));
  }
}

/// The advice for an error that is too large: for measured values, to give deviations instead of sizes; for a quantity
/// in m or rad, to write another unit; otherwise, to write a smaller one.
static std::string smaller_remedy(const StudyValue& value, std::string_view key) {
  std::string remedy(kTooLargeRemedy);
  if (key == "column" || key == "values") return "give deviations from the nominal size, not sizes";
  if (!value.is_text()) return remedy;
  const std::string text = value.text();
  const std::size_t number = text.find_last_of("0123456789. ") + 1;
  const std::string unit = text.substr(std::min(number, text.size()));
  if (unit != "m" && unit != "rad") return remedy;
  return remedy + fmt::format(", such as \"{}m{}\"", printable(text.substr(0, number)), unit);
}

void refuse_error(const StudySection& section, std::string_view key, const std::string& problem) {
  if (const auto value = section.find(key)) value->fail(problem, smaller_remedy(*value, key));
  throw InputError(section.place(), "the default of " + std::string(key) + " " + problem, kTooLargeRemedy);
}

void check_error_size(const Model& model, FactorIndex factor, double size, const StudySection& section) {
  const Dimension dimension = model.description().factors[factor.value].dimension;
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
      const double size = held->of(model.description().factors[factor.value].dimension);
      check_error_size(model, factor, size, analysis.section("background"));
    }
  }
  check_calibrated(analysis, study);
  if (kind.check_errors != nullptr) kind.check_errors(analysis, study, model);
}

}  // namespace poesy
