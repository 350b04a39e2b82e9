#include "engine/app/limits.h"

#include <fmt/format.h>

#include <cstdio>

#include "engine/app/message.h"
#include "engine/app/output_width.h"
#include "engine/base/units.h"
#include "engine/report/tables.h"
#include "engine/report/text_table.h"

namespace poesy::app {

ExitCode judge_limits(const StoredResult& result, const std::string& study_path, const std::string& remedy) {
  const std::optional<Table> table = limits_table(result);
  if (!table) return kDone;
  std::fputs(("\n" + text_of(*table, output_width())).c_str(), stdout);
  const LimitVerdicts& verdicts = *verdicts_of(result);
  for (const LimitVerdict& one : verdicts.limits) {
    if (one.passed) continue;
    const NamedUnit& response = result.responses[one.response];
    const Dimension dimension = dimension_of(response.unit);
    say(Message::error,
        fmt::format("{}: {} is {}, above its limit of {}; {}", study_path, response.name,
                    readable_text({one.value, dimension}, 4), readable_text({one.limit, dimension}), remedy));
  }
  return verdicts.passed() ? kDone : kLimitNotKept;
}

StoredResult with_verdicts(const Study& study, const SelectedPoses& poses,
                           const std::optional<LimitVerdicts>& verdicts) {
  StoredResult result;
  for (const PoseCoordinate& coordinate : study.model().pose_coordinates) {
    result.pose_coordinates.push_back({coordinate.name, std::string(si_unit(coordinate.dimension))});
  }
  result.poses = poses.poses;
  result.time = poses.time;
  for (const Response& response : study.model().responses) {
    result.responses.push_back({response.name, std::string(si_unit(response.dimension))});
  }
  for (const ErrorCase& one : study.analysis.cases) result.cases.push_back(one.name);
  result.evaluation.verdicts = verdicts;
  return result;
}

}  // namespace poesy::app
