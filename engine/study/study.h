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

/// The file of a mechanism.
struct MechanismText {
  std::string name;                           ///< name in the study, relative to the study's folder
  std::string text;                           ///< content of the file
  std::shared_ptr<const CatalogEntry> entry;  ///< the entry read from the text
};

/// The mechanism of a study, with the value of every geometry parameter.
struct MechanismChoice {
  const CatalogEntry* entry = nullptr;  ///< an entry of the catalog, which must outlive the study, or of `file`
  std::vector<double> geometry;         ///< SI, in the order of the model's description
  std::size_t fidelity = 0;             ///< position among the model's fidelities; 0 if it has only one
  Place place;                          ///< place of the section, for messages about the geometry as a whole
  /// A second fidelity, which is solved with the same draws and compared with the first.
  std::optional<std::size_t> compared = std::nullopt;
  /// The points of the platform's metric; empty: the model's own.
  std::vector<PlatformPoint> points = {};
  Place points_place = {};  ///< for messages about the points
  /// The file that describes the mechanism; none for a mechanism of the catalog.
  std::optional<MechanismText> file = std::nullopt;
  std::vector<OwnResponse> responses = {};  ///< the study's own responses, which follow the mechanism's
  /// The entry with these responses, to which `entry` points; null without any.
  std::shared_ptr<const CatalogEntry> with_responses = nullptr;
  /// Whether responses are those that remain after the best correction of the actuators (Model::calibrated_evaluator).
  bool calibrated = false;
  Place calibrated_place = {};  ///< for messages about the calibration
};

/// Correlated errors: a Gaussian copula over their own distributions.
struct CorrelatedErrors {
  std::vector<FactorIndex> factors;  ///< [k], at least two
  std::vector<double> correlation;   ///< [k x k] correlation matrix of their normal scores, positive definite
};

/// The distributions of the errors.
struct ErrorModel {
  std::vector<Distribution> by_factor;             ///< [F] for all factors of the model
  std::optional<drawing::ZoneScatter> zones = {};  ///< how features scatter in their zones; none: as other lengths
  std::vector<CorrelatedErrors> correlated = {};   ///< no factor is in two of them
  /// Ascending: errors that a machine draws anew at each pose, with Draws::per_machine; its other errors are fixed.
  std::vector<FactorIndex> per_pose = {};
  /// Errors of machines that are given: row s is machine s, whose other errors are drawn. by_factor has the columns.
  std::optional<ErrorTable> machines = {};

  bool is_per_pose(FactorIndex factor) const;  ///< Whether a machine draws this error anew at each pose.
};

/// The dimensions of errors.
inline constexpr std::array kErrorDimensions{Dimension::length, Dimension::angle, Dimension::number};

/// Errors that are constant while others vary.
struct Background {
  std::vector<FactorIndex> factors;  ///< the constant errors, unless they vary
  double linear = 0.0;               ///< m, for factors that are lengths
  double angular = 0.0;              ///< rad, for factors that are angles
  double relative = 0.0;             ///< for factors that are numbers

  /// The value of factors of this dimension.
  double of(Dimension dimension) const {
    if (dimension == Dimension::number) return relative;
    return dimension == Dimension::length ? linear : angular;
  }
};

/// Samples are added until intervals are narrow enough, from `min` to Analysis::samples at each pose; see
/// engine/run/rounds.h.
struct AdaptiveSamples {
  std::size_t min = 1000;       ///< samples before the first decision; rounded up to whole units (milestones())
  double relative_error = 0.0;  ///< wanted half-width of an interval at conf_level, over the magnitude of its quantity
};

/// A limit on a response.
struct ResponseLimit {
  std::size_t response;  ///< position among the model's
  ValueLimit allowed;    ///< the values that it allows, SI
};

/// [R] The limits by response, without a limit where the study states none. responses: their number.
std::vector<ValueLimit> limits_by_response(std::span<const ResponseLimit> limits, std::size_t responses);

/// Whether one of the limits is over the poses of a machine (ValueLimit::is_over_poses).
bool any_over_poses(std::span<const ResponseLimit> limits);

/// When errors that vary together are drawn.
enum class Draws {
  per_pose,    ///< at each pose, so samples of different poses are independent
  per_machine  ///< once for all poses: sample s is machine s, which has the same errors at every pose
};

/// The number by which limits are judged; see LimitVerdict.
enum class Judge {
  rms,    ///< root mean square of the response over the draws of all poses
  share,  ///< magnitude that a share of the draws stays within, at the worst pose
  yield   ///< share of machines within all limits at all poses, for Draws::per_machine
};

struct StudyKind;
struct CalibrationTable;

/// The analysis of a study: what is computed, and with which errors.
struct Analysis {
  const StudyKind* kind = nullptr;   ///< engine/study/study_kind.h; not null in a study that was read
  std::vector<FactorIndex> factors;  ///< errors that vary, or that are tried; empty if the kind names them elsewhere
  std::size_t samples = 1000;        ///< samples at each pose, if errors vary
  std::optional<AdaptiveSamples> adaptive;  ///< adaptive samples, of which `samples` is the maximum
  Draws draws = Draws::per_pose;            ///< for errors that vary together
  double conf_level = 0.95;                 ///< for errors that vary
  std::optional<Background> background;     ///< constant errors
  std::vector<ResponseLimit> limits;        ///< in the order of the model's responses
  /// How a machine is calibrated (engine/study/calibration.h); null: it is not.
  std::shared_ptr<const CalibrationTable> calibration = nullptr;
  std::any asked;  ///< the kind's own options (asked_of()); empty means defaults
};

/// The options of the study's kind. Precondition: the kind has options of this type.
template <class Options>
const Options& asked_of(const Analysis& analysis) {
  static const Options usual{};
  return analysis.asked.has_value() ? std::any_cast<const Options&>(analysis.asked) : usual;
}

/// The same for changes; options of another kind are replaced by defaults.
template <class Options>
Options& asked_of(Analysis& analysis) {
  if (std::any_cast<Options>(&analysis.asked) == nullptr) analysis.asked = Options{};
  return std::any_cast<Options&>(analysis.asked);
}

/// How samples without a solution are treated.
enum class NotConverged {
  exclude,  ///< samples that did not reach their fixed point are left out of all statistics
  include   ///< the last iterate counts, as in the published procedure
};

/// The content of a study file, complete and consistent. engine/study/study_file.h reads one.
struct Study {
  std::string title;                                   ///< free text
  MechanismChoice mechanism;                           ///< the mechanism and its geometry
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

std::string_view name(PoseSelection::Select select);  ///< The word in a study file.
std::string_view name(Draws draws);                   ///< The word in a study file.
std::string_view name(Judge judge);                   ///< The word in a study file.
/// All values, in the order in which they are listed.
inline constexpr std::array kJudges{Judge::rms, Judge::share, Judge::yield};
std::string_view name(NotConverged policy);           ///< The word in a study file.
std::string_view name(SolverOptions::Method method);  ///< The word in a study file.

/// [F] The constant errors: the value of the background, or zero.
std::vector<double> background_errors(const std::optional<Background>& background, const ModelDescription& model);

/// The size of errors with this distribution, SI: the largest possible one, for a normal the standard deviation and the
/// magnitude of its mean.
double error_size(const Distribution& distribution);

std::vector<double> standard_deviations(
    const Study& study);  ///< [P] The standard deviations of the errors that vary, SI.

/// The mechanism at its second fidelity. Precondition: it compares two.
MechanismChoice at_compared_fidelity(MechanismChoice mechanism);

/// Builds the study's mechanism. Throws InputError at the mechanism's place if the geometry is impossible, and at
/// calibrated_place if calibration is wanted but not possible.
std::unique_ptr<Model> build_model(const MechanismChoice& mechanism);

/// The name of the factor set that has these factors, or "all"; empty if there is none.
std::string set_name(std::span<const FactorIndex> factors, const ModelDescription& model);

/// A clause that explains why an error of this size (SI, any sign) makes no sense: "gives a_x_1 an error of 300 mm, no
/// less than the radius of the base (250 mm)", where `what` is "an error". None if it does.
std::optional<std::string> beyond_bound(const Model& model, FactorIndex factor, double size, std::string_view what);

/// One line with the constant errors of the background and their size: "held constant: 30 errors of set 'benign' at 1
/// mm and 1 deg". Empty if there are none. Errors that vary are not constant, nor are errors of size zero.
std::string held_errors_text(const Study& study);

/// One line that says that the responses are those after calibration; empty if they are not.
std::string calibration_text(const Study& study);

}  // namespace poesy
