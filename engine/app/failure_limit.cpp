#include "engine/app/failure_limit.h"

#include <fmt/format.h>

#include <cstdio>

#include "engine/base/units.h"

namespace poesy::app {

ExitCode judge_failures(const Study& study, const SolveCounts& solves, const std::string& study_path,
                        const std::string& remedy) {
  const std::uint64_t failed = solves.not_converged();
  if (failed == 0) return kDone;
  const double share = static_cast<double>(failed) / static_cast<double>(solves.total());
  if (share <= study.max_not_converged) return kDone;
  std::fputs(
      fmt::format("poesy: {}: {} of {} samples did not converge, a share of {:.3g}, and solver.max_not_converged "
                  "is {}{}; {}\n",
                  study_path, failed, solves.total(), share, shortest(study.max_not_converged),
                  study.max_not_converged == 0.0 ? " (not_converged = \"fail\" is the same)" : "", remedy)
          .c_str(),
      stderr);
  return kTooManyNotConverged;
}

}  // namespace poesy::app
