#include "models/file/rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "models/file/misfit.h"

namespace poesy::file {
namespace {

/// A singular value (as a share of the largest) up to this may be zero in the exact mechanism and differ from zero only
/// because numbers are rounded.
constexpr double kLargestZero = 1e-2;
/// The largest number of gaps between consecutive singular values at which the rank is tried.
constexpr std::size_t kMostGaps = 4;
/// Singular values that would be zero without rounding may be larger at other poses, by at most this factor. The second
/// factor is tried if the mechanism does not pass with the first one.
constexpr std::array kMargins{5.0, 1.5};

/// Calls check(), and returns the error that it throws; none if it throws no error.
template <class Check>
std::optional<InputError> problem_of(Check check) {
  try {
    check();
  } catch (const InputError& problem) {
    return problem;
  }
  return std::nullopt;
}

/// A rank, and the singular values (as shares of the largest) just above and below the threshold that gives this rank.
struct Gap {
  std::size_t rank;
  double above;
  double below;
  double margin;  ///< one of kMargins

  double ratio() const { return above / std::max(below, kRankThreshold); }
  /// Narrows the gap by the singular values of another configuration. Returns true if a gap remains, so that the
  /// mechanism can have this rank in both configurations.
  bool narrow(const std::vector<double>& values) {
    above = std::min(above, values[rank - 1] / values[0]);
    below = std::max(below, values[rank] / values[0]);
    return above > below;
  }
  /// The threshold between the two singular values. It is nearer to the lower one, because the upper one becomes
  /// smaller near singular poses.
  double threshold() const {
    return margin * below <= kRankThreshold ? kRankThreshold : std::min(margin * below, std::sqrt(above * below));
  }
};

/// The gaps between singular values at which the rank of a mechanism with rounded numbers may be, the widest gap first.
std::vector<Gap> gaps_of(const std::vector<double>& values) {
  std::vector<Gap> list;
  for (std::size_t rank = 1; rank < values.size(); ++rank) {
    const Gap gap{rank, values[rank - 1] / values[0], values[rank] / values[0], kMargins.front()};
    if (gap.above > kRankThreshold && gap.below <= kLargestZero && gap.threshold() < gap.above) list.push_back(gap);
  }
  std::ranges::stable_sort(list, std::ranges::greater(), &Gap::ratio);
  if (list.size() > kMostGaps) list.erase(list.begin() + kMostGaps, list.end());
  return list;
}

/// The largest mismatch of the limbs over these poses.
double largest_mismatch(const std::vector<PoseMobility>& poses) {
  double largest = 0.0;
  for (const PoseMobility& pose : poses) largest = std::max(largest, pose.tracked.mismatch);
  return largest;
}

/// The result of treating numbers as rounded. Both members are empty if the mechanism does not pass check_mobility(),
/// or if the gap vanishes at a pose of the workspace.
struct Attempt {
  std::optional<Checked> checked = {};
  std::optional<InputError> misfit = {};  ///< set if the loops close to kNamedGap of the reach, but not to kRoundedGap
};

/// Treats the numbers as rounded. Singular values below the gap count as zero.
Attempt rounded(Mechanism mechanism, Gap gap) {
  const auto passes = [&](const Mobility& home, std::span<const PoseMobility> poses) {
    return !problem_of([&] {
      check_mobility(mechanism, home);
      check_mobility(mechanism, home, poses);
    });
  };
  mechanism.precision = {gap.threshold(), kNamedGap};
  if (!passes(home_mobility(mechanism), {})) return {};
  std::vector<PoseMobility> poses = workspace_mobility(mechanism);
  std::erase_if(poses, [](const PoseMobility& pose) { return !pose.reached(); });
  if (poses.empty()) return {};
  for (const PoseMobility& pose : poses) {
    if (!gap.narrow(pose.mobility.singular_values)) return {};
  }
  mechanism.precision.rank_threshold = gap.threshold();
  Mobility home = home_mobility(mechanism);
  for (PoseMobility& pose : poses) {
    pose.mobility = mobility(mechanism, pose.tracked.displacements, pose.tracked.pose);
  }
  if (!passes(home, poses)) return {};
  const double mismatch = largest_mismatch(poses);
  if (mismatch > kRoundedGap * mechanism.reach) return {.misfit = misfit(mechanism, poses)};
  mechanism.precision.closed = kRoundedGap;
  return {.checked = Checked{std::move(mechanism), std::move(home), mismatch}};
}

}  // namespace

Checked checked(Mechanism mechanism, Workspace workspace) {
  Mobility home = home_mobility(mechanism);
  bool open = false;
  std::optional<InputError> problem = problem_of([&] {
    check_mobility(mechanism, home);
    if (workspace == Workspace::as_it_is && home.over_constraints == 0) return;
    const std::vector<PoseMobility> poses = workspace_mobility(mechanism);
    open = std::ranges::any_of(poses, [](const PoseMobility& pose) { return pose.tracked.open; });
    if (workspace == Workspace::in_reach) check_mobility(mechanism, home, poses);
  });
  if (!problem && !open) return {std::move(mechanism), std::move(home)};
  // Rounded limbs with stiffness would press on each other, which parts of the real machine do not do.
  if (mechanism.is_branched() && mechanism.is_elastic() && problem) throw *problem;
  std::optional<InputError> nearly;
  for (Gap gap : gaps_of(home.singular_values)) {
    for (const double margin : kMargins) {
      gap.margin = margin;
      Attempt attempt = rounded(mechanism, gap);
      if (attempt.checked) return *std::move(attempt.checked);
      if (!nearly) nearly = std::move(attempt.misfit);
    }
  }
  if (problem) throw nearly.value_or(*problem);
  return {std::move(mechanism), std::move(home)};
}

}  // namespace poesy::file
