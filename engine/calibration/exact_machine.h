#pragma once

#include <Eigen/Core>
#include <Eigen/StdVector>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/linalg/decompositions.h"
#include "engine/model/model.h"

/// Exact solves of a machine with errors, which give the displacement of the platform in double precision.
namespace poesy::calibration {

using linalg::Matrix;             ///< a matrix of any size
using linalg::Vector;             ///< a vector of any size
using Matrix3 = Eigen::Matrix3d;  ///< a rotation matrix
using Vector3 = Eigen::Vector3d;  ///< a point or displacement (m), or a rotation vector (rad)

/// The placement of the platform in the base frame.
struct Placement {
  Matrix3 turn;    ///< rotation from the home pose
  Vector3 origin;  ///< platform point P, m
  Vector3 tip;     ///< tool point, m; equal to P if there is no tool
};

/// The displacement of the platform from its nominal placement at a commanded pose, in the base frame.
struct Displacement {
  Matrix3 turn;   ///< rotation about P
  Vector3 moved;  ///< displacement of P, m
};

/// The components of a displacement, in this order: rotation vector (rad), displacement of P (m), displacement of the
/// tool point (m).
inline constexpr std::array<std::string_view, 9> kComponents{"theta_x", "theta_y", "theta_z", "x",    "y",
                                                             "z",       "tip_x",   "tip_y",   "tip_z"};
using Components = Eigen::Matrix<double, 9, 1>;  ///< values in the order of kComponents, SI

/// Computes the components of a displacement. nominal: placement of the perfect mechanism at the commanded pose.
Components components(const Displacement& displacement, const Placement& nominal);

/// For a platform that is displaced from the nominal placement `from`, returns its displacement from the nominal
/// placement `to`.
Displacement seen_from(const Displacement& displacement, const Placement& from, const Placement& to);

/// Computes the displacement of a mechanism's platform under given errors. Owns the scratch memory of one thread. The
/// model must outlive this object.
class ExactMachine {
 public:
  /// Throws std::invalid_argument if the model has no responses for the displacement of the platform, or no sketch of
  /// the home pose with a frame of the platform. what() is a clause about the mechanism.
  ExactMachine(const Model& model, const SolverOptions& solver);

  /// The model that is solved: solving_model() of the given model, without responses that a study adds to it.
  const Model& model() const { return *model_; }
  Evaluator& evaluator() { return *evaluator_; }            ///< The evaluator of the model.
  std::size_t errors() const { return no_errors_.size(); }  ///< The number of all errors of the model.
  double reach() const { return reach_; }                   ///< Largest distance between joints and P at home, m.
  std::uint64_t solves() const { return solves_; }          ///< Number of solves so far (sets of errors at a pose).

  /// The nominal placement of the platform, without errors. pose: SI. Precondition: the pose is reachable.
  Placement nominal(std::span<const double> pose) const;

  /// The displacements at a reachable pose for several sets of errors (machines). errors: [all errors x sets], SI. None
  /// for a set that is not solved.
  std::vector<std::optional<Displacement>> displaced(std::span<const double> pose, const Matrix& errors);
  /// The displacement for one set of errors (all errors of the model, SI); none if the machine is not solved.
  std::optional<Displacement> displaced(std::span<const double> pose, const Vector& errors);

 private:
  const Model* model_;
  std::unique_ptr<Evaluator> evaluator_;
  std::array<std::size_t, 6> responses_;  ///< indices of the responses for the first six kComponents
  std::vector<double> no_errors_;
  std::vector<FactorIndex> all_;
  Matrix3 home_;
  double reach_ = 0.0;
  std::uint64_t solves_ = 0;
  bool has_tool_ = false;
};

}  // namespace poesy::calibration
