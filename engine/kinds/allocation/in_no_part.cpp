#include "engine/kinds/allocation/in_no_part.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

#include "engine/base/units.h"
#include "engine/kinds/allocation/result.h"
#include "engine/report/display.h"
#include "engine/report/drawn_errors.h"

namespace poesy::allocation {
namespace {

/// The distribution and the standard deviation of an error: "normal, sigma 0.02 mm".
std::string size_text(const UnallocatedError& error) {
  return fmt::format("{}, sigma {}", error.distribution, response_text(error.named, error.sigma));
}

/// The names of the errors, grouped by size: "a, b (normal, sigma 0.02 mm); c (uniform, sigma 0.1 deg)". Only the first
/// three groups are named. The errors of all other groups are counted: "; and 4 more errors".
std::string names_and_sizes(const std::vector<UnallocatedError>& errors) {
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;
  for (const UnallocatedError& error : errors) {
    std::string size = size_text(error);
    auto at = std::ranges::find(groups, size, [](const auto& group) { return group.first; });
    if (at == groups.end()) at = groups.insert(groups.end(), {std::move(size), {}});
    at->second.push_back(error.named.name);
  }
  constexpr std::size_t kMostGroups = 3;
  std::vector<std::string> texts;
  std::size_t more = 0;
  for (const auto& [size, names] : groups) {
    if (texts.size() < kMostGroups) {
      texts.push_back(fmt::format("{} ({})", some_names(names), size));
    } else {
      more += names.size();
    }
  }
  if (more > 0) texts.push_back("and " + counted(more, "more error", "more errors"));
  return fmt::format("{}", fmt::join(texts, "; "));
}

/// A clause that tells the user how to get tolerances for these errors.
std::string_view remedy_text(const std::vector<UnallocatedError>& errors) {
  if (std::ranges::all_of(errors, &UnallocatedError::is_per_pose)) {
    return "no part can have them, because a machine draws them anew at each pose";
  }
  return std::ranges::any_of(errors, &UnallocatedError::is_per_pose)
             ? "a part of [[analysis.parts]] that names them finds the tolerances of those that a machine does not "
               "draw anew at each pose"
             : "a part of [[analysis.parts]] that names them finds their tolerances";
}

}  // namespace

std::vector<UnallocatedError> errors_in_no_part(const Study& study) {
  std::vector<UnallocatedError> errors;
  const std::vector<AllocatedPart>& parts = asked_of<Options>(study.analysis).parts;
  for (const FactorIndex factor : study.analysis.factors) {
    const auto has = [&](const AllocatedPart& part) {
      return std::ranges::find(part.factors, factor) != part.factors.end();
    };
    if (std::ranges::any_of(parts, has)) continue;
    const Factor& described = study.model().factors[factor.value];
    const Distribution& drawn = study.errors.by_factor[factor.value];
    errors.push_back({{described.name, std::string(si_unit(described.dimension))},
                      std::string(name(drawn.shape())),
                      drawn.standard_deviation(),
                      study.errors.is_per_pose(factor)});
  }
  return errors;
}

std::vector<UnallocatedError> errors_in_no_part(const StoredResult& result) {
  std::set<std::string> members;
  for (const std::string& names : allocation_of(result).part_members) {
    std::istringstream words(names);
    for (std::string word; words >> word;) members.insert(word);
  }
  std::vector<UnallocatedError> errors;
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    if (members.contains(result.factors[p].name)) continue;
    errors.push_back(
        {result.factors[p], result.factor_distribution[p], result.factor_sigma[p], is_drawn_per_pose(result, p)});
  }
  return errors;
}

std::string in_no_part_text(const std::vector<UnallocatedError>& errors, std::size_t all) {
  if (errors.empty()) return {};
  const bool one = errors.size() == 1;
  return fmt::format("{} of {} varied errors {} in no part; {} as [errors] states {}: {}", errors.size(), all,
                     one ? "is" : "are", one ? "its size stays" : "their sizes stay", one ? "it" : "them",
                     names_and_sizes(errors));
}

Table in_no_part_table(const std::vector<UnallocatedError>& errors) {
  Table table{.name = "in_no_part",
              .caption = fmt::format("In no part: {} taken as [errors] states {}",
                                     counted(errors.size(), "error,", "errors,"), errors.size() == 1 ? "it" : "them"),
              .columns = {},
              .notes = {"The tolerances were found and certified with these sizes, so the certificate holds only if "
                        "these errors keep them; " +
                        std::string(remedy_text(errors))}};
  fill(table, positions(errors.size()),
       {{text_column("error", "error"), [&](std::size_t e) { return text_cell(errors[e].named.name); }},
        {text_column("distribution", "distribution"), [&](std::size_t e) { return text_cell(errors[e].distribution); }},
        {number_column("sigma", "sigma"), [&](std::size_t e) { return value_cell(errors[e].sigma, errors[e].named); }},
        {text_column("unit", "unit"), [&](std::size_t e) { return text_cell(unit_text(errors[e].named)); }}});
  return table;
}

}  // namespace poesy::allocation
