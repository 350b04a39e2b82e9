#include "engine/study/fitted_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/base/name_pattern.h"
#include "engine/base/text.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

/// Throws InputError if a name that the user chose cannot be used in expressions, or is the name of an error. what:
/// noun for the named thing in messages.
void check_own_name(const StudyValue& value, const std::string& own, std::string_view what,
                    const ModelDescription& model) {
  const bool is_plain = std::ranges::all_of(own, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
  if (own.empty() || !is_plain || (own.front() >= '0' && own.front() <= '9')) {
    value.fail(fmt::format("is the {} '{}', whose name cannot be used in expressions", what, printable(own)),
               "take letters, digits and _, and begin with a letter");
  }
  if (model.find_factor(own)) {
    value.fail(fmt::format("gives a {} the name of the error '{}'", what, own), "give it another name");
  }
}

/// Reads the weight of an error in a combination: a number, or a quantity in the unit of the error over the unit of the
/// combination, "125 mm/rad".
double read_weight(const StudyValue& value, const Factor& factor, const FittedErrors& combination,
                   const ModelDescription& model) {
  const std::string remedy = "write a number, e.g. 1; where units differ with a unit, \"125 mm/rad\"";
  if (!value.is_text()) {
    const double weight = value.number();
    if (weight == 0.0) value.fail("is 0", "leave this error out");
    if (factor.dimension == combination.dimension) return weight;
    const Factor& first = model.factors[combination.factors.front().value];
    value.fail(fmt::format("is a number, but {} is {} and {} {}", first.name, with_article(first.dimension),
                           factor.name, with_article(factor.dimension)),
               fmt::format("give the factor a unit: \"... {}/{}\"", display_unit(factor.dimension).name,
                           display_unit(first.dimension).name));
  }
  const std::string text(trimmed(value.text()));
  const std::size_t slash = text.rfind('/');
  if (slash == std::string::npos) value.fail("is '" + printable(text) + "', which has no unit over a unit", remedy);
  const Unit* const under = find_unit(trimmed(std::string_view(text).substr(slash + 1)));
  try {
    const Quantity over = parse_quantity(trimmed(std::string_view(text).substr(0, slash)), factor.dimension);
    if (over.dimension != factor.dimension || under == nullptr || under->dimension != combination.dimension) {
      value.fail(fmt::format("is '{}', but must be {} over {}", printable(text), with_article(factor.dimension),
                             with_article(combination.dimension)),
                 remedy);
    }
    if (over.si == 0.0) value.fail("is 0", "leave this error out");
    return over.si / under->si;
  } catch (const QuantityError& reason) {
    value.fail(std::string("cannot be read: ") + reason.what(), remedy);
  }
}

/// Throws InputError for a key of a combination that names no error, and for a pattern that matches none.
void check_error_names(const StudySection& section, const Study& study) {
  const ModelDescription& model = study.model();
  std::vector<std::string_view> known = names(model.factors);
  const std::vector<std::string> keys = section.keys();
  for (const std::string& key : keys) {
    if (!is_pattern(key)) continue;
    known.push_back(key);
    if (std::ranges::any_of(model.factors, [&](const Factor& factor) { return matches(key, factor.name); })) continue;
    section.require(key).fail("matches no error of the mechanism", listed_by_models(study));
  }
  section.allow(known, "error");
}

/// Reads the weight of an error and adds both to the combination, or replaces the weight that an earlier key gave to
/// the error.
void set_weight(const StudyValue& value, FactorIndex factor, FittedErrors& combination, const ModelDescription& model) {
  const Factor& error = model.factors[factor.value];
  if (combination.factors.empty()) combination.dimension = error.dimension;
  auto known = std::ranges::find(combination.factors, factor);
  if (known == combination.factors.end()) {
    combination.factors.push_back(factor);
    combination.weights.push_back(0.0);
    known = combination.factors.end() - 1;
  }
  combination.weights[static_cast<std::size_t>(known - combination.factors.begin())] =
      read_weight(value, error, combination, model);
}

FittedErrors read_combination(const StudyValue& value, const std::string& own, const Study& study) {
  const ModelDescription& model = study.model();
  check_own_name(value, own, "combination", model);
  const StudySection section = value.section();
  check_error_names(section, study);
  FittedErrors combination{.name = own, .dimension = Dimension::number, .place = value.place()};
  for (const auto& [key, weight] : in_order(section)) {
    for (std::size_t f = 0; f < model.factors.size(); ++f) {
      if (key == model.factors[f].name || (is_pattern(key) && matches(key, model.factors[f].name))) {
        set_weight(weight, FactorIndex(f), combination, model);
      }
    }
  }
  if (combination.factors.empty()) value.fail("names no error", "write { ERROR = 1, ... }");
  return combination;
}

std::vector<FittedErrors> read_combinations(const StudySection& section, const Study& study) {
  std::vector<FittedErrors> list;
  for (const auto& [key, value] : in_order(section.section("combinations"))) {
    list.push_back(read_combination(value, key, study));
  }
  return list;
}

/// Adds a single error to `fit`. Throws InputError if a machine draws this error anew at each pose.
void add_error(const StudyValue& value, FactorIndex factor, const Study& study, std::vector<FittedErrors>& fit) {
  const Factor& error = study.model().factors[factor.value];
  if (std::ranges::find(fit, error.name, &FittedErrors::name) != fit.end()) return;
  if (study.errors.is_per_pose(factor)) {
    value.fail("fits the error '" + error.name + "', which changes from move to move", "leave it out");
  }
  fit.push_back({error.name, {factor}, {1.0}, error.dimension, value.place()});
}

/// Adds to `fit` the errors that one element of the key `fit` names: a combination, an error, a set, or a pattern of
/// names.
void add_named(const StudyValue& value, const std::vector<FittedErrors>& combinations, const Study& study,
               std::vector<FittedErrors>& fit) {
  const ModelDescription& model = study.model();
  const std::string written = value.text();
  const auto combination = std::ranges::find(combinations, written, &FittedErrors::name);
  if (combination != combinations.end()) {
    if (std::ranges::find(fit, written, &FittedErrors::name) != fit.end()) {
      value.fail("names '" + printable(written) + "' a second time", "remove one of them");
    }
    fit.push_back(*combination);
    fit.back().place = value.place();
    for (const FactorIndex factor : combination->factors) {
      if (!study.errors.is_per_pose(factor)) continue;
      value.fail("fits the error '" + model.factors[factor.value].name + "', which changes from move to move",
                 "leave it out of the combination");
    }
    return;
  }
  if (const FactorSet* const set = model.find_set(written)) {
    for (const FactorIndex factor : set->factors) add_error(value, factor, study, fit);
    return;
  }
  bool any = false;
  for (std::size_t f = 0; f < model.factors.size(); ++f) {
    if (written != "all" && !matches(written, model.factors[f].name)) continue;
    any = true;
    add_error(value, FactorIndex(f), study, fit);
  }
  if (any) return;
  std::vector<std::string_view> known = names(model.factors);
  for (const FittedErrors& one : combinations) known.push_back(one.name);
  for (const FactorSet& set : model.factor_sets) known.push_back(set.name);
  value.fail("is '" + printable(written) + "', which is not an error, set or combination",
             suggestion(written, known.size() > 40 ? std::span(known).first(40) : std::span(known)));
}

/// The weights of fitted errors as a vector with an entry for each factor of the model.
std::vector<double> column_of(const FittedErrors& errors, std::size_t factors) {
  std::vector<double> column(factors, 0.0);
  for (std::size_t n = 0; n < errors.factors.size(); ++n) column[errors.factors[n].value] = errors.weights[n];
  return column;
}

/// Tells by the Gram-Schmidt process how far a column is linearly independent of earlier columns. left() scales the
/// column to length 1, removes its part along `orthonormal`, returns the length that is left (0 to 1), and scales the
/// column to length 1 again.
struct DirectionTest {
  std::vector<std::vector<double>> orthonormal;

  double left(std::vector<double>& column) const {
    const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
      double sum = 0.0;
      for (std::size_t f = 0; f < a.size(); ++f) sum += a[f] * b[f];
      return sum;
    };
    const auto scale = [](std::vector<double>& a, double by) {
      for (double& entry : a) entry *= by;
    };
    scale(column, 1.0 / std::sqrt(dot(column, column)));
    for (int twice = 0; twice < 2; ++twice) {
      for (const std::vector<double>& other : orthonormal) {
        const double along = dot(column, other);
        for (std::size_t f = 0; f < column.size(); ++f) column[f] -= along * other[f];
      }
    }
    const double norm = std::sqrt(dot(column, column));
    if (norm > 0.0) scale(column, 1.0 / norm);
    return norm;
  }
};

/// Throws InputError if the fitted numbers are linearly dependent, because no measurement can separate them.
void check_directions(const std::vector<FittedErrors>& fit, const Study& study) {
  constexpr double kDependent = 1e-9;
  const std::size_t factors = study.model().factors.size();
  DirectionTest test;
  for (std::size_t n = 0; n < fit.size(); ++n) {
    std::vector<double> column = column_of(fit[n], factors);
    if (test.left(column) > kDependent) {
      test.orthonormal.push_back(std::move(column));
      continue;
    }
    for (std::size_t other = 0; other < n; ++other) {
      DirectionTest one;
      std::vector<double> first = column_of(fit[other], factors);
      static_cast<void>(one.left(first));
      one.orthonormal.push_back(first);
      std::vector<double> second = column_of(fit[n], factors);
      if (one.left(second) > kDependent) continue;
      throw InputError(fit[n].place,
                       fmt::format("combinations '{}' and '{}' are the same direction", fit[other].name, fit[n].name),
                       "fit one of them");
    }
    throw InputError(
        fit[n].place,
        "combination '" + fit[n].name + "' is a sum of multiples of those before it in analysis.calibration.fit",
        "leave one of them out");
  }
}

}  // namespace

std::vector<std::pair<std::string, StudyValue>> in_order(const StudySection& section) {
  std::vector<std::pair<std::string, StudyValue>> list;
  for (const std::string& key : section.keys()) list.emplace_back(key, *section.find(key));
  std::ranges::stable_sort(
      list, {}, [](const auto& entry) { return std::pair(entry.second.place().line, entry.second.place().column); });
  return list;
}

std::vector<FittedErrors> read_fitted(const StudyValue& value, const StudySection& section, const Study& study) {
  const std::vector<FittedErrors> combinations = read_combinations(section, study);
  std::vector<FittedErrors> fit;
  if (value.is_text()) {
    add_named(value, combinations, study, fit);
  } else {
    for (const StudyValue& element : value.list()) add_named(element, combinations, study, fit);
  }
  if (fit.empty()) value.fail("is empty", "name at least one error, set or combination");
  check_directions(fit, study);
  return fit;
}

}  // namespace poesy
