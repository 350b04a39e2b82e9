#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/index.h"
#include "engine/fits/it_grade.h"
#include "engine/kinds/allocation/rounding.h"
#include "engine/optimise/cost_law.h"
#include "engine/optimise/least_cost.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

/// The cost of a tolerance T as a study states it; SI. The law and its numbers are kept so that the text of the study
/// repeats every digit.
struct StatedCost {
  /// The law, by its name in a study file.
  enum class Law {
    none,              ///< costs nothing
    reciprocal,        ///< a + b / T
    reciprocal_power,  ///< a + b / T^k
    exponential        ///< a + b exp(-T / tau)
  };
  Law law = Law::none;  ///< the law of the cost
  double a = 0.0;       ///< the cost that does not depend on T
  double b = 0.0;       ///< >= 0; cost x (m or rad)^k, with k = 1 for reciprocal; a cost for exponential
  double k = 1.0;       ///< > 0, for reciprocal_power
  double tau = 0.0;     ///< > 0, m or rad, for exponential

  CostLaw cost_law() const;                            ///< The same as a function.
  bool operator==(const StatedCost&) const = default;  ///< Same law and numbers.
};

/// One way to make a part: a process with the tolerances that it holds.
struct StatedProcess {
  std::string name;                                     ///< for people: "turning"
  StatedCost cost = {};                                 ///< the cost within its range
  double lo = 0.0;                                      ///< smallest tolerance, SI
  double hi = std::numeric_limits<double>::infinity();  ///< largest tolerance, SI
};

/// The zone of a drawing that a part is: its tolerance T is the diameter or width of the zone, or of a distance +-T.
struct PartZone {
  std::string key;                    ///< "position"
  std::vector<std::size_t> features;  ///< alike in limbs that share the tolerance: positions in the model's features
};

/// A part of the drawing: errors that share one tolerance T, written +-T, or a zone.
struct AllocatedPart {
  /// From what the tolerance is chosen.
  enum class Choice {
    range,      ///< any value within bounds
    values,     ///< one of a list of values
    grades,     ///< one of the grades of ISO 286-1, at a nominal size: +-T is half the width of the grade's zone
    processes,  ///< any value within the range of one of several processes
    fixed       ///< it is given
  };
  std::string name;                  ///< for people and files
  std::vector<FactorIndex> factors;  ///< of one dimension, at least one, and in no other part
  double sigmas = 3.0;               ///< T = shift T + sigmas x standard deviation; of a zone, half of it
  double shift = 0.0;                ///< the mean is off by this share of T, as often up as down; 0 <= shift < 1
  Choice choice = Choice::range;  ///< from what the tolerance is chosen; it determines which of the members below count
  StatedCost cost = {};           ///< cost, for all choices except processes
  double lo = 0.0;                ///< smallest tolerance of a range, or the fixed tolerance, SI
  double hi =
      std::numeric_limits<double>::infinity();  ///< largest tolerance of a range; infinity: Model::error_bound decides
  std::vector<double> values = {};              ///< the values, ascending
  std::vector<ItGrade> grades = {};             ///< the grades, from the finest one
  double nominal_size = 0.0;                    ///< the nominal size for grades, m
  std::vector<StatedProcess> processes = {};    ///< the processes
  std::optional<PartZone> zone = {};            ///< the zone that it is
  std::optional<Rounding> round = {};           ///< of a range or of processes: to what T is rounded down at the end
};

/// Which of the tolerances that keep the limits a study seeks.
enum class Aim {
  least_cost,       ///< the least sum of the parts' costs
  equal_effect,     ///< each part uses the same share of the limit that it uses most
  equal_tolerance,  ///< one T for all lengths and one for all angles, in the ratio of their usual sizes in [errors]
  common_factor     ///< the standard deviations of [errors], all times the largest factor that limits allow
};

/// The options of a study that finds tolerances.
struct AllocationOptions {
  std::vector<AllocatedPart> parts;  ///< the parts whose tolerances are wanted; other errors keep their distribution
  Aim aim = Aim::least_cost;         ///< which tolerances to find among those that keep the limits
  double yield = 0.9973;             ///< share of the machines that must be within all limits at all poses
  double confidence = 0.95;          ///< confidence of the certificate
};

std::string_view name(StatedCost::Law law);  ///< The word in a study file.
std::string_view name(Aim aim);              ///< The word in a study file.

/// The kind of study that finds tolerances under limits.
extern const StudyKind kAllocationStudy;

/// One step of the search for the tolerances.
struct AllocationStage {
  std::string name;          ///< for people: "linear", "at these tolerances", "scaled to the yield", ...
  double cost = 0.0;         ///< of all parts; NaN for an aim without costs
  double lower_bound = 0.0;  ///< lower bound on the least cost of this stage's programme; NaN for an aim without costs
  double rms_share = 0.0;    ///< limit on a root mean square over limit on a value, of this stage
  std::uint64_t machines = 0;  ///< machines tried at these tolerances; 0: none
  std::uint64_t rejects = 0;   ///< rejects among these machines
};

namespace axis {
using Part = Axis<"part">;                 ///< Parts of the machine.
using Stage = Axis<"stage">;               ///< Stages of the search.
using CurveYield = Axis<"curve_yield">;    ///< Yields of a curve.
using CurveFactor = Axis<"curve_factor">;  ///< Factors of all tolerances of a curve.
}  // namespace axis

/// The result of a study that finds tolerances; SI; NaN where undefined. A response without a limit has no multiplier,
/// use or saving: NaN.
struct AllocationResult {
  /// A value for each part.
  template <class T>
  using Parts = Array<T, axis::Part>;
  /// A number for each response and pose.
  using AtPoses = Array<double, axis::Response, axis::Pose>;

  std::vector<std::string> part_names;  ///< names of the parts
  Parts<std::string> part_members;      ///< names of a part's errors, with blanks between
  Parts<std::string> part_unit;         ///< "m" or "rad"
  Parts<double> tolerance;              ///< T, the drawing says +-T
  Parts<double> sigma;                  ///< standard deviation of the errors about their mean
  Parts<double> sigmas;                 ///< T = shift + sigmas x sigma
  Parts<double> shift;                  ///< offset of the mean in either direction
  Parts<double> cost;                   ///< NaN for an aim without costs
  Parts<double> share;                  ///< share of the total cost
  Parts<double> mean_square_share;      ///< share of the sum over all parts in the mean square under the tightest limit
  /// The same for each error; the shares of a part's errors add up to that of the part. NaN for an error of no part.
  Array<double, axis::Factor> error_mean_square_share;
  Parts<std::uint8_t> bound;  ///< AtBound: 0 between its bounds, 1 at the lower, 2 at the upper, 3 no choice
  Parts<std::string> chosen;  ///< name of the process or grade, and to what T is rounded; empty where there is none
  /// Predicted share of good machines among the design's if this part alone is made 5 % coarser, or has its next larger
  /// value; NaN if it cannot be coarser.
  Parts<double> coarser_yield;

  /// @name Zones of a drawing: a number or text for each part, empty text for a part that is not a zone. No arrays if
  /// no part is a zone.
  /// @{
  Parts<std::string> zone_feature;     ///< name of the feature on the drawing: "rail"
  Parts<std::string> zone_limbs;       ///< limbs that share the zone: "1-3"
  Parts<std::string> zone_key;         ///< "position"
  Parts<std::string> zone_shape;       ///< "cylinder", "sphere", "planes"; "interval" of a distance
  Parts<std::string> zone_datums;      ///< "A|B"
  Parts<double> zone_length;           ///< length of an axis, first side or diameter of a plane (m); NaN: none
  Parts<double> zone_width;            ///< second side of a plane (m); NaN: none
  Parts<double> zone_inside;           ///< share of the features that are inside it
  Parts<std::uint8_t> zone_is_needed;  ///< 0: an orientation that the drawing does not need
  /// @}

  AtPoses multiplier;  ///< what one unit more of the limit at this pose alone would save
  AtPoses limit_use;   ///< predicted root mean square over the root mean square that the tightest limit allows
  /// SI; of a limit that is not on the magnitude, the least distance over the poses from the response of the mechanism
  /// with perfect parts to the nearer end.
  Array<double, axis::Response> limit;
  /// The ends of the limits, SI, infinite for none; empty if all limits are on magnitudes.
  /// @{
  Array<double, axis::Response> limit_from;
  Array<double, axis::Response> limit_to;
  /// @}
  /// Share of the poses of a machine at which each limit is to be kept, and 1 for a limit on the spread over the poses
  /// (else 0); empty if all limits are on values at each pose.
  /// @{
  Array<double, axis::Response> limit_pose_share;
  Array<double, axis::Response> limit_is_spread;
  /// @}
  Array<double, axis::Response> saving;  ///< what a limit wider by one percent at all poses would save, to first order

  Aim aim = Aim::least_cost;  ///< what the study optimised
  double total_cost = 0.0;    ///< cost of all parts; NaN for an aim without costs
  double lower_bound =
      0.0;  ///< lower bound on the cost under the last limits on root mean squares; NaN for an aim without costs
  double gap = 0.0;           ///< total_cost less the bound, at most; NaN for an aim without costs
  double wanted_yield = 0.0;  ///< yield that the study asked for
  double confidence = 0.95;   ///< confidence that the study asked for

  std::vector<AllocationStage> stages;                     ///< stages, in their order
  Array<double, axis::Stage, axis::Part> stage_tolerance;  ///< T at the end of each stage
  std::uint64_t design_machines = 0;                       ///< machines with which the tolerances were found
  std::uint64_t design_rejects = 0;                        ///< rejects among them
  std::uint64_t design_most = 0;  ///< largest number of rejects with which the certificate will probably hold

  std::uint64_t certificate_seed = 0;  ///< seed of the fresh machines
  std::uint64_t certificate_most = 0;  ///< largest number of rejects with which the certificate holds
  YieldVerdict certificate;            ///< what the fresh machines show; `kept` means certified
  bool calibrated = false;  ///< whether the responses are those that remain after the best correction of the actuators

  std::vector<double> curve_yield;                     ///< yields of the curve, ascending
  Array<double, axis::CurveYield> curve_yield_cost;    ///< predicted cost at these yields
  std::vector<double> curve_factor;                    ///< factors on all limits, ascending
  Array<double, axis::CurveFactor> curve_factor_cost;  ///< predicted cost with limits multiplied by these factors

  std::string certificate_study;          ///< text of the study that repeats the certificate
  Array<SolveCounts, axis::Pose> solves;  ///< how solves of the certificate's machines ended
  std::vector<Failure> failures;          ///< the first samples of these machines that were not solved

  std::size_t parts() const { return part_names.size(); }   ///< The number of parts of the drawing.
  bool has_zones() const { return !zone_feature.empty(); }  ///< Whether a part is a zone of the drawing.
  /// Whether the part is an orientation that the drawing does not need.
  bool is_left_out(std::size_t part) const { return has_zones() && zone_is_needed(part) == 0; }
  std::size_t poses() const { return limit_use.length<axis::Pose>(); }  ///< The number of poses of the study.
  SolveCounts total() const { return total_of(solves.all()); }          ///< The solves of the certificate at all poses.
  bool certified() const {
    return certificate.decision == YieldVerdict::Decision::kept;
  }  ///< Whether the certificate holds.
};

/// The result of a study that finds tolerances, read from a file. Precondition: the result is of that kind.
inline const AllocationResult& allocation_of(const StoredResult& result) { return found_of<AllocationResult>(result); }

/// Tables of the certificate, the drawing's parts, the cost of each limit, and the stages of the search.
std::vector<Table> allocation_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
