#include <array>

#include "engine/kinds/monte_carlo/result.h"
#include "engine/stats/proportion.h"
#include "engine/study/calibration.h"
#include "engine/study/calibration_keys.h"
#include "engine/study/limit_keys.h"
#include "engine/study/study_kind.h"

namespace poesy::monte_carlo {
namespace {

constexpr std::array<std::string_view, 12> kKeys{"factors",     "samples",    "draws",     "calibrated",
                                                 "calibration", "conf_level", "quantiles", "limits",
                                                 "judge",       "share",      "yield",     "background"};

/// The key `quantiles`: numbers between 0 and 1, ascending.
KeyValue<Options> quantiles() {
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
  return value_at("list of numbers", bounds.words, read, text, &Options::quantiles);
}

KeyValue<Options> judge() {
  return word_at<Judge>(
      {{Judge::rms,
        "the response's root mean square over the draws of all poses is within the limit; draws that were not solved "
        "are left out"},
       {Judge::share,
        "at every pose at least a share of the draws is within the limit; draws that were not solved are not"},
       {Judge::yield,
        "of the machines at least a share, yield, is within all limits at every pose; machines that were not solved at "
        "a pose are not. For draws = \"per machine\""}},
      &Options::judge);
}

/// The default for the key `judge`, which states how limits are judged.
Judge usual_judge(const Analysis& analysis) { return analysis.draws == Draws::per_machine ? Judge::yield : Judge::rms; }

std::string judge_line(const Study& study) {
  const Options& asked = asked_of<Options>(study.analysis);
  const bool idle = asked.judge == usual_judge(study.analysis) && study.analysis.limits.empty();
  return idle ? "" : "judge = " + in_quotes(name(asked.judge)) + "\n";
}

/// The line of the key `share` in a study file. The text that identifies a checkpoint (identity_of()) has this line
/// even if limits are left out of it, because the saved state contains share_magnitude.
std::string share_line(const Study& study) {
  const Options& asked = asked_of<Options>(study.analysis);
  return asked.judge == Judge::share ? "share = " + shortest(asked.share) + "\n" : "";
}

std::string yield_line(const Study& study) {
  const double asked = asked_of<Options>(study.analysis).yield;
  return asked > 0.0 ? "yield = " + shortest(asked) + "\n" : "";
}

std::vector<StudyRow> monte_carlo_rows() {
  return {
      StudyRow{.name = "quantiles",
               .value = asked_value(quantiles()),
               .meaning = "Shares of the samples that lie below, ascending."},
      StudyRow{.name = "judge",
               .value = asked_value(judge()),
               .usual = "\"yield\"; with draws = \"per pose\" \"rms\"",
               .example = "\"rms\"",
               .meaning = "When a limit is kept. (In an evaluation, if each case is within it at every pose.)",
               .lines = judge_line,
               .commented = true},
      StudyRow{.name = "share",
               .value = asked_value(number_at(between_0_and_1("0.9973"), &Options::share)),
               .usual = "",
               .example = "0.9973",
               .meaning = "With judge = \"share\", and required there: the share of the draws.",
               .lines = share_line,
               .commented = true},
      StudyRow{.name = "yield",
               .value = asked_value(number_at(between_0_and_1("0.9973"), &Options::yield)),
               .usual = "none: the yield is found, and not judged",
               .example = "0.9973",
               .meaning = "With judge = \"yield\": the share of the machines that must be within all limits. PASS or "
                          "FAIL where conf_level of one-sided bounds show it, else undecided.",
               .lines = yield_line,
               .commented = true}};
}

void check_share(const Study& study, const StudySection& section) {
  const auto judge = section.find("judge");
  const auto share = section.find("share");
  const Judge by = asked_of<Options>(study.analysis).judge;
  if (by == Judge::share && !share) {
    judge->fail(
        "is \"share\", but analysis.share is missing",
        "write the share of the draws, e.g. share = " + row_of(analysis_keys(*study.analysis.kind), "share").example);
  }
  if (by != Judge::share && share) {
    share->fail("is set, but analysis.judge is " + in_quotes(name(by)), "write judge = \"share\", or leave it out");
  }
}

/// Refuses the key `yield` if limits are not judged by the yield, if there are no limits, or if the number of machines
/// is too small to show this yield even if all machines are good.
void check_yield(const Study& study, const StudySection& section) {
  const Options& asked = asked_of<Options>(study.analysis);
  const auto yield = section.find("yield");
  if (!yield) return;
  if (asked.judge != Judge::yield) {
    yield->fail("is set, but analysis.judge is " + in_quotes(name(asked.judge)),
                study.analysis.draws == Draws::per_machine
                    ? "leave judge or yield out"
                    : "write draws = \"per machine\", which judges by the yield, or leave it out");
  }
  if (!section.find("limits")) {
    yield->fail("is set, but the study states no limit", "write [analysis.limits], or leave it out");
  }
  const std::uint64_t needed = trials_without_failure(asked.yield, study.analysis.conf_level);
  if (study.analysis.samples >= needed) return;
  yield->fail("is " + shortest(asked.yield) + ", which " + std::to_string(study.analysis.samples) +
                  " machines cannot show at a confidence of " + shortest(study.analysis.conf_level) +
                  " even if all of them are good",
              "take " + std::to_string(needed) + " samples or more, or ask for a smaller yield");
}

/// Refuses limits that cannot be judged in the way that the key `judge` states.
void check_limits(const Study& study, const StudySection& section) {
  const Judge by = asked_of<Options>(study.analysis).judge;
  for (const ResponseLimit& limit : study.analysis.limits) {
    if (limit.allowed.is_over_poses() && by != Judge::yield) {
      limit_value(section, study, limit)
          .fail(limit.allowed.is_spread() ? "limits the spread over the poses of a machine, which a draw at one pose "
                                            "does not have"
                                          : "is to be kept at a share of the poses of a machine, which a draw at one "
                                            "pose does not have",
                "write draws = \"per machine\", and judge = \"yield\" or none");
    }
    if (limit.allowed.is_magnitude() || by != Judge::rms) continue;
    limit_value(section, study, limit)
        .fail("is not a limit on the magnitude, but limits are judged by the root mean square, which has no sign",
              "write draws = \"per machine\", or judge = \"share\" and share = 0.9973, or one upper limit on the "
              "magnitude");
  }
}

/// Refuses a calibration if errors are drawn per pose, or if it does not state what is measured.
void check_calibration(const Study& study, const StudySection& section) {
  const auto calibration = section.find("calibration");
  if (!calibration) return;
  if (study.analysis.draws == Draws::per_pose) {
    calibration->fail("is of a machine, but errors are drawn anew at each pose", "set draws = \"per machine\"");
  }
  check_simulated_machines(study, section);
}

void complete(Study& study, const Reading& reading) {
  const StudySection section = reading.root.section("analysis");
  if (reading.use == StudyUse::run) check_calibration(study, section);
  check_error_sizes(study, reading);
  const auto judge = section.find("judge");
  Options& asked = asked_of<Options>(study.analysis);
  if (!judge) asked.judge = usual_judge(study.analysis);
  if (asked.judge == Judge::yield && study.analysis.draws == Draws::per_pose) {
    judge->fail("is \"yield\", but errors are drawn anew at each pose, so there are no machines",
                "write draws = \"per machine\"");
  }
  check_share(study, section);
  check_limits(study, section);
  check_yield(study, section);
  if (judge && !section.find("limits")) {
    judge->fail("is set, but the study states no limit", "write [analysis.limits], or leave it out");
  }
}

AtPose monte_carlo_at_pose(const Study& study) {
  return {static_cast<double>(asked_of<Options>(study.analysis).quantiles.size()), "quantiles",
          static_cast<double>(study.analysis.samples), "samples"};
}

void ask_yield(Study& study, double yield) {
  study.analysis.draws = Draws::per_machine;
  Options& asked = asked_of<Options>(study.analysis);
  asked.judge = Judge::yield;
  asked.yield = yield;
}

}  // namespace

const StudyKind kStudy{.name = "monte-carlo",
                       .asks = "what all errors do together",
                       .keys = kKeys,
                       .varies = Varies::together,
                       .draws = Draws::per_machine,
                       .rows = monte_carlo_rows,
                       .complete = complete,
                       .at_pose = monte_carlo_at_pose,
                       .ask_yield = ask_yield};

}  // namespace poesy::monte_carlo
