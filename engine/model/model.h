#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/index.h"
#include "engine/base/units.h"
#include "engine/model/sketch.h"
#include "engine/model/status.h"

namespace poesy {

/// One scalar manufacturing or assembly error of a mechanism, zero when the part is perfect.
struct Factor {
  std::string name;         ///< "delta_1_0_x"
  Dimension dimension;      ///< length (m) or angle (rad)
  std::size_t limb;         ///< counts from 1, as in the literature
  std::size_t frame;        ///< of the limb, to which the error belongs; those of one frame may work together
  std::string description;  ///< for people
  std::string axis = {};    ///< "x", "y" or "z" where the error is a component of a vector; empty for a scalar
};

/// A named subset of a model's factors, in the order of the model's list.
struct FactorSet {
  std::string name;                  ///< as a study file has it
  std::string description;           ///< for people
  std::vector<FactorIndex> factors;  ///< positions, ascending
};

/// A scalar that is judged for every (pose, sample).
struct Response {
  std::string name;         ///< as result files have it
  Dimension dimension;      ///< length (m), angle (rad), force (N), moment (N m), energy (J) or number
  std::string description;  ///< for people
  /// To first order, the mean square that independent errors of mean zero give together is at most this times the sum
  /// of the mean squares that each gives alone. 1 where the response is linear in the errors or the norm of something
  /// linear, because there the mean squares add; more where it is a mean or the largest of several norms.
  double mean_square_bound = 1.0;
  /// Where it is the norm of a vector whose components are responses: their positions among the model's.
  std::vector<std::size_t> components = {};
};

/// A vector behind the responses, given only where a caller asks for it.
struct Detail {
  std::string name;                     ///< as result files have it
  std::vector<std::string> components;  ///< their names
  std::string unit;                     ///< "rad,rad,rad,m,m,m" where components differ
  std::string description;              ///< for people
};

/// A coordinate of the platform's pose.
struct PoseCoordinate {
  std::string name;         ///< as a study file has it
  Dimension dimension;      ///< length (m), angle (rad) or number
  std::string description;  ///< for people
};

/// Other coordinates in which a pose may be given, as many as it has: those of the tool tip, for instance.
struct PoseChart {
  std::string name;                         ///< "tip"
  std::vector<PoseCoordinate> coordinates;  ///< in the order in which a pose's numbers stand
  std::string advice;                       ///< what to do where no pose has such coordinates: "lengthen h, or ..."
};

/// A curve of the literature, run through in time.
struct NamedCurve {
  std::string name;         ///< as a study file has it
  std::string description;  ///< for people
  std::size_t chart;        ///< position among the charts
  double start;             ///< s, of the whole curve
  double end;               ///< s
  /// Where the curve's zero stands unless the study says otherwise, [coordinates of the chart], SI.
  std::vector<double> origin;
  /// Chart coordinates at a time (s), SI, relative to an origin that the study chooses.
  std::function<std::vector<double>(double time)> at;
};

/// A joint's displacement from the home configuration.
struct JointDisplacement {
  std::string name;     ///< "q_1_1"
  Dimension dimension;  ///< length (m) or angle (rad)
};

/// A structural parameter that a study may change.
struct GeometryParameter {
  std::string name;         ///< as a study file has it
  Dimension dimension;      ///< length (m), angle (rad) or number
  double published;         ///< SI
  std::string description;  ///< for people
};

/// The response that tells whether anything is deformed at all.
struct DeformationMeasure {
  std::size_t response;  ///< position among the responses
  double rounding;       ///< a value up to this cannot be told from zero, SI
};

using PlatformPoint = std::array<double, 3>;  ///< A point of the platform in its frame: x, y, z in m.

/// What the actuators have to do with each error's effect, to first order at one pose. Lengths by which the platform
/// moves, m per SI unit of the error.
struct Separation {
  std::vector<double> drive;       ///< [F] the part that enters through the actuated directions
  std::vector<double> constraint;  ///< [F] the part that enters through the constrained directions
  std::vector<double> effect;      ///< [F] both together
  std::vector<double> residual;    ///< [F] what the best correction of the actuators leaves of the effect
};

/// How a model that separates its errors does so.
struct SeparationDescription {
  std::string measure;                 ///< what length Separation speaks of
  std::vector<std::string> published;  ///< [F] the literature's class of each error, empty where it gives none
};

/// Errors of this magnitude or more make no sense, for they are as large as the part that they are errors of.
struct ErrorBound {
  double size = std::numeric_limits<double>::infinity();  ///< SI
  std::string part = {};                                  ///< what is of that size: "the length of the rod"
};

/// How a per-sample solve is done.
struct SolverOptions {
  /// Which iteration solves a sample.
  enum class Method {
    newton,       ///< the model's own, fast and far-reaching
    gauss_newton  ///< as published
  };

  Method method = Method::newton;  ///< a model with one iteration takes it for both
  /// A solve has converged once the largest component of the change of the residual is below this (rad, m); by the
  /// platform's metric, once the change's length is below this share of the mechanism's reach. Default 1e-15, Du et al.
  /// 2022, Section 5.1; a study's default is ModelDescription::tolerance.
  double tolerance = 1e-15;
  int max_iterations = 50;  ///< Default 50, Du et al. 2022, Section 5.1.
};

/// A factor set that the literature judges as one source of errors.
struct SourceSet {
  std::string name;  ///< short, for it is joined to others: "FS"
  std::string set;   ///< name of the factor set
};

/// Everything about a mechanism that can be read without solving it.
struct ModelDescription {
  std::string name;                               ///< as written in a study file
  std::string title;                              ///< with the source
  std::vector<GeometryParameter> geometry;        ///< what a study may change
  std::vector<PoseCoordinate> pose_coordinates;   ///< in the order of a pose's numbers
  std::vector<Factor> factors;                    ///< [F] all errors, in the order that numbers draws
  std::vector<FactorSet> factor_sets;             ///< what a study may name; a set called "all" has every factor
  std::vector<Response> responses;                ///< [R]
  std::optional<DeformationMeasure> deformation;  ///< none where errors only move the platform
  std::vector<Detail> details;                    ///< in the order of OutcomeBlock::details
  std::vector<JointDisplacement> joints;          ///< all, in the order of Model::joint_displacements
  std::vector<double> pose_lower;                 ///< a workspace inside reach, [pose coordinates], SI
  std::vector<double> pose_upper;                 ///< its upper ends, likewise
  std::string workspace_note;                     ///< where that workspace comes from
  /// What a study may choose between, from "exact" to "first-order"; the first is the default. Empty: no choice.
  std::vector<std::string> fidelities;
  /// How mismatch of angle is weighed against mismatch of position: "platform", by the displacement of its points, or
  /// "published", radians against metres at the base's origin. Empty: nothing is weighed.
  std::string metric = {};
  double tolerance = SolverOptions().tolerance;     ///< of solves, where a study names none
  std::vector<PoseChart> charts;                    ///< other coordinates of poses
  std::vector<NamedCurve> curves;                   ///< trajectories of the literature
  std::optional<SeparationDescription> separation;  ///< none: the model does not separate its errors
  std::vector<SourceSet> sources;     ///< those of a coupling study that names none; no factor in two of them
  std::vector<std::size_t> headline;  ///< positions of the responses that a summary shows; empty: all of them
  /// The joints of a mechanism from a file, as they were understood, in lines for people; empty for the others.
  std::string structure = {};
  /// Those that a summary of coupled sources shows, with signs, for a norm cannot tell what cancels; empty: the
  /// headline.
  std::vector<std::size_t> signed_headline;

  /// Its position; empty where there is none of that name.
  std::optional<FactorIndex> find_factor(std::string_view factor_name) const;
  const FactorSet* find_set(std::string_view set_name) const;  ///< Null where there is none of that name.
};

/// B samples at one pose: F constant errors, of which V take their own value in each sample.
struct SampleBlock {
  std::span<const double> pose;         ///< [pose coordinates], SI
  std::span<const double> errors;       ///< [F], SI; entries of varied factors are ignored
  std::span<const FactorIndex> varied;  ///< [V], no repetition
  std::span<const double> values;       ///< [V x B], row-major: all samples of the first varied factor first
  std::size_t count;                    ///< B
  /// With one varied factor: values beyond +-range are rare, and a model may prepare for those inside. 0: nothing is
  /// known. What a sample gives may depend on this to rounding, and does not depend on the other samples.
  double range = 0.0;
};

/// What a block of samples gives. The caller owns the memory.
struct OutcomeBlock {
  std::span<double> responses;          ///< [R x B], row-major, SI; the last iterate where not converged
  std::span<SolveStatus> status;        ///< [B]
  std::span<std::uint32_t> iterations;  ///< [B]
  std::span<double> details;            ///< empty, or [D x B] with D the components of all details in order
};

/// Solves samples. Owns the scratch of one thread; a result depends on nothing but its arguments.
class Evaluator {
 public:
  virtual ~Evaluator() = default;

  /// Precondition: the model reaches the pose, shapes as stated. Never throws for physics: see SolveStatus.
  virtual void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) = 0;
};

/// A number by which a solver's iteration is judged.
struct TraceColumn {
  std::string name;  ///< "largest change"
  std::string unit;  ///< SI, or "1"
};

/// One solve by a mechanism's plain reference solver, iteration by iteration. An evaluator may come to the same
/// solution in other steps, or start elsewhere.
struct SolveTrace {
  std::string solver;                           ///< which it is, and where it starts: "Newton, from ..."
  std::vector<TraceColumn> columns;             ///< what is shown of each iteration
  std::vector<double> rows;                     ///< [iterations x columns], row-major; empty where nothing is iterated
  SolveStatus status = SolveStatus::converged;  ///< how it ended
  std::uint32_t iterations = 0;                 ///< that it took
  std::vector<double> responses;                ///< [R], SI; the last iterate where not converged
};

/// A mechanism with its geometry: immutable, shared by all threads.
class Model {
 public:
  virtual ~Model() = default;

  virtual const ModelDescription& description() const = 0;  ///< The same for as long as the model lives.

  /// Why the mechanism cannot take this pose (SI); empty when it can.
  virtual std::optional<std::string> unreachable(std::span<const double> pose) const = 0;

  /// Nominal displacements of all joints, limb by limb, base to platform (rad, m).
  /// Precondition: the pose is reachable.
  virtual std::vector<double> joint_displacements(std::span<const double> pose) const = 0;

  /// How close the mechanism is to a singular pose: the condition number, without unit and at least 1, of the matrix
  /// that determines the motion of its passive joints, at nominal displacements; infinity at a singular pose.
  /// Precondition: the pose is reachable.
  virtual double condition(std::span<const double> pose) const = 0;

  /// One for each thread. The model must outlive it.
  virtual std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const = 0;

  /// As evaluator(), but outcomes are those of the displacement that the best correction of the actuators leaves: the
  /// platform's displacement under a sample's errors less that motion by the actuators, to first order at the pose,
  /// with which the least is left of it by the measure of separation(). Null: the model cannot.
  virtual std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& /*options*/) const { return nullptr; }

  /// The solve of these errors [F] at a reachable pose, SI; none: the model does not show it.
  virtual std::optional<SolveTrace> trace(std::span<const double> /*pose*/, std::span<const double> /*errors*/,
                                          const SolverOptions& /*options*/) const {
    return std::nullopt;
  }

  /// The pose with these coordinates of a chart (SI), whether the mechanism reaches it or not; empty when there is
  /// none.
  virtual std::optional<std::vector<double>> pose_from_chart(std::size_t /*chart*/,
                                                             std::span<const double> /*coordinates*/) const {
    return std::nullopt;
  }

  /// Why no pose has these coordinates of a chart (SI), a clause; empty where it has one, or the model says no more.
  virtual std::string no_pose_because(std::size_t /*chart*/, std::span<const double> /*coordinates*/) const {
    return {};
  }

  /// Where a response is the norm of a vector that is linear in the details (ModelDescription::details): the matrix
  /// [K x D] that makes the vector of them, SI. For a mean or the largest of several norms, a vector whose mean square
  /// is in proportion to the sum of theirs, and whose norm is about as large. Empty for other responses. Precondition:
  /// the model reaches the pose.
  virtual std::vector<double> norm_of_details(std::size_t /*response*/, std::span<const double> /*pose*/) const {
    return {};
  }

  /// Precondition: the model separates its errors and reaches the pose.
  virtual Separation separation(std::span<const double> /*pose*/) const { return {}; }

  /// An error may seem to have an effect on a response, as a standard deviation of its samples, up to this (SI),
  /// because solves round. 0 unless a model says otherwise: then rounding is a fixed part of the effect itself.
  virtual double rounding(std::size_t /*response*/) const { return 0.0; }

  /// Infinite unless a model says otherwise.
  virtual ErrorBound error_bound(FactorIndex /*factor*/) const { return {}; }

  /// Points of the platform by which its limbs' mismatch is weighed, in its frame; empty where none are.
  virtual std::vector<PlatformPoint> metric_points() const { return {}; }

  /// How the mechanism can move, in lines for people; none where it was never asked.
  virtual std::vector<std::string> mobility() const { return {}; }

  /// What is to be known of its numbers beside results: sentences for people. None unless a model says otherwise.
  virtual std::vector<std::string> remarks() const { return {}; }

  /// How the mechanism looks at a reachable pose (SI), or without a pose at home; empty where the model has no picture.
  virtual std::optional<Sketch> sketch(std::span<const double> /*pose*/) const { return std::nullopt; }

  /// What of the geometry is possible, but so unusual that it may be a slip; clauses for people: "the platform (l_A =
  /// 800 mm) is larger than the base (l_B = 200 mm)". None unless a model says otherwise.
  virtual std::vector<std::string> unusual_geometry() const { return {}; }

 protected:
  Model() = default;
  /// For models that copy themselves.
  /// @{
  Model(const Model&) = default;
  Model& operator=(const Model&) = default;
  /// @}
};

class StudyValue;  ///< What a key of a file has (engine/schema).

/// A mechanism that a study may name.
struct CatalogEntry {
  ModelDescription description;  ///< with the published geometry
  /// Builds the mechanism from the values of description.geometry, in that order (SI), and the position of a fidelity
  /// among description.fidelities, 0 where there is no choice.
  /// Throws std::invalid_argument with a clause that names the parameter and the rule it breaks.
  std::function<std::unique_ptr<Model>(std::span<const double> geometry, std::size_t fidelity)> build;
  /// The same mechanism by another metric, with responses of its own, which may have another one in turn; null where
  /// there are no more.
  std::shared_ptr<const CatalogEntry> other_metric = nullptr;
  /// Where the description's metric is "platform": builds it with other points of the platform, at least three (its
  /// frame, m). Throws std::invalid_argument as build does.
  std::function<std::unique_ptr<Model>(std::span<const double> geometry, std::size_t fidelity,
                                       std::span<const PlatformPoint> points)>
      build_with_points = nullptr;
  std::string file = {};  ///< path of the file that describes it; empty for those of the catalog
  /// Of a mechanism of a file: the same under the loads of another table `[load]`, by all its metrics. Throws
  /// InputError as Catalog::from_text does.
  std::function<CatalogEntry(const StudyValue& load)> with_load = nullptr;
  std::string load = {};  ///< the keys of that table, as TOML; empty: the loads are the file's
};

/// The entry or one of its other metrics, whichever weighs by this one; else the last of them that weighs nothing, or
/// the entry.
const CatalogEntry& by_metric(const CatalogEntry& entry, std::string_view metric);

/// Mechanisms by name, in the order in which they are listed, and the way to those that somebody describes in a file.
struct Catalog : std::vector<CatalogEntry> {
  using vector::vector;
  /// The mechanism of a file's text; `path` is for messages. Null: there are none from files.
  /// Throws InputError "FILE:LINE:COL: ..." where the text describes no mechanism.
  CatalogEntry (*from_text)(const std::string& text, const std::string& path) = nullptr;
  /// The reference of such files, as Markdown.
  std::string (*file_reference)() = nullptr;
};

/// The entry of that name, in capitals or small letters, or nullptr.
const CatalogEntry* find(const Catalog& catalog, std::string_view model_name);

}  // namespace poesy
