#include "engine/report/drawn_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "engine/base/units.h"
#include "engine/report/display.h"
#include "engine/report/tables.h"
#include "engine/schema/settings.h"
#include "engine/study/limit_keys.h"
#include "engine/study/study.h"

namespace poesy {
namespace {

/// The keys of [errors] that set the distribution of all lengths, all angles, or all numbers without unit.
constexpr std::array<std::string_view, 3> kOfDimensions{"linear", "angular", "relative"};

/// Returns true if the study sets errors by their dimension alone: no zones, overrides, parts, machines or
/// correlations.
bool sizes_by_dimension(const StoredResult& result) {
  return std::ranges::all_of(study_settings(result.study_text), [](const StudySetting& one) {
    const bool of_dimension =
        one.section == "errors" && std::ranges::find(kOfDimensions, one.key) != kOfDimensions.end();
    return of_dimension || !(one.section.starts_with("errors") || one.section.starts_with("analysis.parts"));
  });
}

/// The size of errors for each dimension that an error has: "linear: distribution = normal, sigma = 0.02 mm".
std::vector<std::string> sizes_of_dimensions(const StoredResult& result) {
  std::vector<std::string> sizes;
  for (const std::string_view key : kOfDimensions) {
    const bool has = std::ranges::any_of(
        result.factors, [&](const NamedUnit& factor) { return error_kind(dimension_of(factor.unit)) == key; });
    const std::string size = has ? readable_setting(result.study_text, "errors", key) : std::string();
    if (!size.empty()) sizes.push_back(fmt::format("{}: {}", key, size));
  }
  return sizes;
}

/// The sizes of errors for each distribution and unit: "24 normal with standard deviations of 0.002 to 0.02 mm". In a
/// study with errors.zones that are not normal the distributions are not named, because errors of features are drawn
/// together.
std::vector<std::string> sizes_of_distributions(const StoredResult& result) {
  const std::string zones = readable_setting(result.study_text, "errors", "zones");
  const bool are_together = !zones.empty() && zones.find("distribution = normal") == std::string::npos;
  std::map<std::pair<std::string, std::string>, std::vector<double>> groups;
  for (std::size_t p = 0; p < result.factor_sigma.size(); ++p) {
    const Unit& unit = display(result.factors[p]);
    const std::string distribution = are_together ? "" : result.factor_distribution[p] + " ";
    groups[{std::string(unit.name), distribution}].push_back(result.factor_sigma[p] / unit.si);
  }
  std::vector<std::string> sizes;
  for (const auto& [key, sigmas] : groups) {
    const auto [least, most] = std::ranges::minmax(sigmas);
    const std::string range = least == most ? fmt::format("a standard deviation of {:.4g}", most)
                                            : fmt::format("standard deviations of {:.4g} to {:.4g}", least, most);
    const std::string unit = key.first == "1" ? "" : " " + key.first;
    sizes.push_back(fmt::format("{} {}with {}{}", sigmas.size(), key.second, range, unit));
  }
  return sizes;
}

}  // namespace

std::vector<std::string> drawn_sizes(const StoredResult& result, const StudyWords& words) {
  if (!words.drawn.empty()) return words.drawn;
  return sizes_by_dimension(result) ? sizes_of_dimensions(result) : sizes_of_distributions(result);
}

std::string given_errors_text(const StoredResult& result) {
  const std::size_t all = result.factor_distribution.size();
  const auto given =
      static_cast<std::size_t>(std::ranges::count(result.factor_distribution, name(Distribution::Shape::given)));
  if (given == 0) return {};
  return fmt::format(
      "{} of {} given by errors.machines, {} drawn; poesy evaluate STUDY.toml --errors FILE.csv judges "
      "each given machine",
      given, counted(all, "error", "errors"), all - given);
}

bool is_drawn_per_pose(const StoredResult& result, std::size_t error) {
  return !result.factor_draws.empty() && result.factor_draws[error] == name(Draws::per_pose);
}

std::string seed_text(const StoredResult& result, const StudyWords& words) {
  if (!words.draws) return {};
  return words.seed ? std::to_string(*words.seed) : readable_setting(result.study_text, "run", "seed");
}

}  // namespace poesy
