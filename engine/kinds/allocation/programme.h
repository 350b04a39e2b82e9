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
#include "engine/kinds/allocation/variations.h"
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
  /// The positions of a part's own errors among those of the study. The errors of a zone of location also depend on
  /// that of orientation.
  std::span<const std::size_t> errors(std::size_t part) const { return errors_[part]; }
  const std::vector<Within>& pairs() const { return pairs_; }  ///< Zones of orientation within zones of location.
  /// Whether a part is a zone of orientation as wide as the location allows, so that the drawing does not need it.
  bool is_void(const TolerancePoint& point, std::size_t part) const;
  /// How the standard deviations of errors change if this part alone has a tolerance `factor` times as large. A
  /// negative factor mirrors them, too. Errors of zones in pairs with a standard deviation of 0 are left out.
  Variation variation(const TolerancePoint& point, std::size_t part, double factor) const;
  /// How parts share out what they add to mean squares among their errors.
  struct Weights {
    std::vector<ErrorFactor> errors;  ///< with their variances, up to a factor
    std::vector<std::size_t> parts;   ///< the part, or both parts of its pair
  };
  Weights weights(const TolerancePoint& point, std::size_t part) const;  ///< The weights of a part's errors.
  /// The derivative of the logarithm of each standard deviation by that of this part's tolerance; 1 except in pairs.
  std::vector<ErrorFactor> growth(const TolerancePoint& point, std::size_t part) const;
  std::string chosen_name(std::size_t part,
                          std::size_t process) const;  ///< The name of a process or grade; else empty.

  std::vector<double> usual() const;  ///< [N] The tolerances that [errors] states, moved within bounds.
  /// Each tolerance [N], or the next lower one that its part can have, or the lowest one.
  TolerancePoint at_most(std::span<const double> tolerance) const;
  TolerancePoint lowest() const;  ///< The lowest tolerances.
  /// The point with each tolerance rounded down to what its part asks for. No error has a larger standard deviation:
  /// where an orientation becomes finer, its location is rounded down from what then leaves the middle as it was.
  TolerancePoint rounded(const TolerancePoint& point) const;
  /// The point with one part coarser: its tolerance `factor` times as large, or the next larger value it can have. None
  /// if its process allows no such value, and for a tolerance of 0. A zone of orientation may also be left out.
  std::optional<TolerancePoint> coarser(const TolerancePoint& point, std::size_t part, double factor) const;
  /// Whether the tolerance of a part is at a bound.
  AtBound at_bound(const TolerancePoint& point, std::size_t part) const;
  /// The cost of a part; 0 where none is stated, and for what is left out.
  double cost(const TolerancePoint& point, std::size_t part) const;
  /// Moves zones of orientation within their locations.
  void keep_within(std::span<double> tolerance) const;
  /// Gives orientations that the point does not need the widths that these locations [N] allow.
  void keep_void(const TolerancePoint& point, std::span<double> tolerance) const;
  /// Raises negative effects of zones of orientation on limits as far as a programme needs it (Within).
  void keep_allowed(ToleranceLimits& limits) const;
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
  const Within* pair_of(std::size_t part) const;
  std::vector<ErrorFactor> squares_of_pair(const Within& pair, std::span<const double> tolerance) const;
  double usual_of_zone(const AllocatedPart& part) const;
  ChoiceOfTolerances least(const ToleranceLimits& limits, const TrustRegion& region) const;
  ChoiceOfTolerances largest(const ToleranceLimits& limits) const;
  std::vector<double> proportions(const ToleranceLimits& limits) const;

  const Study& study_;
  std::vector<std::vector<Process>> processes_;   ///< [N]
  std::vector<DrawnPart> drawn_;                  ///< [N]
  std::vector<std::vector<std::size_t>> errors_;  ///< [N]
  std::vector<Within> pairs_;
  bool has_costs_ = false;
};

}  // namespace poesy
