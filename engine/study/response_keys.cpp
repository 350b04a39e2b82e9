#include <algorithm>

#include "engine/schema/own_response_keys.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

std::string responses_lines(const Study& study) { return own_responses_text(study.mechanism.responses, study.model()); }

}  // namespace

StudyRow response_row() {
  return {.name = "response",
          .value = {.type = "list of tables"},
          .usual = "none",
          .meaning = "Responses of one's own, [[response]].",
          .lines = responses_lines,
          .late = 1};
}

StudyTables response_tables() { return own_response_tables(); }

void read_responses(Study& study, const Reading& reading) {
  const auto value = reading.root.find("response");
  if (!value) return;
  MechanismChoice& choice = study.mechanism;
  const CatalogEntry& entry = *choice.entry;
  choice.responses = read_own_responses(*value, entry.description, PoseBefore::known);
  choice.with_responses = std::make_shared<const CatalogEntry>(with_responses(entry, choice.responses));
  choice.entry = choice.with_responses.get();
}

void check_other_poses(const Study& study, const Reading& reading) {
  const std::vector<FactorIndex>& varied = study.analysis.factors;
  const bool is_machine = study.analysis.draws == Draws::per_machine;
  const auto anew = std::ranges::find_if(varied, [&](FactorIndex f) { return study.errors.is_per_pose(f); });
  const auto relative = std::ranges::find_if(study.model().responses, &Response::is_relative);
  if (is_machine && anew != varied.end() && relative != study.model().responses.end()) {
    throw InputError(reading.root.section("errors").place(),
                     "machines draw '" + study.model().factors[anew->value].name + "' anew at each pose, and '" +
                         relative->name + "' is the difference from its value at another pose",
                     "name errors without it in analysis.factors, or leave out draws = \"per pose\" or this response");
  }
  if (is_machine || study.analysis.kind->has_pose_before) return;
  for (const OwnResponse& own : study.mechanism.responses) {
    if (!own.relative_to || !own.relative_to->is_previous()) continue;
    throw InputError(own.relative_to->place,
                     "'" + own.name +
                         "' is relative to the pose before, but this study has no machines that are at "
                         "several poses",
                     "write draws = \"per machine\" if the kind of study has it, or relative_to = a pose");
  }
}

}  // namespace poesy
