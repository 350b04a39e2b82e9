#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "engine/kinds/sweep/result.h"
#include "engine/kinds/sweep/settings.h"
#include "engine/run/run_options.h"
#include "engine/study/poses/pose_selection.h"
#include "engine/study/study.h"

namespace poesy::sweep {

/// A design of a sweep: the study with other values of some keys, and the poses of this study.
struct SweptDesign {
  std::vector<GivenKey> given;  ///< keys and values that replace those of the study's file
  Study study;                  ///< the study with these values
  SelectedPoses poses;          ///< the poses that this study selects
};

/// Throws InputError, with the path of the study, if these designs cannot be compared: their kind has no figures of
/// merit, or they are of different kinds.
void check_sweep(std::span<const SweptDesign> designs, const std::string& path);

/// Runs the study of each design with the same draws, and compares each design with the first one and with the best
/// one. Returns nothing if the run was stopped. response: the response that figures of merit are about; if empty, the
/// response by which errors are ranked in the first design. options: must have checkpoints, which keep the states of
/// all designs, in order. The result of each design has the same bits as a run of this design alone. begin: is called
/// with the index of each design before its run. Precondition: check_sweep() accepts the designs. Throws InputError if
/// a design does not have the response, or has no figure of merit.
std::optional<Result> run_sweep(std::span<const SweptKey> keys, std::span<const SweptDesign> designs,
                                const std::string& response, const RunOptions& options,
                                const std::function<void(std::size_t)>& begin);

}  // namespace poesy::sweep
