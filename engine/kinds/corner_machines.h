#pragma once

#include <cstddef>
#include <optional>

#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy {

/// How many of the first machines of a study miss a limit, at the poses of the study and at the corners of its
/// workspace.
struct CornerMachines {
  std::size_t machines;      ///< number of machines that were solved
  std::size_t at_poses;      ///< number of machines that miss a limit at a pose of the study
  std::size_t with_corners;  ///< number of machines that miss a limit at a pose of the study or at a corner
};

/// Solves the first machines of a study, at most 100, at its poses and at the corners of its workspace. A machine
/// misses a limit also if it is not solved. None if the study draws no machines or states no limit, if a limit is on
/// several poses together, if a response is relative to the previous pose, if there are no corners, or if 20 machines
/// would need more than 20 000 solves. model: the mechanism of the study. poses: the poses of the study. corners: those
/// of feasible_corners().
std::optional<CornerMachines> corner_machines(const Study& study, const Model& model, const PoseSet& poses,
                                              const PoseSet& corners);

}  // namespace poesy
