#include "engine/app/failure_limit.h"

#include <fmt/format.h>

#include "engine/app/message.h"
#include "engine/base/units.h"
#include "engine/report/solves.h"

namespace poesy::app {
namespace {

/// What may solve more samples than these options did.
std::string advice(const SolverOptions& solver) {
  if (solver.method == SolverOptions::Method::gauss_newton) {
    return "take method = \"newton\", or raise solver.max_iterations";
  }
  return fmt::format("study smaller errors, or raise solver.max_iterations above {}", solver.max_iterations);
}

std::string warning_text(const Study& study, double share) {
  const bool many = share > kManyNotConverged;
  return fmt::format("{:.3g} % of the samples did not converge and are left out; {}{}", 100.0 * share,
                     many ? "these are mostly large errors, so what is left may say far too little: " : "",
                     advice(study.solver));
}

}  // namespace

ExitCode judge_failures(const Study& study, const SolveCounts& solves, const std::string& study_path,
                        const std::string& remedy) {
  const std::uint64_t failed = solves.not_converged();
  if (failed == 0) return kDone;
  const double share = static_cast<double>(failed) / static_cast<double>(solves.total());
  if (share > unremarkable_failure_share(study.max_not_converged) && study.not_converged == NotConverged::exclude) {
    say(Message::warning, warning_text(study, share));
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
