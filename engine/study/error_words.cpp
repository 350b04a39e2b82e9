#include "engine/study/error_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/study/study_kind.h"
#include "engine/study/study_text.h"

namespace poesy {
namespace {

constexpr std::size_t kMostNames = 3;

std::vector<FactorIndex> held_errors(const Study& study) {
  const std::vector<double> errors = background_errors(study.analysis.background, study.model());
  std::vector<FactorIndex> held;
  for (const FactorIndex factor : study.analysis.background->factors) {
    const bool varies = std::ranges::find(study.analysis.factors, factor) != study.analysis.factors.end();
    if (!varies && errors[factor.value] != 0.0) held.push_back(factor);
  }
  return held;
}

/// "30 errors of set 'benign'", "2 of the 30 errors of set 'benign'", "delta_1 and delta_2", "12 errors".
std::string owners_text(const std::vector<FactorIndex>& held, const Study& study) {
  const std::vector<FactorIndex>& named = study.analysis.background->factors;
  const std::string all = held.size() == named.size() ? "" : fmt::format("{} of the ", held.size());
  if (const std::string set = set_name(named, study.model()); !set.empty()) {
    return fmt::format("{}{} {} of set '{}'", all, named.size(), named.size() == 1 ? "error" : "errors", set);
  }
  if (held.size() > kMostNames) return fmt::format("{} errors", held.size());
  std::vector<std::string> names;
  for (const FactorIndex factor : held) names.push_back(study.model().factors[factor.value].name);
  return fmt::format("{}", fmt::join(names, " and "));
}

/// "1 mm and 1 deg", of the dimensions that the held errors have.
std::string sizes_text(const std::vector<FactorIndex>& held, const Study& study) {
  const Background& background = *study.analysis.background;
  std::vector<std::string> sizes;
  const auto add = [&](Dimension dimension, double size) {
    const auto has_it = [&](FactorIndex factor) { return study.model().factors[factor.value].dimension == dimension; };
    if (std::ranges::any_of(held, has_it)) sizes.push_back(readable_text({size, dimension}, 6));
  };
  add(Dimension::length, background.linear);
  add(Dimension::angle, background.angular);
  return fmt::format("{}", fmt::join(sizes, " and "));
}

}  // namespace

std::optional<std::string> beyond_bound(const Model& model, FactorIndex factor, double size, std::string_view what) {
  const ErrorBound bound = model.error_bound(factor);
  if (std::abs(size) < bound.size) return std::nullopt;
  const Factor& named = model.description().factors[factor.value];
  return "gives " + named.name + " " + std::string(what) + " of " + readable_text({size, named.dimension}) +
         ", no less than " + bound.part + " (" + readable_text({bound.size, named.dimension}) + ")";
}

std::string held_errors_text(const Study& study) {
  if (!study.analysis.background) return {};
  const std::vector<FactorIndex> held = held_errors(study);
  if (held.empty()) return {};
  const std::string_view overrides = study.analysis.kind->overrides;
  const std::string unless = overrides.empty() ? "" : fmt::format(", unless {} another value", overrides);
  return fmt::format("held constant{}: {} at {}", unless, owners_text(held, study), sizes_text(held, study));
}

}  // namespace poesy
