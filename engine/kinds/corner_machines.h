#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "engine/model/model.h"
#include "engine/report/html/page.h"
#include "engine/result/result_file.h"
#include "engine/study/study.h"

namespace poesy {

/// How many of the first machines of a study miss a limit, at the poses of the study and at the corners of its
/// workspace.
struct CornerMachines {
  std::size_t machines;      ///< number of machines that were solved
  std::size_t at_poses;      ///< number of machines that miss a limit at a pose of the study
  std::size_t with_corners;  ///< number of machines that miss a limit at a pose of the study or at a corner

  /// The number of machines that miss a limit at a corner, but at no pose of the study.
  std::size_t only_at_corners() const { return with_corners - at_poses; }
};

/// Solves the first machines of a study, at most 100, at its poses and at the corners of its workspace. A machine
/// misses a limit also if it is not solved. None if the study draws no machines or states no limit, if a limit is on
/// several poses together, if a response is relative to the previous pose, if there are no corners, or if 20 machines
/// would need more than 20 000 solves. model: the mechanism of the study. poses: the poses of the study. corners: those
/// of feasible_corners().
std::optional<CornerMachines> corner_machines(const Study& study, const Model& model, const PoseSet& poses,
                                              const PoseSet& corners);

/// A clause on the machines that miss a limit at a pose of the study, and on those that miss one only at a corner. For
/// the latter it adds how to study the corners.
std::string corners_text(const CornerMachines& found, const ModelDescription& model);

/// Adds to the line "What to do" of a report what its verdict on the limits does not cover: errors that are left out
/// (left_out_text()), poses of the workspace that were rejected, and corners at which further machines miss a limit.
/// model: the mechanism of the study.
void add_not_covered(const Study& study, const Model& model, const StoredResult& result, Page& page);

}  // namespace poesy
