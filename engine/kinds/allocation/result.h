#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
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

namespace poesy::axis {

using Part = Axis<"part">;                 ///< Parts of the machine.
using Stage = Axis<"stage">;               ///< Stages of the search.
using CurveYield = Axis<"curve_yield">;    ///< Yields at which a cost curve is predicted.
using CurveFactor = Axis<"curve_factor">;  ///< Factors on all limits at which a cost curve is predicted.

}  // namespace poesy::axis

namespace poesy::allocation {

/// The cost of a tolerance T (SI), as a law with parameters. The parameters are kept, with b converted to SI, so that
/// the study can be written again with exactly the same cost.
struct StatedCost {
  /// The form of the cost as a function of T.
  enum class Law {
    none,              ///< no cost
    reciprocal,        ///< a + b / T
    reciprocal_power,  ///< a + b / T^k
    exponential        ///< a + b exp(-T / tau)
  };
  Law law = Law::none;  ///< the law of the cost
  double a = 0.0;       ///< the term of the cost that does not depend on T
  double b = 0.0;       ///< factor of the term that depends on T, >= 0; in units of cost for exponential, otherwise in
                        ///< cost x (SI unit of T)^k, with k = 1 for reciprocal
  double k = 1.0;       ///< exponent of reciprocal_power, > 0
  double tau = 0.0;     ///< decay constant of exponential, > 0, in the SI unit of T

  CostLaw cost_law() const;                            ///< The cost as a function of T.
  bool operator==(const StatedCost&) const = default;  ///< Same law and numbers.
};

/// A process that can make a part, with the tolerances that it can keep.
struct StatedProcess {
  std::string name;                                     ///< name of the process: "turning"
  StatedCost cost = {};                                 ///< cost of a tolerance within the range of the process
  double lo = 0.0;                                      ///< smallest tolerance, SI
  double hi = std::numeric_limits<double>::infinity();  ///< largest tolerance, SI
};

/// A tolerance zone of a drawing as a part. Its tolerance T is the diameter or width of the zone. A distance with the
/// tolerance +-T also counts as a zone.
struct PartZone {
  std::string key;  ///< key of the zone in files: "position"
  /// Positions of the zone's features among those of the model: one in each limb that shares the tolerance.
  std::vector<std::size_t> features;
};

/// A part of the drawing: errors that share one tolerance T. The drawing states +-T, or the size of a zone.
struct AllocatedPart {
  /// How the tolerance is chosen.
  enum class Choice {
    range,      ///< any value between a lower and an upper bound
    values,     ///< one of a list of values
    grades,     ///< one of the grades of ISO 286-1 for a nominal size; T is half the width of the grade
    processes,  ///< any value within the range of one of several processes
    fixed       ///< one given value
  };
  std::string name;                  ///< name of the part in tables and files
  std::vector<FactorIndex> factors;  ///< its errors, at least one, all of one dimension; an error is in one part only
  /// Number of standard deviations in the tolerance: T = shift x T + sigmas x standard deviation of an error. For a
  /// zone that is not a distance, T / 2 = sigmas x standard deviation of a coordinate of an extreme point (end of an
  /// axis, corner of a plane).
  double sigmas = 3.0;
  double shift = 0.0;             ///< offset of the mean as a share of T, in either direction; 0 <= shift < 1
  Choice choice = Choice::range;  ///< how the tolerance is chosen; this determines which of the members below apply
  StatedCost cost = {};           ///< cost of T; `processes` have their own costs
  double lo = 0.0;                ///< smallest tolerance of a range, or the fixed tolerance, SI
  double hi = std::numeric_limits<double>::infinity();  ///< largest tolerance of a range, SI; infinity: a quarter of
                                                        ///< Model::error_bound
  /// The possible tolerances, SI, ascending; only if the study states the key `values`.
  std::vector<double> values = {};
  std::vector<ItGrade> grades = {};           ///< the possible grades, finest first; only with the key `grades`
  double nominal_size = 0.0;                  ///< the nominal size, m; only with the key `grades`
  std::vector<StatedProcess> processes = {};  ///< the processes that may be chosen; only with the key `processes`
  std::optional<PartZone> zone = {};          ///< the zone, if the part is one
  /// The preferred tolerances. In its last stage, the search rounds T down to one of them. Only with a range or with
  /// the key `processes`.
  std::optional<Rounding> round = {};
};

/// Which tolerances a study seeks among those that keep the limits.
enum class Aim {
  least_cost,       ///< the tolerances of least total cost
  equal_effect,     ///< every part uses the same share of the limit on which it has the largest effect
  equal_tolerance,  ///< one tolerance for all lengths, one for all angles and one for all numbers without unit, in the
                    ///< ratio of the median tolerances that follow from [errors]
  common_factor     ///< all standard deviations of [errors] times one factor, as large as the limits allow
};

/// The options of a study of kind `allocation`.
struct Options {
  std::vector<AllocatedPart> parts;  ///< parts whose tolerances are sought; all other errors keep their distribution
  Aim aim = Aim::least_cost;         ///< which tolerances are sought
  double yield = 0.9973;             ///< share of machines that must be within all limits at all poses
  double confidence = 0.95;          ///< confidence of the certificate
};

std::string_view name(StatedCost::Law law);  ///< The name of a law in study files.
std::string_view name(Aim aim);              ///< The name of an aim in study files.

/// The kind of study that finds tolerances under limits, `allocation`.
extern const StudyKind kStudy;

/// Name of the stage in which tolerances are rounded down to the values that the study asks for.
inline constexpr std::string_view kRoundedDown = "rounded down";

/// One step of the search for the tolerances.
struct AllocationStage {
  std::string name;            ///< name of the stage: "linear", "tried on machines", "scaled to the yield", ...
  double cost = 0.0;           ///< total cost at the end of the stage; NaN if no part has a cost
  double lower_bound = 0.0;    ///< lower bound on the least cost in the last optimisation; NaN if the stage changed the
                               ///< tolerances after it, or if the aim is not least_cost
  double rms_share = 0.0;      ///< share of each limit that root mean squares could use in the last optimisation
  std::uint64_t machines = 0;  ///< machines tried at the tolerances of this stage; 0: none
  std::uint64_t rejects = 0;   ///< rejects among these machines
};

/// The result of a study of kind `allocation`. Numbers are in SI units. Numbers that are not defined are NaN, such as
/// `multiplier`, `limit_use` and `saving` of a response without a limit.
struct Result {
  /// A value for each part.
  template <class T>
  using Parts = Array<T, axis::Part>;
  /// A number for each response and pose.
  using AtPoses = Array<double, axis::Response, axis::Pose>;
  /// Value of `bound` for a part at its upper bound on which no limit depends, so that the limits do not determine its
  /// tolerance.
  static constexpr std::uint8_t kWithoutEffect = 4;

  std::vector<std::string> part_names;  ///< names of the parts
  Parts<std::string> part_members;      ///< names of a part's errors, separated by blanks
  Parts<std::string> part_unit;         ///< SI unit of the tolerance T: "m", "rad" or "1"
  Parts<double> tolerance;              ///< tolerance T: the drawing states +-T, or T as the size of a zone
  Parts<double> sigma;                  ///< standard deviation of the errors about their mean; of a zone, that of
                                        ///< its first error
  Parts<double> sigmas;  ///< number of sigma in T: T = shift + sigmas x sigma; of a zone, see AllocatedPart
  Parts<double> shift;   ///< offset of the mean, in either direction, in the unit of T
  Parts<double> cost;    ///< cost of the part; NaN if no part has a cost
  Parts<double> share;   ///< share of the total cost
  /// Share of the part in the mean square that all parts together cause in the response with the tightest limit. The
  /// shares of all parts add up to 1.
  Parts<double> mean_square_share;
  /// The same share for each error. The shares of a part's errors add up to the share of the part; for a location and
  /// an orientation of one feature, to the sum of both parts' shares. NaN for an error that is in no part.
  Array<double, axis::Factor> error_mean_square_share;
  /// AtBound: 0 between bounds, 1 at the lower bound, 2 at the upper bound, 3 a single possible value; or
  /// kWithoutEffect.
  Parts<std::uint8_t> bound;
  Parts<std::string> chosen;  ///< name of the chosen process or grade, and of the series of numbers to which T is
                              ///< rounded down; empty without these
  /// Predicted share of good machines, among the machines with which the tolerances were found, if only this part has a
  /// larger tolerance: 5 % larger, or its next larger possible value. NaN if it cannot have a larger one.
  Parts<double> coarser_yield;

  /// @name Zones of a drawing: a number or text for each part. For a part that is not a zone, texts are empty, and
  /// lengths and shares are NaN. All arrays are empty if no part is a zone.
  /// @{
  Parts<std::string> zone_feature;  ///< name of the feature on the drawing: "rail"
  Parts<std::string> zone_limbs;    ///< limbs that share the zone: "1-3"
  Parts<std::string> zone_key;      ///< key of the zone in files: "position"
  Parts<std::string> zone_shape;    ///< shape of the zone: "cylinder", "sphere", "planes", or "interval" for a distance
  Parts<std::string> zone_datums;   ///< datums of the zone: "A|B"
  Parts<double> zone_length;        ///< length of an axis, first side or diameter of a plane, nominal size of a
                                    ///< distance (m); NaN: none
  Parts<double> zone_width;         ///< second side of a plane (m); 0: round; NaN: none
  Parts<double> zone_inside;        ///< share of features that are inside the zone
  Parts<std::uint8_t> zone_is_needed;  ///< 0 for a zone of orientation that the drawing does not need, otherwise 1
  /// @}

  AtPoses multiplier;  ///< cost saved per SI unit by which the limit is widened at only this pose, to first order
  AtPoses limit_use;   ///< predicted root mean square, divided by the largest one that the last optimisation allows
  /// The limit, SI. For a limit that is neither on a magnitude nor on a spread: the smallest distance, over the poses,
  /// from the response of the mechanism with perfect parts to the nearer end of the limit.
  Array<double, axis::Response> limit;
  /// The lower and upper ends of the limits, SI; an end that a limit does not have is infinite. Empty if all limits are
  /// on magnitudes.
  /// @{
  Array<double, axis::Response> limit_from;
  Array<double, axis::Response> limit_to;
  /// @}
  /// The share of a machine's poses at which each limit must hold, and whether the limit is on the spread over the
  /// poses (1 or 0). Empty if all limits hold at each pose.
  /// @{
  Array<double, axis::Response> limit_pose_share;
  Array<double, axis::Response> limit_is_spread;
  /// @}
  /// Share of the response's mean square that no part causes, at the pose where the limit is used most. Its causes are
  /// the background, errors in no part, noise of measurements, and interactions of errors. Empty in files of version
  /// 0.2.
  Array<double, axis::Response> fixed_share;
  /// Cost saved if a limit is one percent wider at all poses, to first order, so that the yield stays the same. NaN
  /// also if there are several limits and no machine of the certificate is near them.
  Array<double, axis::Response> saving;
  /// Share of the certificate's machines near the limits whose largest ratio of a response to its limit is that of this
  /// response at this pose. Empty in files of version 0.2.
  AtPoses deciding_share;

  Aim aim = Aim::least_cost;  ///< what the study optimised
  double total_cost = 0.0;    ///< cost of all parts; NaN if no part has a cost
  /// Lower bound on the total cost of any tolerances that keep the last limits on root mean squares; NaN if the aim is
  /// not least_cost, or if the tolerances are the lowest ones.
  double lower_bound = 0.0;
  double gap = 0.0;           ///< cost of the tolerances of the last optimisation minus lower_bound
  double wanted_yield = 0.0;  ///< yield that the study asked for
  double confidence = 0.95;   ///< confidence that the study asked for

  std::vector<AllocationStage> stages;                     ///< stages of the search, in order
  Array<double, axis::Stage, axis::Part> stage_tolerance;  ///< [stages x parts] tolerance T at the end of each stage
  std::uint64_t design_machines = 0;                       ///< number of machines with which the tolerances were found
  std::uint64_t design_rejects = 0;                        ///< rejects among these machines at the found tolerances
  std::uint64_t design_most = 0;  ///< largest number of design rejects with which the certificate will probably hold

  std::uint64_t certificate_seed = 0;  ///< seed of the certificate's machines
  std::uint64_t certificate_most = 0;  ///< largest number of rejects with which the certificate holds
  YieldVerdict certificate;            ///< verdict on the certificate's machines; `kept` means certified
  bool calibrated = false;  ///< whether responses are those that remain after the best correction by the actuators

  std::vector<double> curve_yield;                     ///< yields at which a cost is predicted, ascending
  Array<double, axis::CurveYield> curve_yield_cost;    ///< predicted cost at these yields
  std::vector<double> curve_factor;                    ///< factors on all limits for which a cost is predicted,
                                                       ///< ascending
  Array<double, axis::CurveFactor> curve_factor_cost;  ///< predicted cost with all limits multiplied by these factors

  std::string certificate_study;          ///< text of the study that repeats the certificate
  Array<SolveCounts, axis::Pose> solves;  ///< how the solves of the certificate's machines ended
  std::vector<Failure> failures;          ///< the first samples of the certificate that were not solved

  std::size_t parts() const { return part_names.size(); }   ///< The number of parts.
  bool has_zones() const { return !zone_feature.empty(); }  ///< Whether some part is a zone of the drawing.
  /// Whether the part is a zone of orientation that the drawing does not need.
  bool is_left_out(std::size_t part) const { return has_zones() && zone_is_needed(part) == 0; }
  /// The sum of `deciding_share` over the poses, for a response.
  double decides(std::size_t r) const {
    const auto shares = deciding_share.row(r);
    return std::accumulate(shares.begin(), shares.end(), 0.0);
  }
  std::size_t poses() const { return limit_use.length<axis::Pose>(); }  ///< The number of poses.
  /// How the certificate's solves ended, summed over poses.
  SolveCounts total() const { return total_of(solves.all()); }
  /// Whether the certificate holds.
  bool certified() const { return certificate.decision == YieldVerdict::Decision::kept; }
};

/// The result of a study of kind `allocation`, read from a file. Precondition: the result is of this kind.
inline const Result& allocation_of(const StoredResult& result) { return found_of<Result>(result); }

/// The tables of the result: certificate, parts of the drawing, errors in no part, use and cost of each limit, stages
/// of the search, and predicted costs with other yields and limits.
std::vector<Table> allocation_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy::allocation
