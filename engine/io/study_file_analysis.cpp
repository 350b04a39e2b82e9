#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <vector>

#include "engine/base/text.h"
#include "engine/io/study_file_parts.h"
#include "engine/run/coupling_rows.h"

namespace poesy {
namespace {

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

/// The size at which errors of a dimension are held: as large as errors of the study are, unless it says otherwise.
double read_held_size(const StudySection& background, const StudySection& root, Dimension dimension) {
  if (const auto value = background.find(error_kind(dimension))) return value->quantity(dimension);
  return read_usual_distribution(root, dimension).standard_deviation();
}

std::optional<Background> read_background(const StudySection& root, const StudySection& analysis,
                                          const ModelDescription& model) {
  if (!analysis.find("background")) return std::nullopt;
  const StudySection section = analysis.section("background");
  section.allow();
  Background background;
  background.factors = read_factors(section.require("factors", "write a factor set or a list of factors"), model);
  background.linear = read_held_size(section, root, Dimension::length);
  background.angular = read_held_size(section, root, Dimension::angle);
  return background;
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
  section.allow();
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

Analysis::Kind read_kind(const StudySection& section, const ModelDescription& model, StudyUse use) {
  std::vector<std::string_view> words;
  for (const Analysis::Kind kind : kKinds) words.push_back(name(kind));
  const auto value = section.find("kind");
  const Analysis::Kind kind = value ? kKinds[value->word(words)] : Analysis::Kind::sensitivity;
  if (use == StudyUse::run && kind == Analysis::Kind::identification && !model.deformation) {
    value->fail("is \"identification\", but nothing deforms in model \"" + model.name + "\"",
                "identification needs limbs that hold one platform against each other; choose another kind");
  }
  return kind;
}

/// The factor set that a study of this kind takes when it names none.
std::vector<FactorIndex> usual_factors(Analysis::Kind kind, const ModelDescription& model) {
  const FactorSet* set = model.find_set("deforming");
  return kind == Analysis::Kind::sensitivity && set != nullptr ? set->factors : all_factors(model);
}

}  // namespace

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

Analysis read_analysis(const StudySection& root, const ModelDescription& model, StudyUse use) {
  using Kind = Analysis::Kind;
  const StudySection section = root.section("analysis");
  section.allow();
  Analysis analysis;
  analysis.kind = read_kind(section, model, use);
  if (use == StudyUse::run) section.refuse_all_but_those_for(name(analysis.kind));
  const auto factors = section.find("factors");
  analysis.factors = factors ? read_factors(*factors, model) : usual_factors(analysis.kind, model);
  if (analysis.kind == Kind::evaluate) analysis.factors.clear();
  read_samples(section, analysis);
  analysis.background = read_background(root, section, model);
  if (const auto value = section.find("reference")) analysis.reference = read_reference(*value, analysis, model);
  if (const auto value = section.find("linearity")) analysis.linearity = read_share(*value, "0.01");
  if (const auto value = section.find("quantiles")) analysis.quantiles = read_quantiles(*value);
  if (const auto value = section.find("pose_share")) analysis.pose_share = read_share(*value, "0.95");
  read_limits(section, model, analysis);
  if (analysis.kind == Kind::identification) analysis.groups = read_groups(section);
  if (analysis.kind == Kind::evaluate) {
    analysis.cases = read_cases(section, model, background_errors(analysis.background, model), use);
  }
  if (analysis.kind == Kind::coupling) {
    analysis.coupling = read_coupling(section, model, use);
    analysis.factors = coupling_factors(analysis.coupling, model);
  }
  return analysis;
}

}  // namespace poesy
