#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "engine/report/display.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

constexpr std::size_t kFactorWidth = 16;

std::string verdict(const IdentificationResult& found, std::size_t p) {
  if (found.single[p] != 0) return "deforms alone";
  return found.coupled[p] != 0 ? "deforms in a coupling" : "absorbed";
}

/// Counts of poses above rounding, group by group: "692 692 692".
std::string deforming_poses(const IdentificationResult& found, std::size_t p) {
  std::string text;
  for (std::size_t g = 0; g < found.groups; ++g) {
    text += fmt::format("{:>9}", found.poses - found.single_below[g * found.factors + p]);
  }
  return text;
}

bool groups_agree(const IdentificationResult& found) {
  for (std::size_t cell = 0; cell < found.coupled_by_group.size(); ++cell) {
    if (found.coupled_by_group[cell] != found.coupled[cell % found.factors]) return false;
    if (found.single_by_group[cell] != found.single[cell % found.factors]) return false;
  }
  return true;
}

std::string couplings_text(const StoredResult& result) {
  std::string text;
  for (const Coupling& coupling : result.identification.couplings) {
    text += fmt::format("coupling: {} with {} ({}, {} of {} poses)\n", result.factors[coupling.first].name,
                        result.factors[coupling.second].name, result.groups[coupling.group].name,
                        coupling.deforming_poses, result.identification.poses);
  }
  return text;
}

}  // namespace

std::string cases_table(const StoredResult& result) {
  const CaseResult& found = result.case_result;
  std::size_t width = 4;
  for (const std::string& name : result.cases) width = std::max(width, name.size());
  std::string text = fmt::format("{:<{}}  {:>6}", "case", width, "poses");
  for (const std::size_t r : result.headline) {
    const NamedUnit& response = result.responses[r];
    const std::string unit = fmt::format("[{}]", display(response).name);
    text += fmt::format("  {:>27}", fmt::format("{} {}", response.name, unit));
  }
  text += fmt::format("\n{:<{}}  {:>6}", "", width, "");
  for (std::size_t column = 0; column < result.headline.size(); ++column) {
    text += fmt::format("  {:>13} {:>13}", "mean", "max");
  }
  text += '\n';
  for (std::size_t c = 0; c < result.cases.size(); ++c) {
    text += fmt::format("{:<{}}  {:>6}", result.cases[c], width, found.count[c]);
    for (const std::size_t r : result.headline) {
      const double scale = 1.0 / display(result.responses[r]).si;
      const std::size_t at = r * result.cases.size() + c;
      text += fmt::format("  {:>13.6g} {:>13.6g}", found.mean[at] * scale, found.max[at] * scale);
    }
    text += '\n';
  }
  return text;
}

std::string identification_table(const StoredResult& result) {
  const IdentificationResult& found = result.identification;
  const auto alone = std::ranges::count(found.single, 1);
  const auto all = std::ranges::count(found.coupled, 1);
  std::string text =
      fmt::format("{} of {} errors deform alone, {} with couplings; {} of {} poses decide, rounding ends at {:.3g}\n",
                  alone, found.factors, all, found.required_poses, found.poses, found.rounding);
  if (!groups_agree(found)) text += "the groups do not agree: see the export's identification.csv\n";
  text += fmt::format("\n{:<{}}  {:<22} poses where it deforms alone:", "error", kFactorWidth, "verdict");
  for (const ErrorSize& group : result.groups) text += " " + group.name;
  text += '\n';
  for (std::size_t p = 0; p < found.factors; ++p) {
    text += fmt::format("{:<{}}  {:<22}{}\n", result.factors[p].name, kFactorWidth, verdict(found, p),
                        deforming_poses(found, p));
  }
  return text + couplings_text(result);
}

}  // namespace poesy
