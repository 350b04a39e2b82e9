// Messages for a search that finds no tolerances within the limits.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/kinds/allocation/in_no_part.h"
#include "engine/kinds/allocation/relative_limits.h"
#include "engine/kinds/allocation/search_stages.h"
#include "engine/report/display.h"
#include "engine/study/limit_keys.h"

namespace poesy::allocation {

namespace {

/// The response and the pose of a row (a limit at a pose), for a message: "gap at pose 12".
std::string row_text(const StudyRun& run, std::size_t row) {
  const std::size_t poses = run.poses.size();
  const ResponseLimit& limit = run.study.analysis.limits[row / poses];
  return fmt::format("{} at pose {}", run.study.model().responses[limit.response].name, row % poses);
}

RelativeLimits stated_limits(const SearchProblem& problem) {
  const Study& study = problem.run.study;
  return {Plan(study, problem.run.poses), problem.run.model, study.analysis.limits,
          problem.calibration_of(study).get()};
}

/// Advice for a user on how parts can get lower tolerances.
std::string finer_parts(const SearchProblem& problem) {
  const bool has_steps =
      std::ranges::any_of(problem.programme.parts(), [](const AllocatedPart& part) { return part.round.has_value(); });
  return std::string("lower the bounds of parts") + (has_steps ? ", or round to finer steps" : "");
}

/// Refuses a study if too many machines are rejected even with perfect parts, because of errors that are in no part.
void refuse_others_alone(const SearchProblem& problem) {
  constexpr std::size_t kMostNamed = 5;
  std::vector<std::string> others;
  for (const UnallocatedError& error : errors_in_no_part(problem.run.study)) others.push_back(error.named.name);
  if (others.empty()) return;
  const std::vector<double> perfect(problem.programme.size(), 0.0);
  const std::uint64_t rejects = rejects_of(loads_of(problem, problem.run.study.seed, perfect));
  if (rejects <= problem.allowed.design) return;
  throw InputError(
      {},
      fmt::format("{} of the machines within the limits cannot be reached: {}errors that are in no part alone reject "
                  "{} of {} machines ({}), and {} may be rejected",
                  percent_text(problem.options.yield), problem.calibration ? "the noise of the calibration and " : "",
                  rejects, problem.run.study.analysis.samples, some_names(others, kMostNamed), problem.allowed.design),
      "no tolerance of a part can help; widen a limit, ask for a smaller yield, make these errors smaller (a play by "
      "a closer fit), or list them as parts");
}

}  // namespace

void refuse_perfect_beyond(const SearchProblem& problem) {
  const Study& study = problem.run.study;
  const PoseSet& poses = problem.run.poses;
  const RelativeLimits limits = stated_limits(problem);
  for (std::size_t row = 0; row < limits.size() * poses.size(); ++row) {
    const ResponseLimit& limit = study.analysis.limits[row / poses.size()];
    const Dimension dimension = study.model().responses[limit.response].dimension;
    const PoseIndex pose(row % poses.size());
    if (limits.room(row / poses.size(), pose) > 0.0) continue;
    throw InputError({},
                     fmt::format("the limit of {} on {} cannot be kept: without the errors of the parts it is {}",
                                 limit_text(limit.allowed, dimension), row_text(problem.run, row),
                                 readable_text({limits.centre(row / poses.size(), pose), dimension}, 4)),
                     "a mechanism whose parts are perfect must be inside the limit; write a limit that holds it, or "
                     "change the background");
  }
}

void refuse_infeasible(const SearchProblem& problem, const Infeasible& infeasible) {
  const Study& study = problem.run.study;
  const PoseSet& poses = problem.run.poses;
  const std::size_t k = infeasible.limit / poses.size();
  const ResponseLimit& limit = study.analysis.limits[k];
  const Response& response = study.model().responses[limit.response];
  const double room = stated_limits(problem).room(k, PoseIndex(infeasible.limit % poses.size()));
  const double fixed = room * room - infeasible.room;  // mean square that no part causes
  const auto text = [&](double square) {
    return readable_text({std::sqrt(std::max(0.0, square)), response.dimension}, 4);
  };
  const std::string stated = limit_text(limit.allowed, [&](double value) {
    return readable_text({value, response.dimension}, 6);
  });
  const std::string row = row_text(problem.run, infeasible.limit);
  const bool noise = problem.calibration.has_value();
  if (infeasible.room <= 0.0) {
    throw InputError(
        {},
        fmt::format("the limit of {} on {} cannot be kept: {}the background and the errors of no part alone "
                    "give a root mean square of {}",
                    stated, row, noise ? "the noise of the calibration, " : "", text(fixed)),
        noise ? "widen the limit, measure more or better, make these errors smaller, or list them as parts"
              : "widen the limit, make these errors smaller, or list them as parts");
  }
  throw InputError({},
                   fmt::format("the limit of {} on {} cannot be kept: with every tolerance at its lowest the root mean "
                               "square is {}",
                               stated, row, text(fixed + infeasible.need)),
                   "widen the limit, or " + finer_parts(problem));
}

void refuse_lowest(const SearchProblem& problem, std::uint64_t rejects) {
  refuse_others_alone(problem);
  throw InputError(
      {},
      fmt::format(
          "{} of the machines within the limits cannot be reached: with every tolerance at its lowest, {} of {} "
          "machines are not within them, and {} may be",
          percent_text(problem.options.yield), rejects, problem.run.study.analysis.samples, problem.allowed.design),
      "widen a limit, ask for a smaller yield, or " + finer_parts(problem));
}

void refuse_perfect(const SearchProblem& problem, std::uint64_t rejects) {
  throw InputError(
      {},
      fmt::format("no tolerances were found with which {} of the machines are within the limits: of the finest that "
                  "were tried, {} of {} machines are not within them, and {} may be",
                  percent_text(problem.options.yield), rejects, problem.run.study.analysis.samples,
                  problem.allowed.design),
      "widen a limit, give the parts bounds, or leave out poses where machines cannot be solved");
}

void refuse_unbounded(const SearchProblem& problem, const Unbounded& unbounded) {
  throw InputError({},
                   fmt::format("part '{}' has no effect on any limit, and no upper bound",
                               problem.programme.parts()[unbounded.parts.front()].name),
                   "give it bounds, or leave it out of the parts");
}

}  // namespace poesy::allocation
