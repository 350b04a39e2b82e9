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
#include "engine/kinds/allocation/it_grade.h"
#include "engine/optimise/cost_law.h"
#include "engine/optimise/least_cost.h"
#include "engine/report/tables.h"
#include "engine/result/result_file.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy {

/// What a tolerance T costs, as a study states it; numbers in SI, so that the text of a study has their every digit.
struct StatedCost {
  /// The law, by its name in a study file.
  enum class Law {
    none,              ///< costs nothing
    reciprocal,        ///< a + b / T
    reciprocal_power,  ///< a + b / T^k
    exponential        ///< a + b exp(-T / tau)
  };
  Law law = Law::none;  ///< which
  double a = 0.0;       ///< what no tolerance saves
  double b = 0.0;       ///< >= 0, in costs times (m or rad)^k, k = 1 but for reciprocal_power; of exponential in costs
  double k = 1.0;       ///< > 0, for reciprocal_power
  double tau = 0.0;     ///< > 0, m or rad, for exponential

  CostLaw cost_law() const;                            ///< The same as a function.
  bool operator==(const StatedCost&) const = default;  ///< Same law and numbers.
};

/// One way to make a part: a process with the tolerances that it holds.
struct StatedProcess {
  std::string name;                                     ///< for people: "turning"
  StatedCost cost = {};                                 ///< over its range
  double lo = 0.0;                                      ///< least tolerance, SI
  double hi = std::numeric_limits<double>::infinity();  ///< largest one
};

/// A part of the drawing: errors that share one tolerance T, written +-T.
struct AllocatedPart {
  /// Of what the tolerance is chosen.
  enum class Choice {
    range,      ///< any value within bounds
    values,     ///< one of a list of values
    grades,     ///< one of the grades of ISO 286-1, at a nominal size: +-T is half the width of the grade's zone
    processes,  ///< any value within the range of one of several processes
    fixed       ///< it is given
  };
  std::string name;                  ///< for people and files
  std::vector<FactorIndex> factors;  ///< of one dimension, at least one
  double sigmas = 3.0;               ///< T = shift T + sigmas x standard deviation
  double shift = 0.0;                ///< the mean is off by this share of T, as often up as down; 0 <= shift < 1
  Choice choice = Choice::range;     ///< which of the following counts
  StatedCost cost = {};              ///< of all but processes
  double lo = 0.0;                   ///< of range; of fixed the value itself. SI
  double hi =
      std::numeric_limits<double>::infinity();  ///< of range; infinity: what the part allows (Model::error_bound)
  std::vector<double> values = {};              ///< of values, ascending
  std::vector<ItGrade> grades = {};             ///< of grades, from the finest one
  double nominal_size = 0.0;                    ///< of grades, m
  std::vector<StatedProcess> processes = {};    ///< of processes
};

/// What tolerances are for, in a study of tolerances.
enum class Aim {
  least_cost,       ///< the least sum of the parts' costs
  equal_effect,     ///< each part uses the same share of the limit that it uses most
  equal_tolerance,  ///< one T for all lengths and one for all angles, in the ratio of their usual sizes in [errors]
  common_factor     ///< the standard deviations of [errors], all times the largest factor that limits allow
};

/// What a study of tolerances alone asks.
struct AllocationOptions {
  std::vector<AllocatedPart> parts;  ///< whose tolerances are wanted; other errors keep their distribution
  Aim aim = Aim::least_cost;         ///< of several that keep the limits, which ones
  double yield = 0.9973;             ///< share of the machines that must be within all limits at all poses
  double confidence = 0.95;          ///< of the certificate
};

std::string_view name(StatedCost::Law law);  ///< As a study file has it.
std::string_view name(Aim aim);              ///< As a study file has it.

/// The kind of study that finds tolerances under limits.
extern const StudyKind kAllocationStudy;

/// One step on the way to the tolerances.
struct AllocationStage {
  std::string name;            ///< for people: "linear", "at these tolerances", "scaled to the yield", ...
  double cost = 0.0;           ///< of all parts; NaN for an aim without costs
  double lower_bound = 0.0;    ///< on the least cost of this stage's programme; NaN likewise
  double rms_share = 0.0;      ///< limit on a root mean square over limit on a value, of this stage
  std::uint64_t machines = 0;  ///< that were tried at these tolerances; 0: none
  std::uint64_t rejects = 0;   ///< of them
};

namespace axis {
using Part = Axis<"part">;                 ///< Parts of the machine.
using Stage = Axis<"stage">;               ///< Stages of the search.
using CurveYield = Axis<"curve_yield">;    ///< Yields of a curve.
using CurveFactor = Axis<"curve_factor">;  ///< Factors of all tolerances of a curve.
}  // namespace axis

/// What a study of tolerances found of the parts of its drawing; SI; NaN where undefined. A response without a limit
/// has no multiplier, no use and no saving: NaN.
struct AllocationResult {
  /// One of each part.
  template <class T>
  using Parts = Array<T, axis::Part>;
  /// A number of each response at each pose.
  using AtPoses = Array<double, axis::Response, axis::Pose>;

  std::vector<std::string> part_names;  ///< of the parts
  Parts<std::string> part_members;      ///< names of a part's errors, with blanks between
  Parts<std::string> part_unit;         ///< "m" or "rad"
  Parts<double> tolerance;              ///< T, the drawing says +-T
  Parts<double> sigma;                  ///< standard deviation about the mean
  Parts<double> sigmas;                 ///< T = shift + sigmas x sigma
  Parts<double> shift;                  ///< by how much the mean is off, as often up as down
  Parts<double> cost;                   ///< NaN for an aim without costs
  Parts<double> share;                  ///< of the cost of all
  Parts<double> mean_square_share;      ///< of what all parts add to the mean square under the tightest limit
  /// The same of each error, whose sum over a part is that of the part; NaN for an error of no part.
  Array<double, axis::Factor> error_mean_square_share;
  Parts<std::uint8_t> bound;  ///< AtBound: 0 between its bounds, 1 at the lower, 2 at the upper, 3 no choice
  Parts<std::string> chosen;  ///< name of the process or grade; empty where there is none
  /// Predicted share of the design's machines that are good if this part alone is made 5 % coarser, or the next coarser
  /// value that can be had; NaN where nothing coarser is allowed.
  Parts<double> coarser_yield;

  AtPoses multiplier;                    ///< what one unit more of the limit at this pose alone would save
  AtPoses limit_use;                     ///< predicted root mean square over what the tightest limit allows it
  Array<double, axis::Response> limit;   ///< SI
  Array<double, axis::Response> saving;  ///< what a limit wider by one percent at all poses would save, to first order

  Aim aim = Aim::least_cost;  ///< that was asked for
  double total_cost = 0.0;    ///< of all parts; NaN for an aim without costs
  double lower_bound = 0.0;   ///< no tolerances cost less under the last limits on root mean squares; NaN likewise
  double gap = 0.0;           ///< by how much the tolerances of these limits may cost too much; NaN likewise
  double wanted_yield = 0.0;  ///< that was asked for
  double confidence = 0.95;   ///< that was asked for

  std::vector<AllocationStage> stages;                     ///< in their order
  Array<double, axis::Stage, axis::Part> stage_tolerance;  ///< T at the end of each
  std::uint64_t design_machines = 0;                       ///< with which the tolerances were found
  std::uint64_t design_rejects = 0;                        ///< of them
  std::uint64_t design_most = 0;                           ///< with so many of them the certificate will probably hold

  std::uint64_t certificate_seed = 0;  ///< of the fresh machines
  std::uint64_t certificate_most = 0;  ///< rejects with which the certificate would hold
  YieldVerdict certificate;            ///< what the fresh machines show; kept: it is certified
  bool calibrated = false;             ///< whether responses are what the best correction of the actuators leaves

  std::vector<double> curve_yield;                     ///< ascending
  Array<double, axis::CurveYield> curve_yield_cost;    ///< predicted cost at these yields
  std::vector<double> curve_factor;                    ///< ascending, of all limits
  Array<double, axis::CurveFactor> curve_factor_cost;  ///< predicted cost with limits wider by this factor

  std::string certificate_study;          ///< text of the study that repeats the certificate
  Array<SolveCounts, axis::Pose> solves;  ///< of the certificate's machines
  std::vector<Failure> failures;          ///< the first of these machines that are not solved

  std::size_t parts() const { return part_names.size(); }                                  ///< Of the drawing.
  std::size_t poses() const { return limit_use.length<axis::Pose>(); }                     ///< Of the study.
  SolveCounts total() const { return total_of(solves.all()); }                             ///< Of the certificate.
  bool certified() const { return certificate.decision == YieldVerdict::Decision::kept; }  ///< Whether it holds.
};

/// What a study of tolerances found, read back. Precondition: a result of that kind.
inline const AllocationResult& allocation_of(const StoredResult& result) { return found_of<AllocationResult>(result); }

/// The certificate, the drawing's table, what each limit costs, and the way to the tolerances.
std::vector<Table> allocation_tables(const StoredResult& result, const TableOptions& options = {});

}  // namespace poesy
