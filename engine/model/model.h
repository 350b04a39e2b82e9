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
#include "engine/model/feature.h"
#include "engine/model/sketch.h"
#include "engine/model/status.h"

namespace poesy {

/// One scalar manufacturing or assembly error of a mechanism, zero when the part is perfect.
struct Factor {
  std::string name;         ///< "delta_1_0_x"
  Dimension dimension;      ///< length (m) or angle (rad)
  std::size_t limb;         ///< limb, counted from 1 as in the literature
  std::size_t frame;        ///< frame of the limb to which the error belongs; errors of one frame may act together
  std::string description;  ///< for people
  std::string axis = {};    ///< "x", "y" or "z" if the error is a component of a vector; empty for a scalar
};

/// A named subset of a model's factors, in the order of the model's list.
struct FactorSet {
  std::string name;                  ///< name in study files
  std::string description;           ///< for people
  std::vector<FactorIndex> factors;  ///< positions, ascending
};

/// A scalar that is computed for every pose and sample.
struct Response {
  std::string name;         ///< name in result files
  Dimension dimension;      ///< length (m), angle (rad), force (N), moment (N m), energy (J) or number
  std::string description;  ///< for people
  /// The largest factor, to first order, by which the mean square of all errors together exceeds the sum of the mean
  /// squares of each alone, for independent errors of mean zero. It is 1 if the response is linear in the errors or the
  /// norm of a linear function, because mean squares then add, and larger for a mean or the largest of several norms.
  double mean_square_bound = 1.0;
  /// The components, if the response is the norm of a vector of responses: their positions among the model's.
  std::vector<std::size_t> components = {};
  bool has_no_sign = false;  ///< a norm of something else, or an energy
  bool is_relative = false;  ///< whether it depends on another pose of the same machine

  /// Whether it is never below zero.
  bool is_magnitude() const { return has_no_sign || !components.empty(); }
};

/// A vector behind the responses, which is computed only if a caller wants it.
struct Detail {
  std::string name;                     ///< name in result files
  std::vector<std::string> components;  ///< names of its components
  std::string unit;                     ///< unit, or "rad,rad,rad,m,m,m" if components differ
  std::string description;              ///< for people
};

/// A coordinate of the platform's pose.
struct PoseCoordinate {
  std::string name;         ///< name in study files
  Dimension dimension;      ///< length (m), angle (rad) or number
  std::string description;  ///< for people
};

/// Other coordinates of a pose, as many as it has; those of the tool tip, for instance.
struct PoseChart {
  std::string name;                         ///< "tip"
  std::vector<PoseCoordinate> coordinates;  ///< in the order of a pose's numbers
  std::string advice;                       ///< advice if no pose has given coordinates: "lengthen h, or ..."
};

/// A curve from the literature as a function of time.
struct NamedCurve {
  std::string name;         ///< name in study files
  std::string description;  ///< for people
  std::size_t chart;        ///< position among the charts
  double start;             ///< beginning of the whole curve, s
  double end;               ///< end of the whole curve, s
  /// The default point for the curve's zero, [coordinates of the chart], SI.
  std::vector<double> origin;
  /// Chart coordinates at a time (s), SI, relative to the origin.
  std::function<std::vector<double>(double time)> at;
};

/// A joint's displacement from the home configuration.
struct JointDisplacement {
  std::string name;     ///< "q_1_1"
  Dimension dimension;  ///< length (m) or angle (rad)
};

/// A structural parameter that a study may change.
struct GeometryParameter {
  std::string name;         ///< name in study files
  Dimension dimension;      ///< length (m), angle (rad) or number
  double published;         ///< the published value, SI
  std::string description;  ///< for people
};

/// The response that shows whether anything is deformed.
struct DeformationMeasure {
  std::size_t response;  ///< position among the responses
  double rounding;       ///< largest value that may be rounding, SI
};

using PlatformPoint = std::array<double, 3>;  ///< A point of the platform in its frame: x, y, z in m.

/// The effect of each error on the platform, divided by how the actuators are involved, to first order at one pose.
/// Displacements of the platform, m per SI unit of the error.
struct Separation {
  std::vector<double> drive;       ///< [F] the part that enters through the actuated directions
  std::vector<double> constraint;  ///< [F] the part that enters through the constrained directions
  std::vector<double> effect;      ///< [F] both parts together
  std::vector<double> residual;    ///< [F] effect that remains after the best correction of the actuators
};

/// How a model separates its errors.
struct SeparationDescription {
  std::string measure;                 ///< description of the displacement in Separation
  std::vector<std::string> published;  ///< [F] class of each error in the literature; empty if there is none
};

/// The magnitude from which on an error makes no sense, because it is as large as the part to which it belongs.
struct ErrorBound {
  double size = std::numeric_limits<double>::infinity();  ///< SI
  std::string part = {};                                  ///< the dimension of that size: "the length of the rod"
};

/// How each sample is solved.
struct SolverOptions {
  /// The iteration that solves a sample.
  enum class Method {
    newton,       ///< the model's own iteration, fast and with a large region of convergence
    gauss_newton  ///< the published iteration
  };

  Method method = Method::newton;  ///< a model with one iteration uses it for both
  /// A solve has converged when the largest component of the change of the residual is below this (rad, m). By the
  /// platform's metric, the length of the change must be below this share of the mechanism's reach. Default 1e-15, Du
  /// et al. 2022, Section 5.1; the default of a study is ModelDescription::tolerance.
  double tolerance = 1e-15;
  int max_iterations = 50;  ///< Default 50, Du et al. 2022, Section 5.1.
};

/// A factor set that the literature treats as one source of errors.
struct SourceSet {
  std::string name;  ///< short name, which is joined to others: "FS"
  std::string set;   ///< name of the factor set
};

/// The properties of a mechanism that are known without solving it.
struct ModelDescription {
  std::string name;                               ///< name in study files
  std::string title;                              ///< title with its source
  std::vector<GeometryParameter> geometry;        ///< parameters that a study may change
  std::vector<PoseCoordinate> pose_coordinates;   ///< in the order of a pose's numbers
  std::vector<Factor> factors;                    ///< [F] all errors; their order determines the addresses of draws
  std::vector<FactorSet> factor_sets;             ///< sets that a study may name; a set called "all" has every factor
  std::vector<Feature> features = {};             ///< of parts with the tolerances of their drawings
  std::vector<Response> responses;                ///< [R]
  std::optional<DeformationMeasure> deformation;  ///< none if errors only move the platform
  std::vector<Detail> details;                    ///< details, in the order of OutcomeBlock::details
  std::vector<JointDisplacement> joints;          ///< all joints, in the order of Model::joint_displacements
  std::vector<double> pose_lower;                 ///< lower ends of a reachable workspace, [pose coordinates], SI
  std::vector<double> pose_upper;                 ///< upper ends of that workspace, [pose coordinates], SI
  std::string workspace_note;                     ///< source of that workspace
  /// Choices of accuracy, from "exact" to "first-order"; the first is the default. Empty: there is no choice.
  std::vector<std::string> fidelities;
  /// How angles are weighed against lengths: "platform", by the displacement of its points, or "published", radians
  /// against metres at the base's origin. Empty: nothing is weighed.
  std::string metric = {};
  double tolerance = SolverOptions().tolerance;     ///< default tolerance of solves
  std::vector<PoseChart> charts;                    ///< other coordinates of poses
  std::vector<NamedCurve> curves;                   ///< trajectories of the literature
  std::optional<SeparationDescription> separation;  ///< none: the model does not separate its errors
  std::vector<SourceSet> sources;     ///< default sources of a coupling study; no factor is in two of them
  std::vector<std::size_t> headline;  ///< positions of the responses that a summary shows; empty: all of them
  /// The joints of a mechanism from a file as lines for people; empty for other mechanisms.
  std::string structure = {};
  /// The responses with signs that a summary of coupled sources shows, because a norm cannot show what cancels; empty:
  /// the headline.
  std::vector<std::size_t> signed_headline;

  /// The position of the factor; none if there is no factor of that name.
  std::optional<FactorIndex> find_factor(std::string_view factor_name) const;
  const FactorSet* find_set(std::string_view set_name) const;  ///< Null if there is no set of that name.
};

/// B samples at one pose: constant errors of all F factors, of which V have their own value in each sample.
struct SampleBlock {
  std::span<const double> pose;         ///< [pose coordinates], SI
  std::span<const double> errors;       ///< [F], SI; entries of varied factors are ignored
  std::span<const FactorIndex> varied;  ///< [V], no repetition
  std::span<const double> values;       ///< [V x B], row-major: all samples of the first varied factor first
  std::size_t count;                    ///< B
  /// With one varied factor: values beyond +-range are rare, and a model may prepare for those inside. 0: unknown. A
  /// sample's outcome depends on it only by rounding, and not on the other samples.
  double range = 0.0;
  /// The pose before this one in the list of a study's poses, SI, for responses that are relative to it; empty: there
  /// is none.
  std::span<const double> previous = {};
};

/// The outcomes of a block of samples. The caller owns the memory.
struct OutcomeBlock {
  std::span<double> responses;          ///< [R x B], row-major, SI; the last iterate if not converged
  std::span<SolveStatus> status;        ///< [B]
  std::span<std::uint32_t> iterations;  ///< [B]
  std::span<double> details;            ///< empty, or [D x B], where D counts the components of all details in order
};

/// Solves samples. Owns the scratch of one thread. A result depends only on the arguments.
class Evaluator {
 public:
  virtual ~Evaluator() = default;

  /// Preconditions: the model reaches the pose, and shapes are as stated. Never throws for physics: see SolveStatus.
  virtual void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) = 0;
};

/// A number that shows the progress of a solver's iteration.
struct TraceColumn {
  std::string name;  ///< "largest change"
  std::string unit;  ///< SI, or "1"
};

/// One solve by a mechanism's plain reference solver, iteration by iteration. An evaluator may reach the same solution
/// in other steps, or start elsewhere.
struct SolveTrace {
  std::string solver;                           ///< solver and starting point: "Newton, from ..."
  std::vector<TraceColumn> columns;             ///< numbers of each iteration
  std::vector<double> rows;                     ///< [iterations x columns], row-major; empty without iterations
  SolveStatus status = SolveStatus::converged;  ///< how it ended
  std::uint32_t iterations = 0;                 ///< number of iterations
  std::vector<double> responses;                ///< [R], SI; the last iterate if not converged
};

/// A mechanism with its geometry: immutable, shared by all threads.
class Model {
 public:
  virtual ~Model() = default;

  virtual const ModelDescription& description() const = 0;  ///< The description, constant while the model exists.

  /// The reason why the mechanism cannot take this pose (SI); empty if it can.
  virtual std::optional<std::string> unreachable(std::span<const double> pose) const = 0;

  /// Nominal displacements of all joints, limb by limb, base to platform (rad, m).
  /// Precondition: the pose is reachable.
  virtual std::vector<double> joint_displacements(std::span<const double> pose) const = 0;

  /// How close the mechanism is to a singular pose: the condition number, without unit and at least 1, of the matrix
  /// that determines the motion of its passive joints, at nominal displacements; infinity at a singular pose.
  /// Precondition: the pose is reachable.
  virtual double condition(std::span<const double> pose) const = 0;

  /// An evaluator for one thread. The model must outlive it.
  virtual std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const = 0;

  /// The same as evaluator(), but outcomes are those of the displacement that remains after the best correction of the
  /// actuators: the platform's displacement under a sample's errors, less the motion by the actuators, to first order
  /// at the pose, that makes the measure of separation() smallest. Null: the model cannot do this.
  virtual std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& /*options*/) const { return nullptr; }

  /// The solve of these errors [F] at a reachable pose, SI; none if the model does not show it.
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

  /// If a response is the norm of a vector that is linear in the details (ModelDescription::details): the matrix [K x
  /// D] of that vector, SI. If it is a mean or the largest of several norms: the matrix of a vector whose mean square
  /// is in proportion to the sum of their mean squares, and whose norm is about as large. Empty for other responses.
  /// Precondition: the model reaches the pose.
  virtual std::vector<double> norm_of_details(std::size_t /*response*/, std::span<const double> /*pose*/) const {
    return {};
  }

  /// Precondition: the model separates its errors and reaches the pose.
  virtual Separation separation(std::span<const double> /*pose*/) const { return {}; }

  /// An error may seem to have an effect on a response, as a standard deviation of its samples, up to this (SI),
  /// because solves round. 0 unless a model says otherwise: then rounding is a fixed part of the effect itself.
  virtual double rounding(std::size_t /*response*/) const { return 0.0; }

  /// The largest sensible magnitude of an error; infinite by default.
  virtual ErrorBound error_bound(FactorIndex /*factor*/) const { return {}; }

  /// Points of the platform that define its metric, in its frame; empty if there are none.
  virtual std::vector<PlatformPoint> metric_points() const { return {}; }

  /// The mobility of the mechanism, as lines for people; none if it was not computed.
  virtual std::vector<std::string> mobility() const { return {}; }

  /// Remarks on the model's numbers that a reader of results should know, as sentences; none by default.
  virtual std::vector<std::string> remarks() const { return {}; }

  /// A picture of the mechanism at a reachable pose (SI), or at home if the pose is empty; none if the model has no
  /// picture.
  virtual std::optional<Sketch> sketch(std::span<const double> /*pose*/) const { return std::nullopt; }

  /// What is possible but unusual in the geometry, and may be a mistake; clauses for people: "the platform (l_A = 800
  /// mm) is larger than the base (l_B = 200 mm)". None by default.
  virtual std::vector<std::string> unusual_geometry() const { return {}; }

 protected:
  Model() = default;
  /// For models that are copied by their own class.
  /// @{
  Model(const Model&) = default;
  Model& operator=(const Model&) = default;
  /// @}
};

class StudyValue;  ///< A value of a key of a file (engine/schema).

/// A mechanism that a study may name.
struct CatalogEntry {
  ModelDescription description;  ///< description, with the published geometry
  /// Builds the mechanism. geometry: values of description.geometry, in that order (SI). fidelity: position among
  /// description.fidelities, 0 if there is no choice. Throws std::invalid_argument with a clause that names the
  /// parameter and the rule it breaks.
  std::function<std::unique_ptr<Model>(std::span<const double> geometry, std::size_t fidelity)> build;
  /// The same mechanism with another metric and its own responses; it may lead to a further one. Null if there is none.
  std::shared_ptr<const CatalogEntry> other_metric = nullptr;
  /// If the description's metric is "platform": builds the mechanism with other points of the platform, at least three
  /// (in its frame, m). Throws std::invalid_argument as build() does.
  std::function<std::unique_ptr<Model>(std::span<const double> geometry, std::size_t fidelity,
                                       std::span<const PlatformPoint> points)>
      build_with_points = nullptr;
  std::string file = {};  ///< path of the file that describes it; empty for mechanisms of the catalog
  /// For a mechanism from a file: the same with the loads of another table `[load]`, by all its metrics. Throws
  /// InputError as Catalog::from_text() does.
  std::function<CatalogEntry(const StudyValue& load)> with_load = nullptr;
  std::string load = {};  ///< keys of that table, as TOML; empty: the loads are those of the file
};

/// The entry with this metric: the entry itself or one reached by other_metric; otherwise the last of them without a
/// metric, or the entry.
const CatalogEntry& by_metric(const CatalogEntry& entry, std::string_view metric);

/// Mechanisms in the order in which they are listed, and the function that reads further ones from files.
struct Catalog : std::vector<CatalogEntry> {
  using vector::vector;
  /// Reads a mechanism from the text of a file; `path` is for messages. Null: files are not supported. Throws
  /// InputError "FILE:LINE:COL: ..." if the text does not describe a mechanism.
  CatalogEntry (*from_text)(const std::string& text, const std::string& path) = nullptr;
  /// The reference of mechanism files, as Markdown.
  std::string (*file_reference)() = nullptr;
};

/// The entry of that name, in upper or lower case, or nullptr.
const CatalogEntry* find(const Catalog& catalog, std::string_view model_name);

}  // namespace poesy
