#include "engine/app/failure_limit.h"

#include <fmt/format.h>

#include "engine/app/message.h"
#include "engine/base/units.h"

namespace poesy::app {
namespace {

/// A share of failures above which statistics of the rest mislead.
constexpr double kNoticeable = 0.01;

}  // namespace

ExitCode judge_failures(const Study& study, const SolveCounts& solves, const std::string& study_path,
                        const std::string& remedy) {
  const std::uint64_t failed = solves.not_converged();
  if (failed == 0) return kDone;
  const double share = static_cast<double>(failed) / static_cast<double>(solves.total());
  if (share > kNoticeable && study.not_converged == NotConverged::exclude) {
    say(Message::warning,
        fmt::format("{:.3g} % of the samples did not converge and are left out; these are mostly "
                    "large errors, so what is left may say far too little: raise solver.max_iterations, or take "
                    "method = \"newton\"",
                    100.0 * share));
  }
  if (share <= study.max_not_converged) return kDone;
  say(Message::error,
      fmt::format("{}: {} of {} samples did not converge, a share of {:.3g}, and solver.max_not_converged "
                  "is {}{}; {}",
                  study_path, failed, solves.total(), share, shortest(study.max_not_converged),
                  study.max_not_converged == 0.0 ? " (not_converged = \"fail\" is the same)" : "", remedy));
  return kTooManyNotConverged;
}

}  // namespace poesy::app
