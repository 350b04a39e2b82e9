#pragma once

#include <any>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/base/index.h"
#include "engine/base/units.h"
#include "engine/base/value_limit.h"
#include "engine/drawing/zone_scatter.h"
#include "engine/model/model.h"
#include "engine/model/own_responses.h"
#include "engine/random/distribution.h"
#include "engine/study/poses/pose_selection.h"
#include "engine/study/table_file.h"

namespace poesy {

/// A mechanism file and its content.
struct MechanismText {
  std::string name;  ///< path of the file as the study states it, relative to the study's folder
  std::string text;  ///< content of the file
  std::shared_ptr<const CatalogEntry> entry;  ///< the catalog entry that was read from the text
};

/// The mechanism of a study, with the value of every geometry parameter.
struct MechanismChoice {
  /// The entry of the catalog, which must outlive the study, or the entry that `file` or `with_responses` owns.
  const CatalogEntry* entry = nullptr;
  std::vector<double> geometry;  ///< values of the geometry parameters, SI, in the order of the model's description
  std::size_t fidelity = 0;      ///< index in the model's list of fidelities; 0 if it offers no choice
  Place place;                   ///< place of the section [mechanism], for messages about the whole geometry
  /// Index of a second fidelity, at which the same draws are solved for comparison; none: draws are solved only once.
  std::optional<std::size_t> compared = std::nullopt;
  /// Points of the platform that define the metric "platform"; empty: the points that the model chooses.
  std::vector<PlatformPoint> points = {};
  Place points_place = {};  ///< place of the key `points`, for messages
  /// The file that describes the mechanism; none for a mechanism of the catalog.
  std::optional<MechanismText> file = std::nullopt;
  std::vector<OwnResponse> responses = {};  ///< responses that the study defines; they follow those of the mechanism
  /// The catalog entry that also has `responses`. `entry` then points to it. Null if the study defines no responses.
  std::shared_ptr<const CatalogEntry> with_responses = nullptr;
  /// True if the responses are those that remain after the best correction by the actuators at each pose
  /// (Model::calibrated_evaluator).
  bool calibrated = false;
  Place calibrated_place = {};  ///< place of the key `calibrated`, for messages
};

/// Correlated errors: a Gaussian copula joins the distributions of the errors.
struct CorrelatedErrors {
  std::vector<FactorIndex> factors;  ///< correlated errors, at least two
  /// [errors x errors] The correlation matrix of the normal scores of the errors, positive definite.
  std::vector<double> correlation;
};

/// The distributions of the errors.
struct ErrorModel {
  std::vector<Distribution> by_factor;  ///< distribution of each factor of the model
  /// How features scatter in their tolerance zones; none: the errors of features have the distribution of other length
  /// errors.
  std::optional<drawing::ZoneScatter> zones = {};
  /// Name of the first feature that has a zone although one of its errors has the distribution of other length errors,
  /// because the study does not state how features scatter in their zones; empty if there is none.
  std::string unused_zone = {};
  std::vector<CorrelatedErrors> correlated = {};  ///< blocks of correlated errors; each factor is in at most one block
  /// Errors that a machine draws anew at each pose, ascending, if draws are Draws::per_machine. A machine draws all
  /// other errors once.
  std::vector<FactorIndex> per_pose = {};
  /// The errors of given machines, which are not drawn: row s of the table is machine s. Errors without a column in the
  /// table are drawn. The column of an error is also its distribution in `by_factor` (Distribution::given).
  std::optional<ErrorTable> machines = {};

  bool is_per_pose(FactorIndex factor) const;  ///< Returns true if a machine draws this error anew at each pose.
};

/// The dimensions that an error can have.
inline constexpr std::array kErrorDimensions{Dimension::length, Dimension::angle, Dimension::number};

/// Errors that are constant while others vary.
struct Background {
  std::vector<FactorIndex> factors;  ///< errors to hold constant; those that the study varies are ignored
  double linear = 0.0;               ///< constant value of errors that are lengths, m
  double angular = 0.0;              ///< constant value of errors that are angles, rad
  double relative = 0.0;             ///< constant value of errors that are numbers, without unit

  /// The constant value of factors of this dimension, SI.
  double of(Dimension dimension) const {
    if (dimension == Dimension::number) return relative;
    return dimension == Dimension::length ? linear : angular;
  }
};

/// The rule of adaptive samples: a study adds samples until intervals are narrow enough. Each cell (one error at one
/// pose) gets from `min` to Analysis::samples samples; see engine/run/rounds.h.
struct AdaptiveSamples {
  std::size_t min = 1000;  ///< samples before the first decision, rounded up by milestones()
  /// Wanted half-width of a confidence interval (level Analysis::conf_level), divided by the magnitude of the estimate.
  double relative_error = 0.0;
};

/// A limit on a response.
struct ResponseLimit {
  std::size_t response;  ///< index in the model's list of responses
  ValueLimit allowed;    ///< range of allowed values, SI
};

/// [responses] The limit of each response, SI. A response for which the study states no limit gets one without bounds.
std::vector<ValueLimit> limits_by_response(std::span<const ResponseLimit> limits, std::size_t responses);

/// Returns true if one of the limits is on the values of a machine at several poses together, such as their spread
/// (ValueLimit::is_over_poses).
bool any_over_poses(std::span<const ResponseLimit> limits);

/// When errors that vary together are drawn.
enum class Draws {
  per_pose,    ///< at each pose, so samples of different poses are independent
  per_machine  ///< once for all poses: sample s is machine s, which has the same errors at every pose
};

/// The statistic that decides whether a response keeps its limit (LimitVerdict in engine/run/result.h).
enum class Judge {
  rms,    ///< root mean square of the response over all draws at all poses
  share,  ///< magnitude that the stated share of the draws does not exceed at the worst pose
  yield   ///< share of machines that keep all limits (ValueLimit::keeps); needs Draws::per_machine
};

struct StudyKind;
struct CalibrationTable;

/// The analysis of a study: what is computed, and from which errors.
struct Analysis {
  const StudyKind* kind = nullptr;  ///< kind of the study; not null in a study that was read
  /// Errors that the study varies, or tries one after the other; empty if another key of this kind of study names them.
  std::vector<FactorIndex> factors;
  std::size_t samples = 1000;  ///< number of samples at each pose, if errors vary
  /// Rule of adaptive samples, with `samples` as the largest number; none: the number of samples is fixed.
  std::optional<AdaptiveSamples> adaptive;
  Draws draws = Draws::per_pose;         ///< when errors are drawn, if they vary together
  double conf_level = 0.95;              ///< confidence level of intervals, if the errors vary
  std::optional<Background> background;  ///< errors that are constant; none: all constant errors are zero
  std::vector<ResponseLimit> limits;     ///< limits on responses, in the order of the model's responses
  /// How a machine is calibrated (engine/study/calibration.h); null: it is not calibrated.
  std::shared_ptr<const CalibrationTable> calibration = nullptr;
  std::any asked;  ///< options that only this kind of study has, read by asked_of(); empty: their defaults
};

/// The options that only the kind of this study has, or their defaults. Precondition: `Options` is the type of these
/// options.
template <class Options>
const Options& asked_of(const Analysis& analysis) {
  static const Options usual{};
  return analysis.asked.has_value() ? std::any_cast<const Options&>(analysis.asked) : usual;
}

/// The options that only the kind of this study has, for changing them. If the analysis has options of another type, or
/// none, they are first set to their defaults.
template <class Options>
Options& asked_of(Analysis& analysis) {
  if (std::any_cast<Options>(&analysis.asked) == nullptr) analysis.asked = Options{};
  return std::any_cast<Options&>(analysis.asked);
}

/// How samples without a solution are treated.
enum class NotConverged {
  exclude,  ///< samples that are not solved are left out of all statistics
  include   ///< the last iterate is used if a solve reached the iteration limit; others are left out
};

/// The content of a study file, complete and consistent. engine/study/study_file.h reads one.
struct Study {
  std::string title;                                   ///< free text
  MechanismChoice mechanism;                           ///< mechanism, with its geometry
  PoseSelection poses;                                 ///< how poses are selected
  ErrorModel errors;                                   ///< distributions of the errors
  Analysis analysis;                                   ///< what is computed
  SolverOptions solver;                                ///< how each sample is solved
  NotConverged not_converged = NotConverged::exclude;  ///< how samples without a solution are treated
  /// The largest allowed share of failed samples, 0 to 1. If more samples fail, the program ends with exit code 5 and
  /// keeps the result.
  double max_not_converged = 1.0;
  std::uint64_t seed = 1;  ///< seed of all draws

  /// Warnings about numbers in the study's files that may be wrong, one line each.
  std::vector<std::string> doubts = {};

  const ModelDescription& model() const { return mechanism.entry->description; }  ///< The description of the mechanism.
};

std::string_view name(PoseSelection::Select select);  ///< The word in a study file for a way to select poses.
std::string_view name(Draws draws);                   ///< The word for this value in a study file.
std::string_view name(Judge judge);                   ///< The word in a study file for a statistic.
/// All values of Judge, in their order.
inline constexpr std::array kJudges{Judge::rms, Judge::share, Judge::yield};
std::string_view name(NotConverged policy);  ///< The word in a study file for the treatment of unsolved samples.
std::string_view name(SolverOptions::Method method);  ///< The word in a study file for a method of the solver.

/// The constant errors, one for each factor of the model, SI: the value of the background for the background's factors,
/// and zero for others.
std::vector<double> background_errors(const std::optional<Background>& background, const ModelDescription& model);

/// The size of errors with this distribution, SI: the largest possible magnitude or, for a normal distribution, the
/// standard deviation plus the magnitude of the mean.
double error_size(const Distribution& distribution);

/// The standard deviations of all errors that the study varies, SI, in the order of Analysis::factors.
std::vector<double> standard_deviations(const Study& study);

/// The mechanism at its second fidelity. Precondition: mechanism.compared has a value.
MechanismChoice at_compared_fidelity(MechanismChoice mechanism);

/// Builds the study's mechanism. Throws InputError at the mechanism's place if the geometry is impossible, at
/// points_place if the points define no metric, and at calibrated_place if the study asks for a calibration that the
/// model does not support.
std::unique_ptr<Model> build_model(const MechanismChoice& mechanism);

/// The name of the model's factor set that has exactly these factors, or "all" for all factors; empty if there is no
/// such set.
std::string set_name(std::span<const FactorIndex> factors, const ModelDescription& model);

/// A clause that explains why an error of this size (SI, any sign) makes no sense: "gives a_x_1 an error of 300 mm, no
/// less than the radius of the base (250 mm)". what: the noun in the clause, here "an error". None if an error of this
/// size makes sense.
std::optional<std::string> beyond_bound(const Model& model, FactorIndex factor, double size, std::string_view what);

/// One line with the constant errors of the background and their size: "held constant: 30 errors of set 'benign' at 1
/// mm and 1 deg". Errors that vary and errors of size zero are left out. Empty if no error remains.
std::string held_errors_text(const Study& study);

/// One line on the errors that a study with limits neither varies nor holds constant, so that they are zero: "left out:
/// 59 of the 65 errors of the mechanism do not vary and are zero: ...". Empty if there are none, if errors do not vary
/// together, if the study states no limit, or if the mechanism is not from a file.
std::string left_out_text(const Study& study);

/// One line that says how the study's machines are calibrated; empty if they are not calibrated.
std::string calibration_text(const Study& study);

}  // namespace poesy
