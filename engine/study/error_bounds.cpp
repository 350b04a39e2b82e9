#include <cmath>

#include "engine/base/text.h"
#include "engine/study/error_words.h"
#include "engine/study/keys.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

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
