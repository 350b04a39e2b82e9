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

/// The cost of a tolerance T in SI units, as a law with parameters. The stated numbers are kept so that the study can
/// be written again digit by digit.
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
  double b = 0.0;       ///< factor of the term that depends on T, >= 0; its unit is cost x (m or rad)^k, with k = 1 for
                        ///< reciprocal, and a cost for exponential
  double k = 1.0;       ///< exponent of reciprocal_power, > 0
  double tau = 0.0;     ///< decay constant of exponential, > 0, m or rad

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

/// A tolerance zone of a drawing as a part. T is the diameter or width of the zone, or +-T of a distance.
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
  double sigmas = 3.0;  ///< standard deviations in a tolerance: T = shift T + sigmas x standard deviation; for a zone,
                        ///< T / 2 = `sigmas` x standard deviation
  double shift = 0.0;   ///< offset of the mean as a share of T, in either direction; 0 <= shift < 1
  Choice choice = Choice::range;  ///< how the tolerance is chosen; this determines which of the members below apply
  StatedCost cost = {};           ///< cost of T; `processes` have their own costs
  double lo = 0.0;                ///< smallest tolerance of a range, or the fixed tolerance, SI
  double hi = std::numeric_limits<double>::infinity();  ///< largest tolerance of a range, SI; infinity: limited by
                                                        ///< Model::error_bound
  /// The possible tolerances, SI, ascending; only if the study states the key `values`.
  std::vector<double> values = {};
  std::vector<ItGrade> grades = {};           ///< the possible grades, finest first; only with the key `grades`
  double nominal_size = 0.0;                  ///< the nominal size, m; only with the key `grades`
  std::vector<StatedProcess> processes = {};  ///< the processes that may be chosen; only with the key `processes`
  std::optional<PartZone> zone = {};          ///< the zone, if the part is one
  /// The preferred numbers to which the tolerance is rounded down at the end; only with a range or the key `processes`.
  std::optional<Rounding> round = {};
};

/// Which tolerances a study seeks among those that keep the limits.
enum class Aim {
  least_cost,       ///< the tolerances of least total cost
  equal_effect,     ///< every part uses the same share of the limit on which it has the largest effect
  equal_tolerance,  ///< one tolerance for all lengths and one for all angles; their ratio is that of the usual sizes in
                    ///< [errors]
  common_factor     ///< all standard deviations of [errors] times one factor, as large as the limits allow
};

/// The options of a study of kind `allocation`.
struct AllocationOptions {
  std::vector<AllocatedPart> parts;  ///< parts whose tolerances are sought; all other errors keep their distribution
  Aim aim = Aim::least_cost;         ///< which tolerances are sought
  double yield = 0.9973;             ///< share of machines that must be within all limits at all poses
  double confidence = 0.95;          ///< confidence of the certificate
};

std::string_view name(StatedCost::Law law);  ///< The name of a law in study files.
std::string_view name(Aim aim);              ///< The name of an aim in study files.

/// The kind of study that finds tolerances under limits, `allocation`.
extern const StudyKind kAllocationStudy;

/// Name of the stage in which tolerances are rounded down to the values that the study asks for.
inline constexpr std::string_view kRoundedDown = "rounded down";

/// One step of the search for the tolerances.
struct AllocationStage {
  std::string name;            ///< name of the stage: "linear", "tried on machines", "scaled to the yield", ...
  double cost = 0.0;           ///< total cost at the end of the stage; NaN if the aim has no costs
  double lower_bound = 0.0;    ///< lower bound on the least cost in the optimisation of this stage; NaN if the aim has
                               ///< no costs
  double rms_share = 0.0;      ///< share of each limit that the optimisation of this stage allowed as root mean square
  std::uint64_t machines = 0;  ///< machines tried at the tolerances of this stage; 0: none
  std::uint64_t rejects = 0;   ///< rejects among these machines
};

namespace axis {
using Part = Axis<"part">;                 ///< Parts of the machine.
using Stage = Axis<"stage">;               ///< Stages of the search.
using CurveYield = Axis<"curve_yield">;    ///< Yields at which a cost curve is predicted.
using CurveFactor = Axis<"curve_factor">;  ///< Factors on all limits at which a cost curve is predicted.
}  // namespace axis

/// The result of a study of kind `allocation`; SI units; NaN where undefined. Multiplier, use and saving of a response
/// without a limit are NaN.
struct AllocationResult {
  /// A value for each part.
  template <class T>
  using Parts = Array<T, axis::Part>;
  /// A number for each response and pose.
  using AtPoses = Array<double, axis::Response, axis::Pose>;

  std::vector<std::string> part_names;  ///< names of the parts
  Parts<std::string> part_members;      ///< names of a part's errors, separated by blanks
  Parts<std::string> part_unit;         ///< SI unit of the tolerance T: "m" or "rad"
  Parts<double> tolerance;              ///< tolerance T: the drawing states +-T, or T as the size of a zone
  Parts<double> sigma;                  ///< standard deviation of the errors about their mean
  Parts<double> sigmas;             ///< number of sigma in T: T = shift + sigmas x sigma; for a zone see AllocatedPart
  Parts<double> shift;              ///< offset of the mean, in either direction, in the unit of T
  Parts<double> cost;               ///< cost of the part; NaN if the aim has no costs
  Parts<double> share;              ///< share of the total cost
  Parts<double> mean_square_share;  ///< share of the part in the mean square under the tightest limit; the shares
                                    ///< of all parts add up to 1
  /// mean_square_share divided among the errors: the shares of a part's errors add up to that of the part. NaN for an
  /// error that is in no part.
  Array<double, axis::Factor> error_mean_square_share;
  Parts<std::uint8_t> bound;  ///< AtBound: 0 between bounds, 1 at the lower bound, 2 at the upper bound, 3 a single
                              ///< possible value
  Parts<std::string> chosen;  ///< name of the chosen process or grade, and of the series of numbers to which T is
                              ///< rounded down; empty without these
  /// Predicted share of good machines, among those with which the tolerances were found, if the tolerance of only this
  /// part is 5 % larger, or its next larger possible value; NaN if it cannot be larger.
  Parts<double> coarser_yield;

  /// @name Zones of a drawing: a number or text for each part, or an empty text if the part is not a zone. All arrays
  /// are empty if no part is a zone.
  /// @{
  Parts<std::string> zone_feature;  ///< name of the feature on the drawing: "rail"
  Parts<std::string> zone_limbs;    ///< limbs that share the zone: "1-3"
  Parts<std::string> zone_key;      ///< key of the zone in files: "position"
  Parts<std::string> zone_shape;    ///< shape of the zone: "cylinder", "sphere", "planes", or "interval" for a distance
  Parts<std::string> zone_datums;   ///< datums of the zone: "A|B"
  Parts<double> zone_length;        ///< length of an axis, first side or diameter of a plane (m); NaN: none
  Parts<double> zone_width;         ///< second side of a plane (m); 0: round; NaN: none
  Parts<double> zone_inside;        ///< share of features that are inside the zone
  Parts<std::uint8_t> zone_is_needed;  ///< 0 for a zone of orientation that the drawing does not need, otherwise 1
  /// @}

  AtPoses multiplier;  ///< cost saved per unit by which the limit is wider at only this pose
  AtPoses limit_use;   ///< predicted root mean square, divided by the largest one that the last optimisation allows
  /// The limit, SI. For a limit that is not on a magnitude: the smallest distance, over the poses, from the response of
  /// the mechanism with perfect parts to the nearer end.
  Array<double, axis::Response> limit;
  /// The ends of the limits, SI; infinite if a limit has only one. Empty if all limits are on magnitudes.
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
  /// Share of the mean square that belongs to no part, at the pose where the limit is used most: to the background,
  /// to errors without a part, to noise of measurements and to interactions of errors. Empty in files of version 0.2.
  Array<double, axis::Response> fixed_share;
  Array<double, axis::Response> saving;  ///< cost saved if a limit is one percent wider at all poses, to first order

  Aim aim = Aim::least_cost;  ///< what the study optimised
  double total_cost = 0.0;    ///< cost of all parts; NaN if the aim has no costs
  /// Lower bound on the cost under the last limits on root mean squares; NaN if the aim has no costs.
  double lower_bound = 0.0;
  double gap = 0.0;           ///< upper bound on total_cost minus the least cost; NaN if the aim has no costs
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
  std::size_t poses() const { return limit_use.length<axis::Pose>(); }  ///< The number of poses.
  /// How the certificate's solves ended, summed over poses.
  SolveCounts total() const { return total_of(solves.all()); }
  /// Whether the certificate holds.
  bool certified() const { return certificate.decision == YieldVerdict::Decision::kept; }
};

/// The result of a study of kind `allocation`, read from a file. Precondition: the result is of this kind.
inline const AllocationResult& allocation_of(const StoredResult& result) { return found_of<AllocationResult>(result); }

/// The tables of the result: certificate, parts of the drawing, errors in no part, cost of each limit, and stages of
/// the search.
std::vector<Table> allocation_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
