#pragma once

#include <span>

#include "engine/model/sketch.h"
#include "models/assembly/model.h"

namespace poesy::assembly {

/// Puts a sketch whose joints and bodies are named at these nominal displacements [all joints] (rad, m), as
/// chain::place() does. An error has one motion, that of the platform in equilibrium.
void place(Sketch& sketch, const AssemblyModel& model, std::span<const double> displacements);

}  // namespace poesy::assembly
