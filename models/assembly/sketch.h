#pragma once

#include <span>

#include "engine/model/sketch.h"
#include "models/assembly/model.h"

namespace poesy::assembly {

/// Completes a sketch (the data of a drawing) with named joints and bodies, at nominal displacements [all joints] (rad,
/// m): sets points and axes, frames, and errors, as chain::place() does. For each error, it stores the motions of all
/// limbs' ends if limbs are paired (AssemblyModel::pairs), else only the motion of the platform in equilibrium.
void place(Sketch& sketch, const AssemblyModel& model, std::span<const double> displacements);

}  // namespace poesy::assembly
