#include <cmath>

#include "engine/base/text.h"
#include "engine/study/error_words.h"
#include "engine/study/keys.h"

namespace poesy {
namespace {

constexpr std::string_view kRemedy = "write a smaller one";

/// Throws at the section's value of this key, or at the section where it has none.
[[noreturn]] void refuse(const StudySection& section, std::string_view key, const std::string& problem) {
  if (const auto value = section.find(key)) value->fail(problem, kRemedy);
  throw InputError(section.place(), "the default of " + std::string(key) + " " + problem, kRemedy);
}

class Bounds {
 public:
  Bounds(const StudySection& root, const Study& study, const Model& model)
      : root_(root), analysis_(root.section("analysis")), study_(study), model_(model) {}

  /// Of the distributions of what varies: the largest possible error, for a normal its standard deviation.
  void check_distributions() const {
    for (const FactorIndex factor : study_.analysis.factors) {
      const Distribution& distribution = study_.errors.by_factor[factor.value];
      const bool bounded = std::isfinite(distribution.half_width());
      const auto problem =
          beyond_bound(model_, factor, bounded ? distribution.half_width() : distribution.standard_deviation(),
                       bounded ? "a largest error" : "a standard deviation");
      if (problem) refuse_distribution(model_.description().factors[factor.value], *problem);
    }
  }

  void check_background() const {
    if (!study_.analysis.background) return;
    const Background& background = *study_.analysis.background;
    for (const FactorIndex factor : background.factors) {
      check(factor, background.linear, background.angular, analysis_.section("background"));
    }
  }

  void check_reference() const {
    if (!study_.analysis.reference) return;
    const ToleranceReference& reference = *study_.analysis.reference;
    const auto problem = beyond_bound(model_, reference.factor, reference.tolerance, "a tolerance");
    if (problem) refuse(analysis_.section("reference"), "tolerance", *problem);
  }

  void check_groups() const {
    const auto value = analysis_.find("groups");
    const std::vector<StudyValue> written = value ? value->list() : std::vector<StudyValue>{};
    for (std::size_t g = 0; g < study_.analysis.groups.size(); ++g) {
      const ErrorSize& group = study_.analysis.groups[g];
      const StudySection section = written.empty() ? analysis_ : written[g].section();
      for (const FactorIndex factor : study_.analysis.factors) check(factor, group.linear, group.angular, section);
    }
  }

  void check_cases() const {
    for (std::size_t c = 0; c < study_.analysis.cases.size(); ++c) {
      const ErrorCase& one = study_.analysis.cases[c];
      for (std::size_t f = 0; f < one.errors.size(); ++f) {
        const auto problem = beyond_bound(model_, FactorIndex(f), one.errors[f], "an error");
        if (problem) refuse_case(c, model_.description().factors[f], *problem);
      }
    }
  }

  void check_coupling() const {
    for (const FactorIndex factor : coupling_factors(study_.analysis.coupling, model_.description())) {
      const Dimension dimension = model_.description().factors[factor.value].dimension;
      const bool is_length = dimension == Dimension::length;
      const auto& sizes = is_length ? study_.analysis.coupling.linear : study_.analysis.coupling.angular;
      for (std::size_t z = 0; z < sizes.size(); ++z) {
        const auto problem = beyond_bound(model_, factor, sizes[z], "an error");
        if (problem) analysis_.require(error_kind(dimension)).list()[z].fail(*problem, kRemedy);
      }
    }
  }

 private:
  void check(FactorIndex factor, double linear, double angular, const StudySection& section) const {
    const Dimension dimension = model_.description().factors[factor.value].dimension;
    const double size = dimension == Dimension::length ? linear : angular;
    if (const auto problem = beyond_bound(model_, factor, size, "an error")) {
      refuse(section, error_kind(dimension), *problem);
    }
  }

  [[noreturn]] void refuse_distribution(const Factor& factor, const std::string& problem) const {
    const StudySection errors = root_.section("errors");
    const auto own = errors.section("override").find(factor.name);
    const auto value = own ? own : errors.find(error_kind(factor.dimension));
    if (!value) refuse(errors, error_kind(factor.dimension), problem);
    const StudySection distribution = value->section();
    refuse(distribution, distribution.find("half_width") ? "half_width" : "sigma", problem);
  }

  /// At the error itself, at what sets all of its dimension, or at the case, where a factor set does.
  [[noreturn]] void refuse_case(std::size_t c, const Factor& factor, const std::string& problem) const {
    const StudySection errors = analysis_.require("cases").list()[c].section().section("errors");
    for (const std::string_view key : {std::string_view(factor.name), error_kind(factor.dimension)}) {
      if (const auto value = errors.find(key)) value->fail(problem, kRemedy);
    }
    throw InputError(errors.place(), "case '" + printable(study_.analysis.cases[c].name) + "' " + problem, kRemedy);
  }

  const StudySection& root_;
  StudySection analysis_;
  const Study& study_;
  const Model& model_;
};

}  // namespace

void check_error_bounds(const StudySection& root, const Study& study, const Model& model) {
  using Kind = Analysis::Kind;
  const Kind kind = study.analysis.kind;
  const Bounds bounds(root, study, model);
  if (kind == Kind::sensitivity || kind == Kind::monte_carlo) bounds.check_distributions();
  bounds.check_background();
  bounds.check_reference();
  bounds.check_groups();
  bounds.check_cases();
  if (kind == Kind::coupling) bounds.check_coupling();
}

}  // namespace poesy
