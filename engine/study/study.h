#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/index.h"
#include "engine/model/catalog.h"
#include "engine/random/distribution.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Which mechanism, with the value of every geometry parameter in the order of its description (SI).
struct MechanismChoice {
  const CatalogEntry* entry = nullptr;  ///< of the catalog, which must outlive the study
  std::vector<double> geometry;         ///< SI, in the order of the description
  std::size_t fidelity = 0;             ///< position among the model's fidelities, 0 where it offers no choice
  Place place;                          ///< of the section, for messages about the geometry as a whole
  /// A second fidelity, solved on the same draws as the first and compared with it.
  std::optional<std::size_t> compared = std::nullopt;
  /// Of the platform's metric; empty: the model's own.
  std::vector<PlatformPoint> points = {};
  Place points_place = {};  ///< for messages about the points
};

/// How each error source is distributed.
struct ErrorModel {
  std::vector<Distribution> by_factor;  ///< [F], for all factors of the model
};

/// Errors held constant while others vary.
struct Background {
  std::vector<FactorIndex> factors;  ///< that are held unless they vary
  double linear = 0.0;               ///< m, for factors that are lengths
  double angular = 0.0;              ///< rad, for factors that are angles
};

/// A fixed set of errors with a name.
struct ErrorCase {
  std::string name;            ///< stands in tables
  std::vector<double> errors;  ///< [F], SI
};

/// The sizes at which identification sets errors.
struct ErrorSize {
  std::string name;  ///< stands in tables
  double linear;     ///< m
  double angular;    ///< rad
};

/// The error from which equal-effect tolerances are counted, and its own tolerance.
struct ToleranceReference {
  FactorIndex factor;  ///< one of those that vary
  double tolerance;    ///< SI
};

/// A group of errors that is judged as one.
struct ErrorSource {
  std::string name;                  ///< stands in tables, joined to others by '+'
  std::vector<FactorIndex> factors;  ///< as the study names them, whatever the pattern leaves of them
};

/// Which errors of a source have its size, and which of these move together.
struct ErrorPattern {
  /// How far a choice of limbs or components goes.
  enum class Choice {
    all,         ///< every one, together
    some,        ///< those that are named, together
    independent  ///< every one, each on its own
  };

  Choice limbs = Choice::all;       ///< which limbs' errors have the size
  std::size_t limb = 0;             ///< for some: it alone; counts from 1
  Choice components = Choice::all;  ///< which components of an error have it
  std::vector<std::string> axes;    ///< for some: "x", "y", "z"; scalars are kept besides
};

/// What a coupling study asks for. See engine/kinds/coupling/coupling.h.
struct CouplingStudy {
  std::vector<double> linear;        ///< [Z] m, sizes of the runs; empty where no error is a length
  std::vector<double> angular;       ///< [Z] rad; empty where no error is an angle
  ErrorPattern pattern;              ///< of every source
  std::vector<ErrorSource> sources;  ///< no factor in two of them

  /// Z.
  std::size_t sizes() const { return linear.empty() ? angular.size() : linear.size(); }
};

/// Samples until the intervals are narrow enough, at the least `min` and at the most Analysis::samples at each pose;
/// see engine/run/rounds.h.
struct AdaptiveSamples {
  std::size_t min = 1000;       ///< before the first decision; rounded up to whole units (engine/study/milestones.h)
  double relative_error = 0.0;  ///< half-width of an interval at conf_level over what it is the interval of
};

/// How far a response may go: its magnitude is good up to this, the limit itself included.
struct ResponseLimit {
  std::size_t response;  ///< position among the model's
  double most;           ///< SI, above zero
};

/// By which number of a Monte Carlo study its limits are judged; see engine/run/verdict.h.
enum class Judge {
  rms,   ///< the response's root mean square over the draws of all poses
  share  ///< what a share of the draws stays within at the worst pose
};

/// What is asked, of which errors.
struct Analysis {
  /// Kinds of studies.
  enum class Kind {
    sensitivity,     ///< the effect of each error on its own
    identification,  ///< which errors deform the mechanism at all
    evaluate,        ///< named cases of fixed errors
    monte_carlo,     ///< all errors vary together
    coupling         ///< error sources of fixed size, one by one and together
  };

  Kind kind = Kind::sensitivity;                   ///< decides which of the members below count
  std::vector<FactorIndex> factors;                ///< that vary, or that are tried; empty for evaluate
  std::size_t samples = 1000;                      ///< sensitivity, Monte Carlo: at each pose
  std::optional<AdaptiveSamples> adaptive;         ///< sensitivity, Monte Carlo; then `samples` is their maximum
  double conf_level = 0.95;                        ///< sensitivity, Monte Carlo
  std::optional<Background> background;            ///< not for identification
  std::optional<ToleranceReference> reference;     ///< sensitivity
  double linearity = 0.01;                         ///< sensitivity at two fidelities: up to this an error is linear
  std::vector<double> quantiles{0.05, 0.5, 0.95};  ///< Monte Carlo: shares of samples below, ascending
  std::vector<ErrorSize> groups;                   ///< identification
  double pose_share = 0.95;                        ///< identification: of the poses that a verdict asks for
  std::vector<ErrorCase> cases;                    ///< evaluate
  CouplingStudy coupling;                          ///< coupling
  std::vector<ResponseLimit> limits;               ///< Monte Carlo, evaluate: in the order of the model's responses
  Judge judge = Judge::rms;                        ///< Monte Carlo: of the limits
  double share = 0.0;                              ///< Monte Carlo, for Judge::share: of the draws at each pose
};

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

  /// Of the mechanism.
  const ModelDescription& model() const { return mechanism.entry->description; }
};

/// Names as written in a study file.
std::string_view name(PoseSelection::Select select);
/// As a study file has it.
std::string_view name(Analysis::Kind kind);
/// Every kind, in the order in which they are listed.
inline constexpr std::array kKinds{Analysis::Kind::sensitivity, Analysis::Kind::identification,
                                   Analysis::Kind::evaluate, Analysis::Kind::monte_carlo, Analysis::Kind::coupling};
/// As a study file has it.
std::string_view name(Judge judge);
/// Every one, in the order in which they are listed.
inline constexpr std::array kJudges{Judge::rms, Judge::share};
/// As a study file has it.
std::string_view name(NotConverged policy);
/// As a study file has it.
std::string_view name(SolverOptions::Method method);

/// The constant errors, [F]: the background's value where it applies, else zero.
std::vector<double> background_errors(const std::optional<Background>& background, const ModelDescription& model);

/// Those of the errors that the study varies, [P], SI.
std::vector<double> standard_deviations(const Study& study);

/// The mechanism at its second fidelity alone. Precondition: it compares two.
MechanismChoice at_compared_fidelity(MechanismChoice mechanism);

/// Builds the study's mechanism. Throws InputError at the mechanism's place when the geometry is impossible.
std::unique_ptr<Model> build_model(const MechanismChoice& mechanism);

}  // namespace poesy
