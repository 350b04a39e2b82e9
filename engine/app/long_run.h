#pragma once

#include <atomic>
#include <cstddef>
#include <string>

#include "engine/model/model.h"
#include "engine/study/study.h"

/// The question that the program asks before a run that takes more than a day.
namespace poesy::app {

/// A lower estimate of the duration (s) of `runs` runs of a study, one after the other, with this number of threads. It
/// is 0 if these runs together are clearly shorter than a day, or if there is not enough memory to estimate the
/// duration.
double seconds_of_long_run(const Study& study, const Model& model, const PoseSet& poses, std::size_t threads,
                           std::size_t runs = 1);

/// If the duration `seconds` exceeds kLongRun, asks on the terminal whether to start the run. Returns if the answer is
/// yes, and after an interrupt (`stop`). Otherwise throws InputError with the path of the study.
void ask_about(double seconds, const std::string& study_path, std::size_t threads, const std::atomic<bool>& stop);

}  // namespace poesy::app
