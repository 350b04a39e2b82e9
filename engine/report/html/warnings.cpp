#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "engine/report/display.h"
#include "engine/report/html/sections.h"
#include "engine/report/study_settings.h"

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

void warn_of_unsolved(const StoredResult& result, const SolveTally& tally, Warnings& list) {
  const SolveCounts total = tally.total();
  if (many_not_converged(result, total.not_converged(), total.total())) list.push_back(unsolved_text(result, tally));
  const std::optional<SecondFidelity>& second = tally.second;
  if (!second || !many_not_converged(result, second->not_converged, second->total)) return;
  const double share = static_cast<double>(second->not_converged) / static_cast<double>(second->total);
  list.push_back(fmt::format("{} of {} solves at fidelity \"{}\" ({}) did not converge.",
                             count_text(second->not_converged), count_text(second->total), second->second,
                             percent_text(share)));
}

void warn_of_unsolved_poses(const SolveTally& tally, Warnings& list) {
  std::vector<std::string> poses;
  const std::vector<double> shares = tally.shares_by_pose();
  for (std::size_t m = 0; m < shares.size(); ++m) {
    if (shares[m] == 1.0) poses.push_back(std::to_string(m));
  }
  if (poses.empty()) return;
  list.push_back(fmt::format("Nothing was solved at {}: {}.", counted(poses.size(), "pose", "poses"),
                             "number " + some_names(poses)));
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

void warn_of_fidelity(const StoredResult& result, const SolveTally& tally, Warnings& list) {
  if (tally.second && tally.second->not_linear > 0) {
    list.push_back(
        fmt::format("{} of {} errors are not linear at the size the study sets: fidelity \"{}\" does not "
                    "stand for \"{}\" there.",
                    tally.second->not_linear, tally.second->errors, tally.second->second, tally.second->first));
  }
  if (!tally.second && readable_setting(result.study_text, "mechanism", "fidelity") == "first-order") {
    list.push_back(
        "The model was solved to first order in the errors. What grows with their square is not in these numbers; a "
        "sensitivity study that compares two fidelities shows how much that is.");
  }
}

}  // namespace

std::vector<std::string> warnings(const ReportKind& kind, const ReportedResult& result) {
  const StoredResult& stored = result.stored;
  const SolveTally tally = kind.tally(stored);
  Warnings list;
  warn_of_changes(result, list);
  warn_of_unsolved(stored, tally, list);
  warn_of_unsolved_poses(tally, list);
  if (kind.warn != nullptr) kind.warn(stored, list);
  warn_of_poses(stored, list);
  warn_of_fidelity(stored, tally, list);
  return list;
}

}  // namespace poesy
