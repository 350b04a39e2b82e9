#include "engine/kinds/result_file.h"

#include <optional>

#include "engine/app/command_line.h"
#include "engine/app/results.h"
#include "engine/app/terminal.h"
#include "engine/kinds/study_file.h"
#include "engine/study/mechanism_doubts.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

int tolerances(const TolerancesOptions& options) {
  const StoredResult result = read_result_with_warning(options.result);
  if (const std::optional<Study> study = study_in(result, registry())) {
    warn_of_mechanism(*study, *build_model(study->mechanism));
    for (const std::string& doubt : workspace_doubts(*study, result.poses)) say(Message::warning, doubt);
  }
  print(set_tolerances(result, options, registry(), output_width()));
  return kDone;
}

}  // namespace

Command& add_tolerances(Command& program) {
  const auto [command, options] =
      program.add_command("tolerances", "tolerances from the indices of a sensitivity result", tolerances);
  command.add_value("result", options.result, "RESULT.h5", "result file")->required();
  command.add_value("--response", options.response, "RESPONSE",
                    "response that the tolerances are for; without it, a message names those of the result");
  command.add_value("--limit", options.limit, "LIMIT",
                    "tolerances that keep the root mean square of the response below this, e.g. \"0.05 mm\"");
  command.add_value("--reference", options.reference, "FACTOR[=TOLERANCE]",
                    "error from which equal effects are counted, with its tolerance; default: the study's");
  command.add_flag("--extrapolate", options.extrapolate,
                   "go on where an index changes with size and its tolerance is of another size than was studied");
  command.add_value("-d,--directory", options.folder, "DIR",
                    "folder for tolerances.csv and the studies that test them; default: RESULT_tolerances, here");
  command.examples = {{"tolerances of equal effect", "poesy tolerances result.h5 --response linear_deformation"},
                      {"that keep the response within a limit",
                       "poesy tolerances result.h5 --response linear_deformation --limit \"0.05 mm\""}};
  return command;
}

}  // namespace poesy::app
