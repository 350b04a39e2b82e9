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

namespace poesy::allocation {

/// Tolerances of all parts, and their cost.
struct TolerancePoint {
  std::vector<double> tolerance;     ///< [parts] tolerance of each part, SI
  std::vector<std::size_t> process;  ///< [parts] position of the chosen process among those of the part
  double cost = 0.0;                 ///< total cost; NaN if no part has a cost
};

/// The tolerances that the optimisation (ToleranceProgramme::choose) chose under the limits.
struct ChosenTolerances : TolerancePoint {
  double lower_bound = 0.0;        ///< lower bound on the least cost; NaN if the aim is not Aim::least_cost
  std::vector<double> multiplier;  ///< [rows of ToleranceLimits] cost saved per unit of additional
                                   ///< ToleranceLimits::room; empty if the aim is not Aim::least_cost
};

/// The region around the tolerances of a linearisation in which the optimisation may choose tolerances.
struct TrustRegion {
  /// [parts] Tolerances at the linearisation; empty: no trust region.
  std::span<const double> centre = {};
  /// A tolerance may be at most this many times that of the centre.
  double growth = std::numeric_limits<double>::infinity();
};

/// The result of ToleranceProgramme::choose(): tolerances, or the reason why there are none.
using ChoiceOfTolerances = std::variant<ChosenTolerances, Infeasible, Unbounded>;

/// The optimisation problem (programme) of a study: the parts whose tolerances are sought, with their bounds, processes
/// and costs.
class ToleranceProgramme {
 public:
  /// Keeps a reference to the study. A part without an upper bound gets one: a quarter of the size that
  /// Model::error_bound gives.
  ToleranceProgramme(const Study& study, const Model& model);

  std::size_t size() const { return parts().size(); }  ///< The number of parts.
  const std::vector<AllocatedPart>& parts() const;     ///< The parts as the study states them.
  /// [parts] The processes of each part. Each value, grade or range from which the part may choose is a process.
  const std::vector<std::vector<Process>>& processes() const { return processes_; }
  /// The positions, among the errors that the study varies, of the errors of a part. If a feature has a zone of
  /// location and a zone of orientation, the errors of the zone of location depend on the tolerances of both.
  std::span<const std::size_t> errors(std::size_t part) const { return errors_[part]; }
  const std::vector<Within>& pairs() const { return pairs_; }  ///< Zones of orientation within zones of location.
  /// Whether a part is a zone of orientation that is as wide as the zone of location allows, so that the drawing does
  /// not need it.
  bool is_void(const TolerancePoint& point, std::size_t part) const;
  /// The factors by which a part's errors change if only the tolerance of this part is multiplied by |factor|. A
  /// negative `factor` also mirrors the errors. For a pair of zones, errors of standard deviation 0 are left out.
  Variation variation(const TolerancePoint& point, std::size_t part, double factor) const;
  /// How the effect of a part on a mean square is divided among its errors.
  struct Weights {
    std::vector<ErrorFactor> errors;  ///< the errors; `factor` is a number proportional to the variance of the error
    std::vector<std::size_t> parts;   ///< the part itself, or both parts of its pair of zones
  };
  Weights weights(const TolerancePoint& point, std::size_t part) const;  ///< The weights of a part's errors.
  /// The derivative of ln(standard deviation of each error) with respect to ln(tolerance of this part); 1 if the part
  /// is in no pair of zones.
  std::vector<ErrorFactor> growth(const TolerancePoint& point, std::size_t part) const;
  /// The name of this process or grade of a part, followed by a text on the values to which its tolerance is rounded
  /// down. Empty if the part has none of these.
  std::string chosen_name(std::size_t part, std::size_t process) const;

  /// [parts] The tolerance (SI) of each part that follows from [errors] of the study: from the smallest standard
  /// deviation of the part's errors; for a zone, from the smallest size on the drawing. Tolerances that the parts
  /// cannot have are replaced as at_most() does.
  std::vector<double> usual() const;
  /// The point at which each part has its largest possible tolerance that is not above `tolerance` [parts]; if there is
  /// none, its lowest tolerance. A zone of orientation is at most as wide as its zone of location allows.
  TolerancePoint at_most(std::span<const double> tolerance) const;
  TolerancePoint lowest() const;  ///< The lowest tolerances.
  /// The point with each tolerance rounded down as the study asks for its part. No standard deviation grows. If a
  /// zone of orientation is rounded down, the tilt uses less of the zone of location, and the middle of the feature
  /// could use more. So the zone of location is made finer as well before it is rounded.
  TolerancePoint rounded(const TolerancePoint& point) const;
  /// The point with one part coarser: its tolerance multiplied by `factor`, or its next larger value. A zone of
  /// orientation may also be made so wide that the drawing does not need it. None if the part can have no larger
  /// tolerance, if its tolerance is 0, or if the drawing does not need it at `point`.
  std::optional<TolerancePoint> coarser(const TolerancePoint& point, std::size_t part, double factor) const;
  /// Whether the tolerance of a part is at a bound.
  AtBound at_bound(const TolerancePoint& point, std::size_t part) const;
  /// The cost of a part; 0 if it has no cost or the drawing does not need it.
  double cost(const TolerancePoint& point, std::size_t part) const;
  /// Narrows each zone of orientation in `tolerance` [parts] that is wider than its zone of location allows.
  void keep_within(std::span<double> tolerance) const;
  /// For each zone of orientation that the drawing does not need at `point`: sets its width in `tolerance` [parts] to
  /// the largest that its zone of location allows.
  void keep_void(const TolerancePoint& point, std::span<double> tolerance) const;
  /// Raises negative effects of zones of orientation on limits to the smallest value that the optimisation accepts
  /// (Within).
  void keep_allowed(ToleranceLimits& limits) const;
  /// The limits on the mean squares that all parts together cause: room = (share x MeanSquares::room x wider)^2 minus
  /// the mean square that no part causes, SI squared. at: [parts] tolerances at which the mean squares were measured.
  /// share: the share of each limit that root mean squares may use. wider: a factor on all limits.
  ToleranceLimits limits(const MeanSquares& squares, std::span<const double> at, double share,
                         double wider = 1.0) const;
  /// Solves the optimisation problem of the study's aim under these limits.
  ChoiceOfTolerances choose(const ToleranceLimits& limits, const TrustRegion& region) const;

  /// The study in which the errors of the parts have these tolerances [parts].
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
  std::vector<std::vector<Process>> processes_;   ///< [parts] processes of each part
  std::vector<DrawnPart> drawn_;                  ///< [parts] how the mean squares of the errors depend on T
  std::vector<std::vector<std::size_t>> errors_;  ///< [parts] positions of each part's errors, see errors()
  std::vector<Within> pairs_;
  bool has_costs_ = false;
};

}  // namespace poesy::allocation
