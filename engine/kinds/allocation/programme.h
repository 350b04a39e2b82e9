#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/kinds/allocation/drawn_part.h"
#include "engine/kinds/allocation/mean_squares.h"
#include "engine/kinds/allocation/result.h"
#include "engine/model/model.h"
#include "engine/optimise/least_cost.h"
#include "engine/optimise/tolerance_limits.h"
#include "engine/study/study.h"

namespace poesy {

/// Tolerances of all parts, and what they cost.
struct TolerancePoint {
  std::vector<double> tolerance;     ///< [N] SI
  std::vector<std::size_t> process;  ///< [N] position among the part's processes
  double cost = 0.0;                 ///< NaN where no part has a cost
};

/// The same as a programme chose them under L limits.
struct ChosenTolerances : TolerancePoint {
  double lower_bound = 0.0;        ///< on the least cost; NaN for an aim without costs
  std::vector<double> multiplier;  ///< [L] what one unit more of room would save; empty for an aim without costs
};

/// The trust region around the tolerances at which mean squares were found.
struct TrustRegion {
  std::span<const double> centre = {};                      ///< [N] these tolerances; empty: no region
  double growth = std::numeric_limits<double>::infinity();  ///< tolerances are at most so many times these
};

/// What a programme gives: tolerances, or why there are none.
using ChoiceOfTolerances = std::variant<ChosenTolerances, Infeasible, Unbounded>;

/// The parts of a study as an optimiser sees them.
class ToleranceProgramme {
 public:
  /// Refers to the study. A part without an upper bound may be a quarter of what it is a part of (Model::error_bound).
  ToleranceProgramme(const Study& study, const Model& model);

  std::size_t size() const { return parts().size(); }  ///< N.
  const std::vector<AllocatedPart>& parts() const;     ///< [N] As the study has them.
  /// [N] of each part its processes: one for each value, grade or range.
  const std::vector<std::vector<Process>>& processes() const { return processes_; }
  /// Positions of a part's errors among those of the study.
  std::span<const std::size_t> errors(std::size_t part) const { return drawn_[part].factors; }
  std::string chosen_name(std::size_t part, std::size_t process) const;  ///< Of a process or grade; else empty.

  std::vector<double> usual() const;  ///< [N] tolerances of errors as [errors] has them, within bounds.
  /// Each tolerance [N], or the next lower one that its part may have; the lowest one where there is none.
  TolerancePoint at_most(std::span<const double> tolerance) const;
  TolerancePoint lowest() const;  ///< The lowest ones.
  /// The next coarser tolerance of one part: `factor` times as large, or the next value that can be had; none where
  /// its process allows none, and for a tolerance of 0.
  std::optional<TolerancePoint> coarser(const TolerancePoint& point, std::size_t part, double factor) const;
  /// Whether tolerances are as large as a part allows, and in which way.
  AtBound at_bound(std::size_t part, double tolerance, std::size_t process) const;
  /// Cost of a part; 0 where none is stated.
  double cost(std::size_t part, double tolerance, std::size_t process) const;
  /// Limits on the parts' mean squares: each row's share of the limit, times `wider`, squared, less what is not theirs.
  /// at: [N] the tolerances at which the mean squares were found.
  ToleranceLimits limits(const MeanSquares& squares, std::span<const double> at, double share,
                         double wider = 1.0) const;
  /// The tolerances by the study's aim.
  ChoiceOfTolerances choose(const ToleranceLimits& limits, const TrustRegion& region) const;

  /// The study with these tolerances [N].
  Study at(std::span<const double> tolerance) const;

 private:
  std::vector<std::vector<Process>> within(const TrustRegion& region,
                                           std::vector<std::vector<std::size_t>>& kept) const;
  double cost_of(const TolerancePoint& point) const;
  ChoiceOfTolerances least(const ToleranceLimits& limits, const TrustRegion& region) const;
  ChoiceOfTolerances largest(const ToleranceLimits& limits) const;
  std::vector<double> proportions(const ToleranceLimits& limits) const;

  const Study& study_;
  std::vector<std::vector<Process>> processes_;  ///< [N]
  std::vector<DrawnPart> drawn_;                 ///< [N]
  bool has_costs_ = false;
};

}  // namespace poesy
