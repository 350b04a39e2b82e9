#include <array>

#include "engine/kinds/monte_carlo/result.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

constexpr std::array<std::string_view, 8> kMonteCarloKeys{"factors", "samples", "conf_level", "quantiles",
                                                          "limits",  "judge",   "share",      "background"};

/// Shares between 0 and 1, ascending.
KeyValue<MonteCarloOptions> quantiles() {
  const NumberBounds bounds = between_0_and_1("0.95");
  const auto read = [=](const StudyValue& value) {
    std::vector<double> list;
    for (const StudyValue& one : value.list()) {
      list.push_back(read_number(one, bounds));
      if (list.size() > 1 && !(list[list.size() - 2] < list.back())) {
        one.fail("is " + shortest(list.back()) + ", not above the one before it", "write them in ascending order");
      }
    }
    if (list.empty()) value.fail("is empty", "leave it out for 0.05, 0.5 and 0.95");
    return list;
  };
  const auto text = [](const std::vector<double>& quantiles) {
    std::vector<std::string> list;
    for (const double quantile : quantiles) list.push_back(shortest(quantile));
    return list_text(list);
  };
  return value_at("list of numbers", bounds.words, read, text, &MonteCarloOptions::quantiles);
}

KeyValue<MonteCarloOptions> judge() {
  return word_at<Judge>(
      {{Judge::rms,
        "the response's root mean square over the draws of all poses is within the limit; draws that were not solved "
        "are left out"},
       {Judge::share,
        "at every pose at least a share of the draws is within the limit; draws that were not solved are not"}},
      &MonteCarloOptions::judge);
}

std::string judge_line(const Study& study) {
  const MonteCarloOptions& asked = asked_of<MonteCarloOptions>(study.analysis);
  const bool idle = asked.judge == Judge::rms && study.analysis.limits.empty();
  return idle ? "" : "judge = " + in_quotes(name(asked.judge)) + "\n";
}

/// What a share of the draws stays within is part of a run's state, so `share` has its line even where limits are left
/// out (CheckpointIdentity).
std::string share_line(const Study& study) {
  const MonteCarloOptions& asked = asked_of<MonteCarloOptions>(study.analysis);
  return asked.judge == Judge::share ? "share = " + shortest(asked.share) + "\n" : "";
}

std::vector<StudyRow> monte_carlo_rows() {
  return {StudyRow{.name = "quantiles",
                   .value = asked_value(quantiles()),
                   .meaning = "Shares of the samples that lie below, ascending."},
          StudyRow{.name = "judge",
                   .value = asked_value(judge()),
                   .meaning = "When a limit is kept. (In an evaluation, if each case is within it at every pose.)",
                   .lines = judge_line,
                   .commented = true},
          StudyRow{.name = "share",
                   .value = asked_value(number_at(between_0_and_1("0.9973"), &MonteCarloOptions::share)),
                   .usual = "",
                   .example = "0.9973",
                   .meaning = "With judge = \"share\", and required there: the share of the draws.",
                   .lines = share_line,
                   .commented = true}};
}

void check_judge(Study& study, const Reading& reading) {
  const StudySection section = reading.root.section("analysis");
  const auto judge = section.find("judge");
  const auto share = section.find("share");
  const bool by_share = asked_of<MonteCarloOptions>(study.analysis).judge == Judge::share;
  if (by_share && !share) {
    judge->fail(
        "is \"share\", but analysis.share is missing",
        "write the share of the draws, e.g. share = " + row_of(analysis_keys(*study.analysis.kind), "share").example);
  }
  if (!by_share && share) {
    share->fail("is set, but analysis.judge is \"rms\"", "write judge = \"share\", or leave it out");
  }
  if (judge && !section.find("limits")) {
    judge->fail("is set, but the study states no limit", "write [analysis.limits], or leave it out");
  }
}

AtPose monte_carlo_at_pose(const Study& study) {
  return {static_cast<double>(asked_of<MonteCarloOptions>(study.analysis).quantiles.size()), "quantiles",
          static_cast<double>(study.analysis.samples), "samples"};
}

}  // namespace

const StudyKind kMonteCarloStudy{.name = "monte-carlo",
                                 .asks = "what all errors do together",
                                 .keys = kMonteCarloKeys,
                                 .varies = Varies::together,
                                 .rows = monte_carlo_rows,
                                 .complete = check_judge,
                                 .at_pose = monte_carlo_at_pose};

}  // namespace poesy
