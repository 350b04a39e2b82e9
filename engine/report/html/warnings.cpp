#include "engine/report/html/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/report/display.h"
#include "engine/report/html/outcomes.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/study_facts.h"
#include "engine/report/index_change.h"
#include "engine/report/not_converged.h"
#include "engine/report/ranking.h"
#include "engine/report/tables.h"
#include "engine/stats/rounding.h"

namespace poesy {
namespace {

using Warnings = std::vector<std::string>;

void warn_of_changes(const ReportedResult& result, Warnings& list) {
  if (result.stored.changed) {
    list.push_back(fmt::format(
        "{} was changed since it was written: its content no longer has its hash, so these numbers may not be what was "
        "computed. 'poesy verify' says which hash it has now.",
        result.path));
  }
  if (result.stored.git_commit.ends_with("-dirty")) {
    list.push_back(fmt::format(
        "The program that computed this result was built from a source tree with changes of its own ({}), so its "
        "commit alone does not give the program again.",
        result.stored.git_commit));
  }
}

void warn_of_unsolved(const StoredResult& result, Warnings& list) {
  const SolveTally outcomes = tally_of(result);
  const SolveCounts total = sum_of(outcomes.cells);
  if (!many_not_converged(result, total.not_converged(), total.total())) return;
  const double share = share_not_converged(total);
  list.push_back(fmt::format("{} of {} solves{} ({}) did not converge.{}{}", count_text(total.not_converged()),
                             count_text(total.total()), at_first_fidelity(result), percent_text(share),
                             doubt_text(share), worst_text(result, outcomes)));
}

void warn_of_unsolved_at_second_fidelity(const StoredResult& result, Warnings& list) {
  const std::optional<SecondFidelity> second = second_fidelity(result);
  if (!second || !many_not_converged(result, second->not_converged, second->total)) return;
  const double share = static_cast<double>(second->not_converged) / static_cast<double>(second->total);
  list.push_back(fmt::format("{} of {} solves at fidelity \"{}\" ({}) did not converge.",
                             count_text(second->not_converged), count_text(second->total), result.fidelities[1],
                             percent_text(share)));
}

void warn_of_unknown_indices(const StoredResult& result, Warnings& list) {
  const SensitivityResult& found = result.sensitivity;
  std::vector<std::string> unknown;
  for (std::size_t p = 0; p < found.factors; ++p) {
    bool known = true;
    for (std::size_t r = 0; r < found.responses; ++r) known = known && !std::isnan(found.global[r * found.factors + p]);
    if (!known) unknown.push_back(result.factors[p].name);
  }
  const auto cells = std::ranges::count_if(std::span(found.count).first(found.factors * found.poses),
                                           [](double count) { return count < 2.0; });
  if (cells == 0 && unknown.empty()) return;
  std::string text =
      fmt::format("{} (an error at a pose) fewer than two samples that count, so no index is known there.",
                  cells == 1 ? "1 cell has" : fmt::format("{} cells have", cells));
  if (!unknown.empty()) text += " Without a global index therefore: " + some_names(unknown) + ".";
  list.push_back(text);
}

void warn_of_unsolved_poses(const StoredResult& result, Warnings& list) {
  const SolveTally outcomes = tally_of(result);
  std::vector<std::string> poses;
  const std::vector<double> shares = outcomes.shares_by_pose();
  for (std::size_t m = 0; m < shares.size(); ++m) {
    if (shares[m] == 1.0) poses.push_back(std::to_string(m));
  }
  if (poses.empty()) return;
  list.push_back(fmt::format("Nothing was solved at {}: {}.", counted(poses.size(), "pose", "poses"),
                             "number " + some_names(poses)));
}

void warn_of_small_errors(const StoredResult& result, Warnings& list) {
  std::vector<std::string> small;
  const GlobalIndices shown = shown_indices(result);
  for (std::size_t p = 0; p < result.factors.size(); ++p) {
    const auto is_small = [&](std::size_t r) {
      return is_too_small_to_tell(shown.value[r * result.factors.size() + p], index_rounding(result, r, p));
    };
    if (std::ranges::any_of(result.headline, is_small)) small.push_back(result.factors[p].name);
  }
  if (small.empty()) return;
  list.push_back(
      fmt::format("{} so small in this study that an effect cannot be told from the rounding of the solves: "
                  "{}. Study larger errors.",
                  counted(small.size(), "error is", "errors are"), some_names(small)));
}

void warn_of_sizes(const StoredResult& result, Warnings& list) {
  if (!has_index_changes(result)) return;
  const std::size_t response = response_named(result, default_ranking(result));
  if (changing_errors(result, response).empty()) return;
  list.push_back(fmt::format("Some indices say something about the size of the errors in this study and no other: {}.",
                             index_change_text(result, response)));
}

void warn_of_wide_intervals(const StoredResult& result, Warnings& list) {
  const SensitivityResult& found = result.sensitivity;
  const GlobalIndices shown = shown_indices(result);
  std::size_t wide = 0;
  std::size_t all = 0;
  std::optional<std::pair<double, std::size_t>> widest;
  for (const std::size_t r : result.headline) {
    for (std::size_t at = r * found.factors; at < (r + 1) * found.factors; ++at) {
      if (!has_effect(result, r, at % found.factors)) continue;
      ++all;
      const double reach = std::max(shown.high[at] - shown.value[at], shown.value[at] - shown.low[at]);
      const double relative = reach / shown.value[at];
      if (!(relative > kWideInterval)) continue;
      ++wide;
      if (!widest || relative > widest->first) widest = {relative, at};
    }
  }
  if (!widest) return;
  list.push_back(
      fmt::format("{} of {} indices have a {:.3g} % interval that reaches more than 10 % away from the index; the "
                  "widest is that of {} on {}, {}. More samples make them narrower.",
                  wide, all, 100.0 * found.conf_level, result.factors[widest->second % found.factors].name,
                  result.responses[widest->second / found.factors].name, percent_text(widest->first)));
}

void warn_of_convergence(const ConvergenceResult& found, std::span<const std::size_t> responses, std::string_view what,
                         Warnings& list) {
  const std::size_t slots = found.samples.size();
  std::size_t missing = 0;
  for (const std::size_t r : responses) {
    missing += static_cast<std::size_t>(
        std::ranges::count(std::span(found.reached).subspan(r * slots, slots), std::uint8_t{0}));
  }
  if (missing == 0) return;
  list.push_back(fmt::format(
      "{} of {} {} did not reach the interval of +-{} that the study asks for, with at most {} samples at each pose.",
      missing, responses.size() * slots, what, percent_text(found.relative_error), count_text(found.max)));
}

void warn_of_poses(const StoredResult& result, Warnings& list) {
  const auto ill = std::ranges::count_if(result.condition, [](double value) { return value > kIllConditioned; });
  if (ill == 0) return;
  const auto worst = std::ranges::max_element(result.condition);
  list.push_back(fmt::format(
      "{} close to singular: {} a condition number above {:.0e}, the largest is {:.3g} at {}. There small errors do "
      "much, and linear estimates say little.",
      ill == 1 ? "1 pose is" : fmt::format("{} poses are", ill), ill == 1 ? "it has" : "they have", kIllConditioned,
      *worst, place_text(result, static_cast<std::size_t>(worst - result.condition.begin()))));
}

void warn_of_fidelity(const StoredResult& result, Warnings& list) {
  const std::optional<FidelityResult>& compared = result.sensitivity.fidelity;
  if (compared) {
    const auto count = std::ranges::count(compared->linear, std::uint8_t{0});
    if (count > 0) {
      list.push_back(
          fmt::format("{} of {} errors are not linear at the size the study sets: fidelity \"{}\" does not "
                      "stand for \"{}\" there.",
                      count, compared->linear.size(), result.fidelities[1], result.fidelities[0]));
    }
  } else if (readable_setting(result.study_text, "mechanism", "fidelity") == "first-order") {
    list.push_back(
        "The model was solved to first order in the errors. What grows with their square is not in these numbers; a "
        "sensitivity study that compares two fidelities shows how much that is.");
  }
}

void warn_of_sensitivity(const StoredResult& result, Warnings& list) {
  warn_of_unknown_indices(result, list);
  warn_of_small_errors(result, list);
  warn_of_sizes(result, list);
  if (const auto& found = result.sensitivity.convergence) {
    std::vector<std::size_t> all(result.responses.size());
    for (std::size_t r = 0; r < all.size(); ++r) all[r] = r;
    warn_of_convergence(*found, all, "global indices", list);
  }
  warn_of_wide_intervals(result, list);
}

}  // namespace

std::vector<std::string> warnings(const ReportedResult& result) {
  const StoredResult& stored = result.stored;
  Warnings list;
  warn_of_changes(result, list);
  warn_of_unsolved(stored, list);
  warn_of_unsolved_at_second_fidelity(stored, list);
  warn_of_unsolved_poses(stored, list);
  if (stored.kind == "sensitivity") warn_of_sensitivity(stored, list);
  if (const auto& found = stored.monte_carlo.convergence) {
    warn_of_convergence(*found, stored.headline, "overall means", list);
  }
  warn_of_poses(stored, list);
  warn_of_fidelity(stored, list);
  return list;
}

}  // namespace poesy
