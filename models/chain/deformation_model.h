#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/chain/block_solver.h"
#include "models/chain/limb.h"
#include "models/chain/metric.h"

namespace poesy::chain {

/// Which entry of which fixed frame's error a factor adds to: entry += scale x error.
struct ErrorSlot {
  std::size_t limb;       ///< counts from 0
  std::size_t frame;      ///< 0 .. joints of the limb
  std::size_t component;  ///< of [omega; v]: 0-2 angular, 3-5 linear
  double scale = 1.0;     ///< without unit
};

/// What of the platform's own displacement is a response.
struct PlatformReport {
  std::optional<lie::Vector3<double>> tool = {};  ///< a point beside the origin, in the platform's frame (m)
  /// Points of the platform, in its frame (m), by whose displacement separation() measures its motion; none: there is
  /// no separation.
  std::vector<lie::Vector3<double>> points = {};
};

/// A parallel chain as a model whose responses are its limbs' comprehensive deformations, the displacement of its
/// platform, or both.
struct DeformationModel {
  ParallelChain chain;           ///< perfect limbs
  std::vector<ErrorSlot> slots;  ///< [F], one per factor
  /// Nominal displacements of all joints at a reachable pose, limb by limb (rad, m).
  std::function<std::vector<double>(std::span<const double> pose)> joint_displacements;
  /// Points of the platform, in its frame (m), by whose displacement mismatch is judged; none: as published.
  std::vector<lie::Vector3<double>> points = {};
  std::optional<PlatformReport> platform = {};  ///< none: only its deformation is a response
  /// Points of the platform, in its frame (m), by whose displacement machines that cannot be assembled are told,
  /// however the solves weigh; none: as the solves weigh.
  std::vector<lie::Vector3<double>> held_at = {};

  /// Where a factor's error is among all frames.
  FrameEntry entry(const ErrorSlot& slot) const;
  /// The platform's points in the report at these displacements; none if only the deformation is reported.
  std::optional<PlatformPoints> platform_points(std::span<const double> displacements) const;
  /// The metric at nominal displacements [all joints]; none for the published metric.
  std::optional<Metric> metric(std::span<const double> displacements) const;
  /// The metric of held_at at nominal displacements [all joints]; none if there are no such points.
  std::optional<Metric> held(std::span<const double> displacements) const;
};

/// The responses of every deformation model as published, in the order in which they are evaluated:
/// angular_deformation (Du et al. 2022, Eq. 49), linear_deformation (Eq. 50), deformation_max (Eq. 45). For three
/// limbs, whose pairs go round: to first order delta_mu_21 + delta_mu_32 + delta_mu_13 = 0, so their norms n are the
/// sides of a triangle.
std::vector<Response> deformation_responses();

/// The responses by a metric, root mean squares over the pairs of limbs: gap of |delta_mu|_W, angular_deformation of
/// |omega|, linear_deformation of |v + omega x o| with o the platform's nominal origin. Each is the norm of something
/// that is linear in small errors, so that their mean squares add.
std::vector<Response> responses_by_metric();

/// The platform's displacement D under errors, in the base frame and in the order of platform_rows(): x, y, z and
/// position of its origin, theta_x, theta_y, theta_z and rotation, tip_x, tip_y, tip_z and tip_position of the tool.
/// first: the position of x among the model's responses.
std::vector<Response> platform_responses(const PlatformReport& report, std::size_t first);

/// All responses of a model: of its deformation, then of its platform.
std::vector<Response> responses_of(const DeformationModel& model);

/// deformation_max or, by a metric, the gap; and the rounding of its solves (see rounding_level()).
DeformationMeasure deformation_measure(const DeformationModel& model);

/// Up to which an error may seem to have an effect on a response, as a standard deviation (rad, m): 4 eps x max(1,
/// reach in m); by a metric 4 eps x reach for lengths, and that over the points' distance from their middle for angles.
/// Errors that deform nothing leave a sixteenth of it at the most, whatever their size.
double effect_rounding(const DeformationModel& model, std::size_t response);

/// One detail per pair of limbs, delta_mu_ki = [omega; v] (Eqs. 30, 46), named with limbs counted from 1.
std::vector<Detail> deformation_details(const ParallelChain& chain);

/// Model::norm_of_details for a response of the deformation, [K x 6 pairs]; empty for responses of the platform.
std::vector<double> norm_of_details(const DeformationModel& model, std::size_t response, std::span<const double> pose);

/// The displacements q_i_j of all joints, limb by limb, limbs and joints counted from 1.
std::vector<JointDisplacement> joint_displacement_names(const ParallelChain& chain);

/// Solves blocks of samples, or maps them to first order. The model must outlive the evaluator.
std::unique_ptr<Evaluator> deformation_evaluator(const DeformationModel& model, const SolverOptions& options,
                                                 Fidelity fidelity = Fidelity::exact);

}  // namespace poesy::chain
