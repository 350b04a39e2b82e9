#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/assembly/model.h"

/// The mismatch between two limbs that lead from the base to the platform. An assembly whose limbs are paired
/// (AssemblyModel::pairs) has the mismatch of each pair as an additional output (Detail in model/model.h).
namespace poesy::assembly {

/// The mismatch delta_mu = [omega; v] of each pair (k, i) of limbs (rad, m), one pair after the other. mismatch: for
/// each limb, xi = log(g T^-1), where g is the pose of the limb's end and T that of the platform. The exact delta_mu is
/// log(g_k g_i^-1); to first order it is xi_k - xi_i.
std::vector<double> pair_mismatch(const AssemblyModel& model, std::span<const Screw> mismatch,
                                  chain::Fidelity fidelity);

/// Model::norm_of_details for a response: the matrix, row by row, that maps the mismatches of all pairs (six columns
/// for each pair) to a vector whose norm is the response. Empty for responses that do not measure mismatch (those from
/// index kDeformations on), and if there are no pairs. To first order the xi of all n limbs add up to 0, so the sum of
/// |xi|^2 over the limbs is the sum of |delta_mu|^2 over all pairs divided by n.
std::vector<double> norm_of_details(const AssemblyModel& model, std::size_t response, std::span<const double> pose);

}  // namespace poesy::assembly
