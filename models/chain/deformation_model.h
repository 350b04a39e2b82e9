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

/// The reported displacement of the platform.
struct PlatformReport {
  std::optional<lie::Vector3<double>> tool = {};  ///< tool point in the platform's frame (m); none: not reported
  /// Points of the platform, in its frame (m). separation() measures the platform's motion by their displacement;
  /// without points there is no separation.
  std::vector<lie::Vector3<double>> points = {};
};

/// A parallel chain as a model. Its responses are the comprehensive deformations of its limbs, the displacement of its
/// platform, or both.
struct DeformationModel {
  ParallelChain chain;            ///< perfect limbs
  std::vector<ErrorTerms> terms;  ///< [F] of each error
  /// Nominal displacements of all joints at a reachable pose, limb by limb (rad, m).
  std::function<std::vector<double>(std::span<const double> pose)> joint_displacements;
  /// Points of the platform, in its frame (m), whose displacement measures mismatch; none: the published weight.
  std::vector<lie::Vector3<double>> points = {};
  std::optional<PlatformReport> platform = {};  ///< none: the deformation is the only response
  /// Points of the platform, in its frame (m). The metric of these points decides which machines cannot be assembled,
  /// whatever metric the solves use; none: the metric of the solves.
  std::vector<lie::Vector3<double>> held_at = {};

  /// The entry to which a term adds.
  FrameEntry entry(const ErrorTerm& term) const;
  /// The reported points at these displacements [all joints] (rad, m); none if only the deformation is reported.
  std::optional<PlatformPoints> platform_points(std::span<const double> displacements) const;
  /// The metric at nominal displacements [all joints] (rad, m); none for the published weight.
  std::optional<Metric> metric(std::span<const double> displacements) const;
  /// The metric of held_at at nominal displacements [all joints] (rad, m); none if there are no such points.
  std::optional<Metric> held(std::span<const double> displacements) const;
};

/// The published responses, in the order in which they are evaluated: angular_deformation (Du et al. 2022, Eq. 49;
/// rad), linear_deformation (Eq. 50; m), deformation_max (Eq. 45). For three limbs, paired in a cycle: to first order
/// delta_mu_21 + delta_mu_32 + delta_mu_13 = 0, so their norms n are the sides of a triangle.
std::vector<Response> deformation_responses();

/// The responses by a metric, root mean squares over the pairs of limbs: gap is that of |delta_mu|_W (m),
/// angular_deformation of |omega| (rad), linear_deformation of |v + omega x o| (m) with o the platform's nominal
/// origin. Each is the norm of a linear function of small errors, so that mean squares are additive over errors.
std::vector<Response> responses_by_metric();

/// The displacement D of the platform under errors, in the base frame and in the order of platform_rows(): x, y, z and
/// position of its origin (m); theta_x, theta_y, theta_z and rotation (rad); tip_x, tip_y, tip_z and tip_position of
/// the tool (m). first: the position of x among the model's responses.
std::vector<Response> platform_responses(const PlatformReport& report, std::size_t first);

/// All responses of a model: first those of the deformation, then those of the platform.
std::vector<Response> responses_of(const DeformationModel& model);

/// The response deformation_max or, by a metric, gap, and the rounding error of its solves (see rounding_level()).
DeformationMeasure deformation_measure(const DeformationModel& model);

/// The largest standard deviation of a response (rad, m) that may be rounding instead of an effect: 4 eps x max(1,
/// reach in m); by a metric 4 eps x reach for lengths, and that divided by the points' distance from their middle for
/// angles. Errors that deform nothing give at most a sixteenth of it, whatever their size.
double effect_rounding(const DeformationModel& model, std::size_t response);

/// One detail per pair of limbs, delta_mu_ki = [omega; v] (Eqs. 30, 46), named with limbs counted from 1.
std::vector<Detail> deformation_details(const ParallelChain& chain);

/// Model::norm_of_details for a response of the deformation [K x 6 pairs]; empty for a response of the platform.
std::vector<double> norm_of_details(const DeformationModel& model, std::size_t response, std::span<const double> pose);

/// The displacements q_i_j of all joints, limb by limb. Limbs i and joints j count from 1.
std::vector<JointDisplacement> joint_displacement_names(const ParallelChain& chain);

/// An evaluator that solves blocks of samples, or maps them to first order. The model must outlive the evaluator.
std::unique_ptr<Evaluator> deformation_evaluator(const DeformationModel& model, const SolverOptions& options,
                                                 Fidelity fidelity = Fidelity::exact);

}  // namespace poesy::chain
