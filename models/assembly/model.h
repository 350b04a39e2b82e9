#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/responses.h"
#include "models/chain/deformation_model.h"

namespace poesy::assembly {

/// An assembly as a model: limbs against bodies, whose responses are displacements, mismatch, energy and forces.
struct AssemblyModel {
  Assembly assembly;                     ///< perfect limbs between bodies
  Report report;                         ///< joints whose forces are responses
  std::vector<chain::ErrorTerms> terms;  ///< [F] of each error
  std::vector<std::size_t> ranks;        ///< [limbs] of their passive joints' columns
  std::size_t idle = 0;                  ///< freedoms of passive joints that move no body
  bool deforms = true;                   ///< whether errors may keep limbs and bodies apart, or loads act
  bool over_constrained = true;          ///< whether limbs deform each other
  bool rounded = false;                  ///< whether numbers are, so that perfect limbs fit their bodies almost
  double stiffness = 0.0;                ///< N/m: the largest force that moving a limb's end makes at home
  /// Nominal displacements of all joints at a reachable pose, limb by limb (rad, m).
  std::function<std::vector<double>(std::span<const double> pose)> joint_displacements;

  /// The perfect assembly at a reachable pose. With rounded numbers bodies and joints are where it is in equilibrium.
  Nominal at(std::span<const double> pose) const;
};

/// The twist of the limb's end by what a unit of an error adds to this entry.
Screw term_twist(const AssemblyModel& model, const Nominal& pose, const chain::ErrorTerm& term);

/// G: the twists of limbs' ends by a unit of each error, [6 limbs x F].
Eigen::MatrixXd error_twists(const AssemblyModel& model, const Nominal& pose);

/// All responses of the model.
std::vector<Response> responses_of(const AssemblyModel& model);

/// Solves blocks of samples, or maps them to first order. The model must outlive the evaluator.
std::unique_ptr<Evaluator> assembly_evaluator(const AssemblyModel& model, const SolverOptions& options,
                                              chain::Fidelity fidelity);

/// One solve, step by step. pose: reachable; errors: [F], SI.
SolveTrace assembly_trace(const AssemblyModel& model, std::span<const double> pose, std::span<const double> errors,
                          const SolverOptions& options, chain::Fidelity fidelity);

/// Condition number (2-norm) of what determines bodies and passive joints: of the matrix of B, weighed by the
/// platform's metric and with columns of length 1, without idle freedoms. Infinity where it has lost a rank to
/// rounding.
double condition(const AssemblyModel& model, std::span<const double> pose);

/// The largest force that moving a limb's end by a unit makes in any limb at this pose (N/m).
double largest_stiffness(const AssemblyModel& model, const Nominal& pose);

/// Up to which an error may seem to have an effect on a response, as a standard deviation, because solves round.
double effect_rounding(const AssemblyModel& model, const Response& response);

}  // namespace poesy::assembly
