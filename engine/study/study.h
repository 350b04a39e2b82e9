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

/// A mechanism file, with its content.
struct MechanismText {
  std::string name;                           ///< name in the study, relative to the study's folder
  std::string text;                           ///< content of the file
  std::shared_ptr<const CatalogEntry> entry;  ///< the catalog entry that was read from the text
};

/// The mechanism of a study, with the value of every geometry parameter.
struct MechanismChoice {
  const CatalogEntry* entry = nullptr;  ///< entry of the catalog, which must outlive the study, or an entry that `file`
                                        ///< or `with_responses` owns
  std::vector<double> geometry;  ///< values of the geometry parameters, SI, in the order of the model's description
  std::size_t fidelity = 0;      ///< position among the model's fidelities; 0 if it has only one
  Place place;                   ///< place of the section [mechanism], for messages about the whole geometry
  /// A second fidelity, which is solved with the same draws and compared with the first one; none: only one is solved.
  std::optional<std::size_t> compared = std::nullopt;
  /// The platform's points that define its metric; empty: the model's own points.
  std::vector<PlatformPoint> points = {};
  Place points_place = {};  ///< for messages about the points
  /// The file that describes the mechanism; none for a mechanism of the catalog.
  std::optional<MechanismText> file = std::nullopt;
  std::vector<OwnResponse> responses = {};  ///< responses that the study defines; they follow those of the mechanism
  /// The catalog entry with the study's own responses; null if the study defines none. If it exists, `entry` points to
  /// it.
  std::shared_ptr<const CatalogEntry> with_responses = nullptr;
  /// True if responses are those that remain after the actuators have been corrected as well as possible
  /// (Model::calibrated_evaluator).
  bool calibrated = false;
  Place calibrated_place = {};  ///< place of the key `calibrated`, for messages
};

/// Correlated errors: a Gaussian copula that joins the errors' own distributions.
struct CorrelatedErrors {
  std::vector<FactorIndex> factors;  ///< [k] correlated errors, at least two
  std::vector<double> correlation;   ///< [k x k] correlation matrix of the errors' normal scores, positive definite
};

/// The distributions of the errors.
struct ErrorModel {
  std::vector<Distribution> by_factor;  ///< [F] distribution of each factor of the model
  /// How features scatter in their zones; none: their errors have the distribution of other lengths.
  std::optional<drawing::ZoneScatter> zones = {};
  std::vector<CorrelatedErrors> correlated = {};  ///< blocks of correlated errors; each factor is in at most one block
  /// Errors that a machine draws anew at each pose, ascending, if draws are Draws::per_machine. Its other errors are
  /// drawn once.
  std::vector<FactorIndex> per_pose = {};
  /// The errors of given machines: row s of the table is machine s. Errors that the table lacks are drawn. by_factor
  /// also has the values of its columns, as distributions.
  std::optional<ErrorTable> machines = {};

  bool is_per_pose(FactorIndex factor) const;  ///< Returns true if a machine draws this error anew at each pose.
};

/// The dimensions that an error can have.
inline constexpr std::array kErrorDimensions{Dimension::length, Dimension::angle, Dimension::number};

/// Errors that are constant while others vary.
struct Background {
  std::vector<FactorIndex> factors;  ///< errors that are constant, as long as the study does not vary them
  double linear = 0.0;               ///< m, constant value of errors that are lengths
  double angular = 0.0;              ///< rad, constant value of errors that are angles
  double relative = 0.0;             ///< constant value of errors that are numbers, without unit

  /// The constant value of factors of this dimension, SI.
  double of(Dimension dimension) const {
    if (dimension == Dimension::number) return relative;
    return dimension == Dimension::length ? linear : angular;
  }
};

/// The rule of adaptive samples: a study adds samples until intervals are narrow enough. Each cell gets from `min` to
/// Analysis::samples samples; see engine/run/rounds.h.
struct AdaptiveSamples {
  std::size_t min = 1000;       ///< samples before the first decision; rounded up to whole units (milestones())
  double relative_error = 0.0;  ///< wanted half-width of an interval at level conf_level, relative to the magnitude of
                                ///< the estimated quantity
};

/// A limit on a response.
struct ResponseLimit {
  std::size_t response;  ///< position among the model's responses
  ValueLimit allowed;    ///< range of values that meet the limit, SI
};

/// [R] The limit of each of R responses, SI; a limit without bounds where the study states none. responses: R.
std::vector<ValueLimit> limits_by_response(std::span<const ResponseLimit> limits, std::size_t responses);

/// Returns true if any of the limits is on several poses of a machine together, such as a spread
/// (ValueLimit::is_over_poses).
bool any_over_poses(std::span<const ResponseLimit> limits);

/// When errors that vary together are drawn.
enum class Draws {
  per_pose,    ///< at each pose, so samples of different poses are independent
  per_machine  ///< once for all poses: sample s is machine s, which has the same errors at every pose
};

/// The statistic that is compared with limits; see LimitVerdict.
enum class Judge {
  rms,    ///< root mean square of the response over the draws of all poses
  share,  ///< magnitude of a response that the stated share of the draws does not exceed, at the worst pose
  yield   ///< share of machines that meet all limits at all poses; needs Draws::per_machine
};

struct StudyKind;
struct CalibrationTable;

/// The analysis of a study: what is computed, and from which errors.
struct Analysis {
  const StudyKind* kind = nullptr;   ///< engine/study/study_kind.h; not null in a study that was read
  std::vector<FactorIndex> factors;  ///< errors that vary or are tried; empty if another key of the kind names them
  std::size_t samples = 1000;        ///< number of samples at each pose, if errors vary
  /// Rule of adaptive samples, with `samples` as the maximum; none: a fixed number.
  std::optional<AdaptiveSamples> adaptive;
  Draws draws = Draws::per_pose;         ///< when errors are drawn, if they vary together
  double conf_level = 0.95;              ///< confidence level of intervals, if errors vary
  std::optional<Background> background;  ///< errors that are constant; none: zero
  std::vector<ResponseLimit> limits;     ///< limits on responses, in the order of the model's responses
  /// How a machine is calibrated (engine/study/calibration.h); null: it is not calibrated.
  std::shared_ptr<const CalibrationTable> calibration = nullptr;
  std::any asked;  ///< options that only the study's kind has (asked_of()); empty: their defaults
};

/// The options of the study's kind. Precondition: the kind has options of this type.
template <class Options>
const Options& asked_of(const Analysis& analysis) {
  static const Options usual{};
  return analysis.asked.has_value() ? std::any_cast<const Options&>(analysis.asked) : usual;
}

/// The options of the study's kind, to be changed. Options of another kind are replaced by defaults first.
template <class Options>
Options& asked_of(Analysis& analysis) {
  if (std::any_cast<Options>(&analysis.asked) == nullptr) analysis.asked = Options{};
  return std::any_cast<Options&>(analysis.asked);
}

/// How samples without a solution are treated.
enum class NotConverged {
  exclude,  ///< samples that did not reach their fixed point are left out of all statistics
  include   ///< the last iterate counts as a result, as in the published procedure
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
  /// The share of all samples, 0 to 1, that may fail. Above it the program ends with exit code 5 and keeps the result.
  double max_not_converged = 1.0;
  std::uint64_t seed = 1;  ///< seed of all draws

  /// Lines about numbers in the study's files that may be wrong.
  std::vector<std::string> doubts = {};

  const ModelDescription& model() const { return mechanism.entry->description; }  ///< The description of the mechanism.
};

std::string_view name(PoseSelection::Select select);  ///< The word in a study file for a way to select poses.
std::string_view name(Draws draws);                   ///< The word in a study file for when errors are drawn.
std::string_view name(Judge judge);  ///< The word in a study file for the statistic that is compared with limits.
/// All values of Judge, in their order.
inline constexpr std::array kJudges{Judge::rms, Judge::share, Judge::yield};
std::string_view name(NotConverged policy);  ///< The word in a study file for the treatment of unsolved samples.
std::string_view name(SolverOptions::Method method);  ///< The word in a study file for a method of the solver.

/// [F] The constant errors, SI: the value of the background for its factors, and zero for others.
std::vector<double> background_errors(const std::optional<Background>& background, const ModelDescription& model);

/// The size of errors with this distribution, SI. It is the largest possible magnitude. For a normal distribution,
/// which has none, it is the standard deviation plus the magnitude of the mean.
double error_size(const Distribution& distribution);

/// The standard deviations of all errors that the study varies, SI.
std::vector<double> standard_deviations(const Study& study);

/// The mechanism at its second fidelity. Precondition: mechanism.compared has a value.
MechanismChoice at_compared_fidelity(MechanismChoice mechanism);

/// Builds the study's mechanism. Throws InputError at the mechanism's place if the geometry is impossible, at
/// points_place if the points define no metric, and at calibrated_place if the study asks for a calibration that the
/// model does not support.
std::unique_ptr<Model> build_model(const MechanismChoice& mechanism);

/// The name of the model's factor set that has exactly these factors, or "all" for all factors; empty if no set has
/// them.
std::string set_name(std::span<const FactorIndex> factors, const ModelDescription& model);

/// A clause that explains why an error of this size (SI, any sign) makes no sense: "gives a_x_1 an error of 300 mm, no
/// less than the radius of the base (250 mm)". what: the noun in the clause, here "an error". None if the size makes
/// sense.
std::optional<std::string> beyond_bound(const Model& model, FactorIndex factor, double size, std::string_view what);

/// One line with the constant errors of the background and their size: "held constant: 30 errors of set 'benign' at 1
/// mm and 1 deg". Empty if there are none. Errors that vary are not constant, nor are errors of size zero.
std::string held_errors_text(const Study& study);

/// One line that says that responses are those after calibration; empty if the study calibrates nothing.
std::string calibration_text(const Study& study);

}  // namespace poesy
