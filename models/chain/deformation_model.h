#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/chain/block_solver.h"
#include "models/chain/error_terms.h"
#include "models/chain/limb.h"
#include "models/chain/metric.h"

namespace poesy::chain {

/// The points whose displacements describe the motion of the platform.
struct PlatformReport {
  /// Tool point in the platform's frame (m); none if it is not reported.
  std::optional<lie::Vector3<double>> tool = {};
  /// Points of the platform, in its frame (m). separation() measures the motion of the platform by the displacement of
  /// these points. Without points there is no separation.
  std::vector<lie::Vector3<double>> points = {};
};

/// A parallel chain as a model. Its responses are the deformations of its limbs (Du et al. 2022), the displacement of
/// its platform, or both.
struct DeformationModel {
  ParallelChain chain;            ///< limbs without errors, and the pairs of limbs whose platform poses are compared
  std::vector<ErrorTerms> terms;  ///< [errors] terms of each error
  /// Nominal displacements of all joints at a reachable pose, limb by limb (rad, m).
  std::function<std::vector<double>(std::span<const double> pose)> joint_displacements;
  /// Reported displacement of the platform; none if the deformation is the only response.
  std::optional<PlatformReport> platform = {};
  /// Points of the platform, in its frame (m). Their metric decides which machines cannot be assembled. Without points,
  /// 1 rad weighs as much as 1 m in this decision, as published.
  std::vector<lie::Vector3<double>> held_at = {};

  /// The component of a frame's error to which a term adds.
  FrameEntry entry(const ErrorTerm& term) const;
  /// The reported points at nominal displacements [all joints] (rad, m); none if only the deformation is reported.
  std::optional<PlatformPoints> platform_points(std::span<const double> displacements) const;
  /// The metric of held_at at nominal displacements [all joints] (rad, m); none if there are no such points.
  std::optional<Metric> held(std::span<const double> displacements) const;
};

/// The published responses, in the order in which they are evaluated: `angular_deformation` (Du et al. 2022, Eq. 49;
/// rad), `linear_deformation` (Eq. 50; m), `deformation_max` (Eq. 45). The bounds Response::mean_square_bound hold for
/// three limbs paired in a cycle: to first order delta_mu_21 + delta_mu_32 + delta_mu_13 = 0, so the norms of these
/// vectors are the sides of a triangle.
std::vector<Response> deformation_responses();

/// The responses for the displacement D of the platform under errors, in the base frame and in the order of
/// platform_rows(): `x`, `y`, `z` and `position` of its origin (m); `theta_x`, `theta_y`, `theta_z` and `rotation`
/// (rad); `tip_x`, `tip_y`, `tip_z` and `tip_position` of the tool (m). first: index of `x` among the responses of the
/// model.
std::vector<Response> platform_responses(const PlatformReport& report, std::size_t first);

/// All responses of a model: first those of the deformation, then those of the platform.
std::vector<Response> responses_of(const DeformationModel& model);

/// The index of the response `deformation_max`, and the largest value that rounding alone may give it
/// (rounding_level()).
DeformationMeasure deformation_measure(const DeformationModel& model);

/// The largest standard deviation of a response (rad, m) that may be rounding instead of an effect: 4 eps x max(1,
/// reach in m). In tests, errors that deform nothing gave at most a sixteenth of this level at any size that was tried.
double effect_rounding(const DeformationModel& model);

/// An additional output (Detail) for each pair of limbs: the mismatch delta_mu_ki = [omega; v] (Du et al. 2022, Eqs.
/// 30, 46), named with limbs counted from 1.
std::vector<Detail> deformation_details(std::span<const LimbPair> pairs);

/// A block-diagonal matrix, row by row, with the block share x of_pair for each pair of limbs. of_pair: a matrix with 6
/// columns, which is applied to the mismatch of one pair.
std::vector<double> repeated(const Eigen::MatrixXd& of_pair, std::size_t pairs, double share);

/// Model::norm_of_details for a response of the deformation: a matrix with six columns for each pair of limbs, row by
/// row. Empty for a response of the platform.
std::vector<double> norm_of_details(const DeformationModel& model, std::size_t response);

/// The names of the displacements q_i_j of all joints, limb by limb. Limbs i and joints j are counted from 1.
std::vector<JointDisplacement> joint_displacement_names(const ParallelChain& chain);

/// An evaluator that solves blocks of samples exactly or to first order. The model must outlive the evaluator.
std::unique_ptr<Evaluator> deformation_evaluator(const DeformationModel& model, const SolverOptions& options,
                                                 Fidelity fidelity = Fidelity::exact);

}  // namespace poesy::chain
