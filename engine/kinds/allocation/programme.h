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

/// The tolerances that a programme chose under L limits.
struct ChosenTolerances : TolerancePoint {
  double lower_bound = 0.0;        ///< a lower bound on the least cost; NaN for an aim without costs
  std::vector<double> multiplier;  ///< [L] what one unit more of room would save; empty for an aim without costs
};

/// The trust region around the tolerances at which mean squares were found.
struct TrustRegion {
  std::span<const double> centre = {};                      ///< [N] these tolerances; empty: no region
  double growth = std::numeric_limits<double>::infinity();  ///< tolerances are at most so many times these
};

/// The result of a programme: tolerances, or why there are none.
using ChoiceOfTolerances = std::variant<ChosenTolerances, Infeasible, Unbounded>;

/// The optimisation problem of a study: its parts with their bounds, processes and costs.
class ToleranceProgramme {
 public:
  /// Refers to the study. A part without an upper bound may have a quarter of the size that Model::error_bound gives.
  ToleranceProgramme(const Study& study, const Model& model);

  std::size_t size() const { return parts().size(); }  ///< N.
  const std::vector<AllocatedPart>& parts() const;     ///< [N] The parts as the study states them.
  /// [N] The processes of each part: one for each value, grade or range.
  const std::vector<std::vector<Process>>& processes() const { return processes_; }
  /// The positions of a part's errors among those of the study.
  std::span<const std::size_t> errors(std::size_t part) const { return drawn_[part].factors; }
  std::string chosen_name(std::size_t part,
                          std::size_t process) const;  ///< The name of a process or grade; else empty.

  std::vector<double> usual() const;  ///< [N] The tolerances that [errors] states, moved within bounds.
  /// Each tolerance [N], or the next lower one that its part can have, or the lowest one.
  TolerancePoint at_most(std::span<const double> tolerance) const;
  TolerancePoint lowest() const;  ///< The lowest tolerances.
  /// The point with one part coarser: its tolerance `factor` times as large, or the next larger value it can have. None
  /// if its process allows no such value, and for a tolerance of 0.
  std::optional<TolerancePoint> coarser(const TolerancePoint& point, std::size_t part, double factor) const;
  /// Whether a tolerance is at a bound of its part.
  AtBound at_bound(std::size_t part, double tolerance, std::size_t process) const;
  /// The cost of a part; 0 where none is stated.
  double cost(std::size_t part, double tolerance, std::size_t process) const;
  /// Limits on the mean square that parts add: room = (share x MeanSquares::room x wider)^2 - contribution of fixed
  /// errors. at: [N] the tolerances at which the mean squares were measured.
  ToleranceLimits limits(const MeanSquares& squares, std::span<const double> at, double share,
                         double wider = 1.0) const;
  /// The tolerances that are best for the study's aim.
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
