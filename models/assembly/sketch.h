#pragma once

#include <span>

#include "engine/model/sketch.h"
#include "models/assembly/model.h"

namespace poesy::assembly {

/// Completes a sketch whose joints and bodies are named, at nominal displacements [all joints] (rad, m), as
/// chain::place() does. The sketch of an error contains the motions of all limbs' ends if limbs are paired
/// (AssemblyModel::pairs), else only the motion of the platform in equilibrium.
void place(Sketch& sketch, const AssemblyModel& model, std::span<const double> displacements);

}  // namespace poesy::assembly
