#include "engine/app/long_run.h"

#include <fmt/format.h>

#include <new>

#include "engine/app/expected_time.h"
#include "engine/app/progress.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/kinds/study_run.h"

namespace poesy::app {

double seconds_of_long_run(const Study& study, const Model& model, const PoseSet& poses, std::size_t threads,
                           std::size_t runs) {
  // A run with fewer draws takes less than kLongRun. It makes about one solve for each draw. To take kLongRun on one
  // thread, kFewDraws solves would have to take more than 8 ms each, and solves are much faster.
  constexpr double kFewDraws = 1e7;
  // The first estimate of the duration is rough, because it is measured on single pieces of work. If it is below this
  // limit, the run is surely shorter than kLongRun.
  constexpr double kShort = kLongRun / 4.0;
  constexpr double kTrial = 0.25;  // s, time for each sort of work in the second, more exact measurement
  const double draws = static_cast<double>(runs) * static_cast<double>(study.analysis.samples) *
                       static_cast<double>(poses.size()) * static_cast<double>(study.analysis.factors.size());
  if (draws < kFewDraws) return 0.0;
  try {
    const Outlook expected = outlook(study, model, poses);
    const auto seconds = [&](double trial) {
      return static_cast<double>(runs) * expected_time(expected, threads, trial).least;
    };
    return seconds(0.0) < kShort ? 0.0 : seconds(kTrial);
  } catch (const std::bad_alloc&) {
    return 0.0;  // the run itself will report how much memory it needs
  }
}

void ask_about(double seconds, const std::string& study_path, std::size_t threads, const std::atomic<bool>& stop) {
  if (seconds <= kLongRun) return;
  const std::string text =
      fmt::format("this run takes about {} on {} threads of this machine", readable_duration(seconds), threads);
  if (asked(text + "; start it?").value_or(false) || stop) return;
  throw InputError({study_path}, text, "give --yes to start it all the same, or ask for fewer samples or poses");
}

}  // namespace poesy::app
