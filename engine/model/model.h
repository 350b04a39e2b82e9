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

/// One scalar manufacturing or assembly error of a mechanism. It is zero for a perfect part.
struct Factor {
  std::string name;         ///< name in files, such as "delta_1_0_x"
  Dimension dimension;      ///< length (m), angle (rad) or number
  std::size_t limb;         ///< limb, counted from 1 as in the literature
  std::size_t frame;        ///< index of the limb's frame to which the error belongs, from 0 at the base
  std::string description;  ///< explanation for users
  std::string axis = {};    ///< "x", "y" or "z" if the error is a component of a vector; empty for a scalar
  /// Where the error is and in which direction it acts, if the mechanism's file describes the error in its own words;
  /// otherwise empty.
  std::string place = {};
};

/// A named subset of a model's factors, in the order of the model's list.
struct FactorSet {
  std::string name;                  ///< name in study files
  std::string description;           ///< explanation for users
  std::vector<FactorIndex> factors;  ///< indices of the factors in the model's list, ascending
};

/// A scalar that the model computes for every pose and sample, such as a displacement of the platform.
struct Response {
  std::string name;         ///< name in result files
  Dimension dimension;      ///< length (m), angle (rad), force (N), moment (N m), energy (J) or number
  std::string description;  ///< explanation for users
  /// An upper bound on the ratio of two mean squares of the response: its mean square if all errors act together, over
  /// the sum of its mean squares if each error acts alone. The bound holds to first order and for independent errors of
  /// mean zero. It is 1 if the response is linear in the errors or the norm of a linear function, because mean squares
  /// add in these cases. It is larger if the response is a mean of several norms, or the largest of them.
  double mean_square_bound = 1.0;
  /// If the response is the norm of a vector of responses: indices of the components in the model's list of responses.
  std::vector<std::size_t> components = {};
  /// True if the response is never below zero although it is not the norm of components; an energy is an example.
  bool has_no_sign = false;
  /// True if the response is the difference between its values at two poses of the same machine, or is computed from
  /// such a difference.
  bool is_relative = false;

  /// Returns true if the response is never below zero.
  bool is_magnitude() const { return has_no_sign || !components.empty(); }
};

/// A vector from which the model computes responses, such as a mismatch of two limbs. It is output only if a caller
/// asks for it.
struct Detail {
  std::string name;                     ///< name in result files
  std::vector<std::string> components;  ///< names of the components of the vector
  std::string unit;                     ///< unit of all components, or one for each, such as "rad,rad,rad,m,m,m"
  std::string description;              ///< explanation for users
};

/// A coordinate of the platform's pose.
struct PoseCoordinate {
  std::string name;         ///< name in study files
  Dimension dimension;      ///< length (m), angle (rad) or number
  std::string description;  ///< explanation for users
};

/// Alternative coordinates of a pose, such as those of the tool tip. A chart has as many coordinates as a pose.
struct PoseChart {
  std::string name;                         ///< name in study files, such as "tip"
  std::vector<PoseCoordinate> coordinates;  ///< coordinates, in their order in a point of the chart
  std::string advice;  ///< advice for a message if no pose has the given coordinates, such as "lengthen h, or ..."
};

/// A curve from the literature as a function of time.
struct NamedCurve {
  std::string name;         ///< name in study files
  std::string description;  ///< explanation for users
  std::size_t chart;        ///< chart of the curve: index in ModelDescription::charts
  double start;             ///< time at which the curve begins, s
  double end;               ///< time at which the curve ends, s
  /// The point that is added to every point of the curve, unless a study states another one: chart coordinates, SI.
  std::vector<double> origin;
  /// Returns the point of the curve at a time (s): chart coordinates, SI, relative to `origin`.
  std::function<std::vector<double>(double time)> at;
};

/// The name and dimension of a joint's displacement from the home configuration, for results and for limits of studies.
struct JointDisplacement {
  std::string name;        ///< name in study and result files, such as "q_1_1"
  Dimension dimension;     ///< length (m) or angle (rad)
  bool has_drive = false;  ///< true if a drive moves the joint
};

/// A parameter of the mechanism's geometry, which a study may change.
struct GeometryParameter {
  std::string name;         ///< name in study files
  Dimension dimension;      ///< length (m), angle (rad) or number
  double published;         ///< value in the publication of the mechanism, or in its file, SI
  std::string description;  ///< explanation for users
};

/// The response that shows whether an error deforms the mechanism, instead of only moving the platform as a perfect
/// mechanism moves.
struct DeformationMeasure {
  std::size_t response;  ///< index in the list of responses
  double rounding;       ///< largest value (SI) that the response may have by rounding alone
};

using PlatformPoint = std::array<double, 3>;  ///< A point of the platform in its frame: x, y, z in m.

/// The effect of each error on the platform, to first order at one pose. An effect has a part along the directions that
/// the actuators drive, and a part along the directions that the limbs constrain. All numbers are magnitudes of
/// displacements of the platform, in m per SI unit of the error.
struct Separation {
  std::vector<double> drive;       ///< [factors] part of the effect along the actuated directions
  std::vector<double> constraint;  ///< [factors] part of the effect along the constrained directions
  std::vector<double> effect;      ///< [factors] whole effect
  std::vector<double> residual;    ///< [factors] part that remains after the best correction by the actuators
};

/// How results describe the separated effects (Separation) of errors.
struct SeparationDescription {
  std::string measure;  ///< the displacement that measures an effect, in words: "root mean square displacement of ..."
  /// [factors] The class of each error in the literature, such as "compensable"; an empty text if it has no class
  /// there.
  std::vector<std::string> published;
};

/// The magnitude at which an error stops making sense, such as a dimension of the part that has the error, or half a
/// turn.
struct ErrorBound {
  double size = std::numeric_limits<double>::infinity();  ///< bound on the error's magnitude, SI
  std::string part = {};  ///< what sets the bound, in words: "the length of the rod", "half a turn"
};

/// How a sample is solved: the method of iteration, and the conditions that end the iteration.
struct SolverOptions {
  /// Which iteration solves a sample.
  enum class Method {
    newton,       ///< Newton's method as the model implements it: fast, with a large region of convergence
    gauss_newton  ///< the iteration of the mechanism's publication
  };

  Method method = Method::newton;  ///< iteration to use; models with only one kind of iteration ignore it
  /// A solve has converged when no component of the residual (in some models, of the platform's motion) changes by more
  /// than this in an iteration (rad, m). With the metric "platform", the limit on the changes of bodies and joints is
  /// this number times the mechanism's reach (m). Default 1e-15, Du et al. 2022, Section 5.1; the default of a study is
  /// ModelDescription::tolerance.
  double tolerance = 1e-15;
  int max_iterations = 50;  ///< largest number of iterations; default 50, Du et al. 2022, Section 5.1
  /// True if a study that varies one error at a time may replace solves by certified Chebyshev series
  /// (engine/run/series_model.h).
  bool series = true;
};

/// A factor set that the literature treats as one source of errors.
struct SourceSet {
  std::string name;  ///< short name, such as "FS"; the name of a combination of sources is "FS+..."
  std::string set;   ///< name of the factor set
};

/// The properties of a mechanism that are known without solving it.
struct ModelDescription {
  std::string name;                              ///< name in study files
  std::string title;                             ///< title with its source
  std::vector<GeometryParameter> geometry;       ///< parameters that a study may change
  std::vector<PoseCoordinate> pose_coordinates;  ///< coordinates, in the order of the numbers of a pose
  std::vector<Factor> factors;         ///< all errors; the random numbers of an error depend on its index in this list
  std::vector<FactorSet> factor_sets;  ///< sets that a study may name; a set called "all" has every factor
  std::vector<Feature> features = {};  ///< features of parts, with the tolerances of their drawings
  std::vector<Response> responses;     ///< responses, in the order of OutcomeBlock::responses
  std::optional<DeformationMeasure> deformation;  ///< none if no error deforms the mechanism
  std::vector<Detail> details;  ///< additional outputs; OutcomeBlock::details has their components in this order
  std::vector<JointDisplacement> joints;  ///< all joints, in the order of Model::joint_displacements
  std::vector<double> pose_lower;         ///< lower ends of a reachable workspace, [pose coordinates], SI
  std::vector<double> pose_upper;         ///< upper ends of this workspace, [pose coordinates], SI
  std::string workspace_note;             ///< source of this workspace, for users
  /// Names of the fidelities (accuracies of a solve) that a study may choose, such as "exact" and "first-order"; the
  /// first is the default. Empty: there is no choice.
  std::vector<std::string> fidelities;
  /// How a mismatch of angle is weighed against a mismatch of length. "platform": by the displacement that each causes
  /// at points of the platform. "published": one radian counts as much as one metre, at the base's origin. "stiffness":
  /// by the stiffness of joints, links and limbs. Empty: the responses combine no angles with lengths.
  std::string metric = {};
  double tolerance = SolverOptions().tolerance;     ///< default tolerance of solves
  std::vector<PoseChart> charts;                    ///< alternative coordinates of poses
  std::vector<NamedCurve> curves;                   ///< trajectories of the literature
  std::optional<SeparationDescription> separation;  ///< none: the model does not separate its errors
  std::vector<SourceSet> sources;  ///< default sources of a coupling study; no factor is in two sources
  /// Indices of the responses that the summary of a result shows; empty: all responses.
  std::vector<std::size_t> headline;
  /// The joints of a mechanism from a file, as lines of text for users; empty for other mechanisms.
  std::string structure = {};
  /// Indices of responses with a sign, which the summary of a coupling study shows, because a norm cannot show which
  /// effects cancel. Empty: it shows the responses of `headline`.
  std::vector<std::size_t> signed_headline;

  /// The index of the factor with this name; none if no factor has it.
  std::optional<FactorIndex> find_factor(std::string_view factor_name) const;
  /// The factor set with this name; null if no set has it.
  const FactorSet* find_set(std::string_view set_name) const;
};

/// A block of samples at one pose. Some factors vary and have a value of their own in each sample; the others are
/// constant.
struct SampleBlock {
  std::span<const double> pose;         ///< [pose coordinates], SI
  std::span<const double> errors;       ///< [factors] values of all errors, SI; those of varied factors are ignored
  std::span<const FactorIndex> varied;  ///< factors that vary, each once
  std::span<const double> values;       ///< [varied x samples], row-major: all samples of the first varied factor first
  std::size_t count;                    ///< number of samples
  /// If only one factor varies: most of its values are between -range and +range (SI), so a model may prepare for this
  /// interval. 0: the range is unknown. The range changes an outcome only by rounding. The outcome of a sample never
  /// depends on the other samples.
  double range = 0.0;
  /// The previous pose in the list of a study's poses, SI, for responses that are relative to it; empty if there is
  /// none.
  std::span<const double> previous = {};
};

/// The outcomes of a SampleBlock, which an evaluator writes. The caller owns the memory.
struct OutcomeBlock {
  std::span<double> responses;          ///< [responses x samples], row-major, SI; the last iterate if not converged
  std::span<SolveStatus> status;        ///< [samples] how each solve ended
  std::span<std::uint32_t> iterations;  ///< [samples] iterations of each solve
  /// [components x samples] The components of all additional outputs (Detail); empty if the caller does not want them.
  std::span<double> details;
};

/// Solves samples for one thread, and owns the scratch memory for it. A result depends only on the arguments.
class Evaluator {
 public:
  virtual ~Evaluator() = default;

  /// Solves the samples. A sample that cannot be solved gets a SolveStatus and causes no exception. Preconditions: the
  /// model reaches the pose, and the arrays have the stated shapes.
  virtual void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) = 0;
};

/// A quantity that a trace lists for each iteration of a solve.
struct TraceColumn {
  std::string name;  ///< name of the quantity, such as "largest change"
  std::string unit;  ///< SI unit, or "1"
};

/// One solve by the reference solver of a mechanism, iteration by iteration. An evaluator may reach the same solution
/// in other steps or from another starting point.
struct SolveTrace {
  std::string solver;                ///< solver and starting point, such as "Newton, from ..."
  std::vector<TraceColumn> columns;  ///< quantities that are listed for each iteration
  std::vector<double> rows;  ///< [iterations x columns] values of the quantities, row-major; empty without iterations
  SolveStatus status = SolveStatus::converged;  ///< how the solve ended
  std::uint32_t iterations = 0;                 ///< number of iterations
  std::vector<double> responses;  ///< [responses] responses, SI; those of the last iterate if not converged
};

/// A mechanism with its geometry. The object is immutable and shared by all threads.
class Model {
 public:
  virtual ~Model() = default;

  virtual const ModelDescription& description() const = 0;  ///< The description, constant while the model exists.

  /// The reason why the mechanism cannot reach this pose (SI); empty if it can.
  virtual std::optional<std::string> unreachable(std::span<const double> pose) const = 0;

  /// Nominal displacements of all joints (rad, m), in the order of ModelDescription::joints. Precondition: the pose is
  /// reachable.
  virtual std::vector<double> joint_displacements(std::span<const double> pose) const = 0;

  /// How close the mechanism is to a singular pose: the condition number, without unit and at least 1, of the matrix
  /// that determines the motion of its passive joints, at nominal displacements; infinity at a singular pose.
  /// Precondition: the pose is reachable.
  virtual double condition(std::span<const double> pose) const = 0;

  /// Returns true if the mechanism cannot move between two poses without passing a singular pose: the equations of
  /// passive joints and bodies have determinants of different signs. None if this is not known, for example because the
  /// poses are too far apart. Preconditions: the poses are reachable.
  virtual std::optional<bool> are_separated(std::span<const double> /*one*/, std::span<const double> /*other*/) const {
    return std::nullopt;
  }

  /// An evaluator for one thread. The model must outlive it.
  virtual std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const = 0;

  /// An evaluator like evaluator(), but for the displacement that remains after the best correction by the actuators:
  /// the displacement of the platform under a sample's errors, minus the first-order motion by the actuators that
  /// leaves the smallest displacement in the measure of separation(). Null: the model cannot do this.
  virtual std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& /*options*/) const { return nullptr; }

  /// The iterations of a solve for these errors [factors] at a reachable pose, both SI; none if the model cannot show
  /// them.
  virtual std::optional<SolveTrace> trace(std::span<const double> /*pose*/, std::span<const double> /*errors*/,
                                          const SolverOptions& /*options*/) const {
    return std::nullopt;
  }

  /// The pose with these coordinates of a chart (SI); the mechanism may be unable to reach it. Empty if no pose has
  /// these coordinates.
  virtual std::optional<std::vector<double>> pose_from_chart(std::size_t /*chart*/,
                                                             std::span<const double> /*coordinates*/) const {
    return std::nullopt;
  }

  /// The reason, as a clause, why no pose has these coordinates of a chart (SI). Empty if a pose has them, or if the
  /// model gives no reason.
  virtual std::string no_pose_because(std::size_t /*chart*/, std::span<const double> /*coordinates*/) const {
    return {};
  }

  /// The matrix [K x D], row-major, SI, that maps the D components of the additional outputs
  /// (ModelDescription::details) to a vector with K components whose norm is the response. If the response is a mean of
  /// several norms, or the largest of them, the vector is an approximation: its norm is about as large as the response,
  /// and its mean square is in proportion to the sum of the mean squares of these norms. The matrix is empty if there
  /// is no such vector. Precondition: the model reaches the pose.
  virtual std::vector<double> norm_of_details(std::size_t /*response*/, std::span<const double> /*pose*/) const {
    return {};
  }

  /// The effect of each error at this pose (SI), separated into parts (Separation). Preconditions: the model has
  /// ModelDescription::separation and reaches the pose.
  virtual Separation separation(std::span<const double> /*pose*/) const { return {}; }

  /// The largest standard deviation of a response (SI) that rounding errors of the solves may cause for an error
  /// without effect. The default 0 means that rounding is assumed to be a fixed share of each effect (stats/indices.h).
  virtual double rounding(std::size_t /*response*/) const { return 0.0; }

  /// The largest sensible magnitude of an error; infinite by default.
  virtual ErrorBound error_bound(FactorIndex /*factor*/) const { return {}; }

  /// The points of the platform (platform frame, m) whose displacements the metric "platform" measures, and a
  /// correction of the drives minimises; empty if the model has no such points.
  virtual std::vector<PlatformPoint> metric_points() const { return {}; }

  /// The mobility of the mechanism, as lines of text for users; none if it was not computed.
  virtual std::vector<std::string> mobility() const { return {}; }

  /// Remarks on the model's numbers that a reader of results should know, as sentences; none by default.
  virtual std::vector<std::string> remarks() const { return {}; }

  /// The data for a picture of the mechanism at a reachable pose (SI), or at home if the pose is empty; none if the
  /// model offers no picture.
  virtual std::optional<Sketch> sketch(std::span<const double> /*pose*/) const { return std::nullopt; }

  /// Properties of the geometry or the load that are possible but unusual, so that they may be mistakes. Each is a
  /// clause for a message, such as "the platform (l_A = 800 mm) is larger than the base (l_B = 200 mm)". None by
  /// default.
  virtual std::vector<std::string> unusual_geometry() const { return {}; }

  /// Properties of the errors and of the drawing's zones that are possible but unusual, as clauses like those of
  /// unusual_geometry(). None by default.
  virtual std::vector<std::string> unusual_errors() const { return {}; }

 protected:
  Model() = default;
  /// For derived classes that copy themselves.
  /// @{
  Model(const Model&) = default;
  Model& operator=(const Model&) = default;
  /// @}
};

class StudyValue;  ///< The value of a key in a study or mechanism file (engine/schema/keys_section.h).

/// A mechanism that a study may name.
struct CatalogEntry {
  ModelDescription description;  ///< description, with the published geometry
  /// Builds the mechanism. geometry: values of description.geometry, in that order (SI). fidelity: index in
  /// description.fidelities, 0 if there is no choice. Throws std::invalid_argument, whose text is a clause that names
  /// the parameter and the rule that it breaks.
  std::function<std::unique_ptr<Model>(std::span<const double> geometry, std::size_t fidelity)> build;
  /// The next entry in a linked list of entries for the same mechanism, one for each metric, with the responses of that
  /// metric. Null at the end of the list.
  std::shared_ptr<const CatalogEntry> other_metric = nullptr;
  /// If the description's metric is "platform": builds the mechanism with other points of the platform, at least three
  /// (in the platform's frame, m). Throws std::invalid_argument as build() does.
  std::function<std::unique_ptr<Model>(std::span<const double> geometry, std::size_t fidelity,
                                       std::span<const PlatformPoint> points)>
      build_with_points = nullptr;
  std::string file = {};  ///< path of the file that describes the mechanism; empty for mechanisms of the catalog
  /// For a mechanism from a file: returns the entry of the same mechanism with the loads of another table `[load]`,
  /// linked to entries for all metrics. Throws InputError as Catalog::from_text() does.
  std::function<CatalogEntry(const StudyValue& load)> with_load = nullptr;
  /// The table `[load]` that replaces the table of the file, as TOML; empty: the file's table is used.
  std::string load = {};
};

/// Finds the entry with this metric in the list that begins with `entry` and continues by other_metric. If no entry has
/// this metric, returns the last entry of the list if that entry has no metric at all, and otherwise `entry`.
const CatalogEntry& by_metric(const CatalogEntry& entry, std::string_view metric);

/// The built-in mechanisms, in the order in which they are listed, and the function that reads further mechanisms from
/// files.
struct Catalog : std::vector<CatalogEntry> {
  using vector::vector;
  /// Reads a mechanism from the text of a file; `path` is for messages. Null: files are not supported. Throws
  /// InputError "FILE:LINE:COL: ..." if the text does not describe a mechanism.
  CatalogEntry (*from_text)(const std::string& text, const std::string& path) = nullptr;
  /// Returns the reference of mechanism files, as Markdown.
  std::string (*file_reference)() = nullptr;
};

/// The entry of the mechanism with this name, in upper or lower case. Null if the catalog has no such mechanism.
const CatalogEntry* find(const Catalog& catalog, std::string_view model_name);

}  // namespace poesy
