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
#include "engine/model/model.h"
#include "engine/random/distribution.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// A mechanism's file.
struct MechanismText {
  std::string name;                           ///< as the study has it, relative to the study's folder
  std::string text;                           ///< all that stands in it
  std::shared_ptr<const CatalogEntry> entry;  ///< made of the text
};

/// Which mechanism, with the value of every geometry parameter in the order of its description (SI).
struct MechanismChoice {
  const CatalogEntry* entry = nullptr;  ///< of the catalog, which must outlive the study, or of `file`
  std::vector<double> geometry;         ///< SI, in the order of the description
  std::size_t fidelity = 0;             ///< position among the model's fidelities, 0 where it offers no choice
  Place place;                          ///< of the section, for messages about the geometry as a whole
  /// A second fidelity, solved on the same draws as the first and compared with it.
  std::optional<std::size_t> compared = std::nullopt;
  /// Of the platform's metric; empty: the model's own.
  std::vector<PlatformPoint> points = {};
  Place points_place = {};  ///< for messages about the points
  /// Where somebody described the mechanism; nothing for those of the catalog.
  std::optional<MechanismText> file = std::nullopt;
  /// Whether its responses are what the best correction of the actuators leaves (Model::calibrated_evaluator).
  bool calibrated = false;
  Place calibrated_place = {};  ///< for messages about that
};

/// Errors that depend on each other: a Gaussian copula over their own distributions.
struct CorrelatedErrors {
  std::vector<FactorIndex> factors;  ///< [k], at least two
  std::vector<double> correlation;   ///< [k x k] of their normal scores: a correlation matrix, positive definite
};

/// How each error source is distributed.
struct ErrorModel {
  std::vector<Distribution> by_factor;            ///< [F], for all factors of the model
  std::vector<CorrelatedErrors> correlated = {};  ///< a factor is in one of them at the most
};

/// Errors held constant while others vary.
struct Background {
  std::vector<FactorIndex> factors;  ///< that are held unless they vary
  double linear = 0.0;               ///< m, for factors that are lengths
  double angular = 0.0;              ///< rad, for factors that are angles
};

/// Samples until the intervals are narrow enough, at the least `min` and at the most Analysis::samples at each pose;
/// see engine/run/rounds.h.
struct AdaptiveSamples {
  std::size_t min = 1000;       ///< before the first decision; rounded up to whole units (milestones())
  double relative_error = 0.0;  ///< half-width of an interval at conf_level over what it is the interval of
};

/// How far a response may go: its magnitude is good up to this, the limit itself included.
struct ResponseLimit {
  std::size_t response;  ///< position among the model's
  double most;           ///< SI, above zero
};

/// Where errors that vary together are drawn anew.
enum class Draws {
  per_pose,    ///< at each pose: samples of different poses are independent
  per_machine  ///< once for all poses: sample s is machine s, which has the same errors at every pose
};

/// By which number of its draws a study's limits are judged; see LimitVerdict.
enum class Judge {
  rms,    ///< the response's root mean square over the draws of all poses
  share,  ///< what a share of the draws stays within at the worst pose
  yield   ///< the share of machines within all limits at all poses, for Draws::per_machine
};

struct StudyKind;

/// What is asked, of which errors.
struct Analysis {
  const StudyKind* kind = nullptr;          ///< engine/study/study_kind.h; a study that was read has one
  std::vector<FactorIndex> factors;         ///< that vary, or that are tried; empty where others say it
  std::size_t samples = 1000;               ///< of errors that vary: at each pose
  std::optional<AdaptiveSamples> adaptive;  ///< likewise; then `samples` is their maximum
  Draws draws = Draws::per_pose;            ///< of errors that vary together
  double conf_level = 0.95;                 ///< of errors that vary
  std::optional<Background> background;     ///< errors that are held
  std::vector<ResponseLimit> limits;        ///< in the order of the model's responses
  std::any asked;                           ///< what the kind alone asks, see asked_of(); empty: as its defaults are
};

/// What the study's kind alone asks. Precondition: the kind has options of this type.
template <class Options>
const Options& asked_of(const Analysis& analysis) {
  static const Options usual{};
  return analysis.asked.has_value() ? std::any_cast<const Options&>(analysis.asked) : usual;
}

/// The same to be changed; the options of another kind that the study had before are dropped.
template <class Options>
Options& asked_of(Analysis& analysis) {
  if (std::any_cast<Options>(&analysis.asked) == nullptr) analysis.asked = Options{};
  return std::any_cast<Options&>(analysis.asked);
}

/// What becomes of samples without a solution.
enum class NotConverged {
  exclude,  ///< samples that did not reach their fixed point are left out of every statistic
  include   ///< the last iterate counts, as in the published procedure
};

/// What a study file says, complete and consistent. See engine/study/study_file.h for reading one.
struct Study {
  std::string title;                                   ///< free text
  MechanismChoice mechanism;                           ///< which, and its geometry
  PoseSelection poses;                                 ///< which, or how they are found
  ErrorModel errors;                                   ///< how they scatter
  Analysis analysis;                                   ///< what is asked
  SolverOptions solver;                                ///< how samples are solved
  NotConverged not_converged = NotConverged::exclude;  ///< what becomes of samples without a solution
  /// The share of all samples, 0 to 1, that may fail: above it the program ends with exit code 5, the result kept.
  double max_not_converged = 1.0;
  std::uint64_t seed = 1;  ///< of all draws

  /// What a reader of the files that the study names should look at again, a line each.
  std::vector<std::string> doubts = {};

  const ModelDescription& model() const { return mechanism.entry->description; }  ///< Of the mechanism.
};

std::string_view name(PoseSelection::Select select);  ///< As a study file has it.
std::string_view name(Draws draws);                   ///< As a study file has it.
std::string_view name(Judge judge);                   ///< As a study file has it.
/// Every one, in the order in which they are listed.
inline constexpr std::array kJudges{Judge::rms, Judge::share, Judge::yield};
std::string_view name(NotConverged policy);           ///< As a study file has it.
std::string_view name(SolverOptions::Method method);  ///< As a study file has it.

/// The constant errors, [F]: the background's value where it applies, else zero.
std::vector<double> background_errors(const std::optional<Background>& background, const ModelDescription& model);

/// How large errors are that scatter so, SI: the largest one that is possible, of a normal the standard deviation.
double error_size(const Distribution& distribution);

std::vector<double> standard_deviations(const Study& study);  ///< Those of the errors that the study varies, [P], SI.

/// The mechanism at its second fidelity alone. Precondition: it compares two.
MechanismChoice at_compared_fidelity(MechanismChoice mechanism);

/// Builds the study's mechanism. Throws InputError at the mechanism's place when the geometry is impossible, and at
/// calibrated_place when it is to be calibrated and cannot be.
std::unique_ptr<Model> build_model(const MechanismChoice& mechanism);

/// The name of the factor set that these are, or "all"; empty when they are no set.
std::string set_name(std::span<const FactorIndex> factors, const ModelDescription& model);

/// Where an error of this size (SI, its sign does not matter) makes no sense, a clause that says so: "gives a_x_1 an
/// error of 300 mm, no less than the radius of the base (250 mm)"; `what` is "an error".
std::optional<std::string> beyond_bound(const Model& model, FactorIndex factor, double size, std::string_view what);

/// Which errors the study's background holds, at which size, on one line: "held constant: 30 errors of set 'benign' at
/// 1 mm and 1 deg". Empty where it holds none. Errors that vary are not held, nor are those whose size is zero.
std::string held_errors_text(const Study& study);

/// That the study's responses are what calibration leaves, on one line; empty where they are not.
std::string calibration_text(const Study& study);

}  // namespace poesy
