#pragma once

#include <Eigen/Core>
#include <Eigen/StdVector>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/linalg/decompositions.h"
#include "engine/model/model.h"

/// Exact solves of a machine with errors, as poses of its platform in plain double numbers.
namespace poesy::calibration {

using linalg::Matrix;             ///< of any size
using linalg::Vector;             ///< of any size
using Matrix3 = Eigen::Matrix3d;  ///< a rotation
using Vector3 = Eigen::Vector3d;  ///< a point or a displacement (m), or a rotation vector (rad)

/// Where the platform is, in the base frame.
struct Placement {
  Matrix3 turn;    ///< rotation from home
  Vector3 origin;  ///< P, m
  Vector3 tip;     ///< point of the tool, m; P if there is no tool
};

/// What moves the platform from its nominal place at a commanded pose, in the base frame.
struct Displacement {
  Matrix3 turn;   ///< rotation about P
  Vector3 moved;  ///< displacement of P, m
};

/// The components of a displacement, in this order: rotation vector (rad), displacement of P (m), of the tool's point
/// (m).
inline constexpr std::array<std::string_view, 9> kComponents{"theta_x", "theta_y", "theta_z", "x",    "y",
                                                             "z",       "tip_x",   "tip_y",   "tip_z"};
using Components = Eigen::Matrix<double, 9, 1>;  ///< [kComponents], SI

/// The displacement's components. nominal: at the commanded pose.
Components components(const Displacement& displacement, const Placement& nominal);

/// The displacement as seen from another pose: `from` is the nominal placement where it was found, `to` the other.
Displacement seen_from(const Displacement& displacement, const Placement& from, const Placement& to);

/// A mechanism whose platform is followed. Owns the scratch of one thread. The model must outlive it.
class ExactMachine {
 public:
  /// Throws std::invalid_argument with a clause if the model does not report the displacement of its platform.
  ExactMachine(const Model& model, const SolverOptions& solver);

  const Model& model() const { return *model_; }            ///< The model.
  std::size_t errors() const { return no_errors_.size(); }  ///< The number of all errors, F.
  double reach() const { return reach_; }                   ///< Largest distance between joints and P at home, m.

  /// Where the platform is without errors. Precondition: the pose is reachable.
  Placement nominal(std::span<const double> pose) const;

  /// The displacements for B sets of errors at a reachable pose, each solved by itself. errors: [F x B], SI. None where
  /// a machine is not solved.
  std::vector<std::optional<Displacement>> displaced(std::span<const double> pose, const Matrix& errors);
  /// The same for one set of errors, [F].
  std::optional<Displacement> displaced(std::span<const double> pose, const Vector& errors);

 private:
  const Model* model_;
  std::unique_ptr<Evaluator> evaluator_;
  std::array<std::size_t, 6> responses_;  ///< positions of the first six components
  std::vector<double> no_errors_;
  std::vector<FactorIndex> all_;
  Matrix3 home_;
  double reach_ = 0.0;
  bool has_tool_ = false;
};

}  // namespace poesy::calibration
