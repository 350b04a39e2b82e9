#pragma once

#include <atomic>
#include <cstddef>
#include <string>

#include "engine/model/model.h"
#include "engine/study/study.h"

/// The question that the program asks before a run that takes more than a day.
namespace poesy::app {

/// The smallest expected duration of a run with this number of threads, s. It is 0 if the run is clearly short; the
/// duration is then not measured.
double seconds_of_long_run(const Study& study, const Model& model, const PoseSet& poses, std::size_t threads);

/// Asks on a terminal whether a run of this duration is wanted, if the duration exceeds kLongRun. Throws InputError
/// with the path of the study unless the answer is yes. Returns on an interrupt.
void ask_about(double seconds, const std::string& study_path, std::size_t threads, const std::atomic<bool>& stop);

}  // namespace poesy::app
