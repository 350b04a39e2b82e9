#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include "engine/base/text.h"
#include "engine/kinds/allocation/alike_limbs.h"
#include "engine/kinds/allocation/in_no_part.h"
#include "engine/kinds/allocation/parts.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/zone_blocks.h"
#include "engine/kinds/allocation/zone_parts.h"
#include "engine/report/display.h"
#include "engine/stats/proportion.h"
#include "engine/study/calibration_keys.h"
#include "engine/study/limit_keys.h"
#include "engine/study/study_kind.h"

namespace poesy::allocation {
namespace {

constexpr std::array<std::string_view, 12> kKeys{"factors",    "limits", "yield", "confidence", "samples",     "aim",
                                                 "background", "sigmas", "cpk",   "calibrated", "calibration", "parts"};

/// The names of the aims (Aim) in study files, in the order of the enumeration.
constexpr std::array<std::string_view, 4> kAimNames{"least-cost", "equal-effect", "equal-tolerance", "common-factor"};

/// The expected number of rejects in a study with the default number of machines. With so many rejects, the relative
/// standard error of the estimated share of rejects is about 5 %.
constexpr double kUsualRejects = 400.0;
constexpr double kFewestUsual = 2000.0;
constexpr double kMostUsual = 20e6;

/// The default number of machines.
std::size_t usual_samples(double yield) {
  constexpr double kThousand = 1000.0;
  constexpr double kRounding = 1e-11;  // relative; without it, a yield of 0.9 would give 5000 machines instead of 4000
  const double machines = std::ceil(kUsualRejects / (1.0 - yield) * (1.0 - kRounding));
  return static_cast<std::size_t>(std::clamp(std::ceil(machines / kThousand) * kThousand, kFewestUsual, kMostUsual));
}

KeyValue<Study> samples_value() { return whole_at(2, kMostSolves, &Study::analysis, &Analysis::samples); }

void read_samples(const StudyValue& value, Study& study, const Reading&) {
  if (value.is_section()) {
    value.fail("is a table, but a certificate needs a number of machines that is fixed before",
               fmt::format("write a number, e.g. samples = {}", usual_samples(Options().yield)));
  }
  samples_value().read(value, study);
}

/// Reads `sigmas` or `cpk` of [analysis] only to refuse bad values; read_parts() reads them for the parts.
void read_usual_sigmas(const StudyValue&, Study&, const Reading& reading) {
  static_cast<void>(read_sigmas(reading.root.section("analysis")));
}

std::vector<FactorIndex> errors_of_parts(std::span<const AllocatedPart> parts) {
  std::vector<FactorIndex> errors;
  for (const AllocatedPart& part : parts) errors.insert(errors.end(), part.factors.begin(), part.factors.end());
  return errors;
}

/// Throws InputError if an error of these parts is also in an earlier part.
void check_own_errors(const StudySection& block, std::span<const AllocatedPart> earlier,
                      std::span<const AllocatedPart> parts, const ModelDescription& model) {
  std::vector<const AllocatedPart*> owner(model.factors.size());
  for (const AllocatedPart& part : earlier) {
    for (const FactorIndex factor : part.factors) owner[factor.value] = &part;
  }
  for (const AllocatedPart& part : parts) {
    for (const FactorIndex factor : part.factors) {
      if (owner[factor.value] == nullptr) continue;
      const StudyValue members = block.require(block.find("zones") ? "zones" : "factors");
      members.fail(fmt::format("puts '{}' into part '{}', but part '{}' has it as well",
                               model.factors[factor.value].name, part.name, owner[factor.value]->name),
                   "an error has one tolerance; leave it out of one of them");
    }
  }
}

/// Adds a warning to the study if the block names limbs with different joints as identical, unless the study already
/// has the same warning.
void doubt_unlike_limbs(const StudySection& block, Study& study) {
  const auto identical = block.find("identical_limbs");
  if (!identical) return;
  std::string doubt = unlike_limbs_text(read_limbs(*identical, study.model()), study);
  if (doubt.empty() || std::ranges::find(study.doubts, doubt) != study.doubts.end()) return;
  study.doubts.push_back(std::move(doubt));
}

/// The distance from the mean to the end of the distribution of the part's errors, in standard deviations. None if
/// this distance is not finite (normal, measured or given errors) or differs among the errors, or if the part is a
/// zone.
std::optional<double> end_in_sigmas(const AllocatedPart& part, const Study& study) {
  if (part.zone) return {};
  const auto end = [&](FactorIndex error) {
    const Distribution& errors = study.errors.by_factor[error.value];
    if (errors.parts() || !errors.given_values().empty()) return std::numeric_limits<double>::infinity();
    return errors.half_width() /
           std::sqrt(errors.standard_deviation() * errors.standard_deviation() - errors.shift() * errors.shift());
  };
  const double first = end(part.factors.front());
  constexpr double kRounding = 1e-9;
  const auto is_first = [&](FactorIndex error) { return std::abs(end(error) - first) <= kRounding * first; };
  if (!std::isfinite(first) || !std::ranges::all_of(part.factors, is_first)) return {};
  return first;
}

/// Warns of parts for which the distribution of the errors ends well within the tolerance, or well beyond it. Parts
/// with the same `sigmas` and the same end_in_sigmas() share a warning.
void doubt_ends(std::span<const AllocatedPart> parts, Study& study) {
  constexpr double kAlike = 0.05;  // relative; a normal truncated at 3 sigma ends 3.04 of its standard deviations away
  std::map<std::pair<double, double>, std::vector<std::string_view>> parts_of;  // by sigmas and end_in_sigmas()
  for (const AllocatedPart& part : parts) {
    const auto end = end_in_sigmas(part, study);
    if (end && std::abs(*end - part.sigmas) > kAlike * *end) parts_of[{part.sigmas, *end}].push_back(part.name);
  }
  for (const auto& [numbers, names_of_parts] : parts_of) {
    const auto& [sigmas, end] = numbers;
    const std::string others =
        names_of_parts.size() == 1 ? "" : " and " + counted(names_of_parts.size() - 1, "more part", "more parts");
    study.doubts.push_back(fmt::format(
        "the errors of part '{}'{} end {:.4g} standard deviations from their mean, but a tolerance is {:.4g} of them: "
        "what is certified are errors that end at {:.3g} times the tolerance; write sigmas = {:.4g} if errors may lie "
        "anywhere within it",
        names_of_parts.front(), others, end, sigmas, end / sigmas, end));
  }
}

void read_parts(const StudyValue& value, Study& study, const Reading& reading) {
  const auto usual = read_sigmas(reading.root.section("analysis"));
  std::vector<AllocatedPart>& parts = asked_of<Options>(study.analysis).parts;
  for (const StudyValue& one : value.list()) {
    const StudySection block = one.section();
    std::vector<AllocatedPart> more = read_part_block(block, study, usual, names(parts));
    check_own_errors(block, parts, more, study.model());
    doubt_unlike_limbs(block, study);
    parts.insert(parts.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  if (parts.empty()) value.fail("is empty", "write [[analysis.parts]] with factors, e.g. factors = \"linear\"");
  complete_zones(value, study, parts);
  doubt_ends(parts, study);
}

std::string parts_lines(const Study& study) {
  std::string text;
  for (const AllocatedPart& part : asked_of<Options>(study.analysis).parts) {
    text += part_text(part, study.model());
  }
  return text;
}

/// The line identical_limbs of a template, with the limbs that have features of the same names: in most drawings, these
/// limbs share tolerances. The line is that of shown_identical_limbs() if no name is in several limbs, if two names are
/// in different sets of limbs, or if the limbs have different joints.
std::string limbs_with_alike_features(const Study& study) {
  std::map<std::string, std::set<std::size_t>> limbs_of;
  for (const Feature& feature : study.model().features) limbs_of[feature.label].insert(feature.limb);
  std::set<std::size_t> alike;
  for (const auto& [label, limbs] : limbs_of) {
    if (limbs.size() < 2) continue;
    if (!alike.empty() && alike != limbs) return shown_identical_limbs(study);
    alike = limbs;
  }
  const bool differ = !unlike_limbs_text(std::vector(alike.begin(), alike.end()), study).empty();
  if (alike.empty() || differ) return shown_identical_limbs(study);
  return fmt::format("identical_limbs = [{}]\n", fmt::join(alike, ", "));
}

/// The TOML table [[analysis.parts]] of a template in which each error of this dimension is a part of its own. Empty if
/// the mechanism has no such error.
std::string shown_block(Dimension dimension, const Study& study) {
  if (std::ranges::count(study.model().factors, dimension, &Factor::dimension) == 0) return {};
  return fmt::format(
      "\n[[analysis.parts]]\nfactors = \"{}\"\neach = true\n{}cost = {{ law = \"reciprocal\", b = 1, unit = \"{}\" "
      "}}\n# bounds = [{}, {}]\n",
      error_kind(dimension), shown_identical_limbs(study), display_unit(dimension).name, example_size(dimension, 0.01),
      example_size(dimension, 1.0));
}

/// The TOML table [[analysis.parts]] of a template in which each tolerance zone is a part of its own. Empty if the
/// mechanism has no zones.
std::string shown_zone_block(const Study& study) {
  const auto has_zone = [](const Feature& feature) { return feature.location || feature.orientation; };
  if (std::ranges::none_of(study.model().features, has_zone)) return {};
  return fmt::format(
      "\n[[analysis.parts]]\nzones = \"all\"\neach = true\n{}cost = {{ law = \"reciprocal\", b = 1, unit = \"{}\" "
      "}}\n# bounds = [{}, {}]\n",
      limbs_with_alike_features(study), display_unit(Dimension::length).name, example_size(Dimension::length, 0.01),
      example_size(Dimension::length, 1.0));
}

/// The template's line for `sigmas`, which applies to parts that are not zones. If the template has no such part, the
/// line is a comment.
std::string shown_sigmas(const TemplateLines& lines, const Study& study) {
  const bool has_other = shown_zone_block(study).empty() || !shown_block(Dimension::angle, study).empty();
  return lines.explained("analysis", "sigmas", has_other ? "sigmas = 3" : "# sigmas = 3");
}

std::string shown_parts(const TemplateLines& lines, const Study& study) {
  const std::string cost(lines.meaning("analysis.parts.cost"));
  const std::string process(lines.meaning("analysis.parts.processes"));
  std::string zones = shown_zone_block(study);
  return "\n" + lines.explanation_lines("analysis", "parts") + lines.keys_lines("analysis.parts") +
         comment("    cost: " + cost) + lines.keys_lines("analysis.parts.cost", 3) +
         comment("    processes: " + process) + lines.keys_lines("analysis.parts.processes", 3) +
         (zones.empty() ? shown_block(Dimension::length, study) : zones).erase(0, 1) +
         shown_block(Dimension::angle, study);
}

StudyRow samples_row() {
  return {.name = "samples",
          .value = samples_value(),
          .usual = "400 expected rejects, 400 / (1 - yield) in whole thousands, from 2000 to 20 million",
          .example = std::to_string(usual_samples(Options().yield)),
          .meaning = "Machines with which tolerances are found, and as many fresh ones for the certificate.",
          .reader = read_samples,
          .commented = true};
}

StudyRow limits_row() {
  StudyRow row = shared_analysis_row("limits");
  row.required = true;
  row.meaning = "Limits of responses: a machine is good where it keeps all of them.";
  row.shown = [](const TemplateLines& lines, const Study& study) { return template_limits(lines, study.model(), ""); };
  return row;
}

StudyRow aim_row() {
  return {
      .name = "aim",
      .value = asked_value(word_at<Aim>(
          {{Aim::least_cost, "the least sum of the parts' costs"},
           {Aim::equal_effect, "each part uses the same share of the limit that it uses most"},
           {Aim::equal_tolerance,
            "one T for all lengths, one for all angles, and one for all numbers, in the ratio of their usual sizes in "
            "[errors]"},
           {Aim::common_factor,
            "the standard deviations of [errors], all times the largest factor that the limits allow"}},
          &Options::aim)),
      .usual = "\"least-cost\" where a part has a cost, else \"equal-effect\"",
      .example = "\"least-cost\"",
      .meaning = "Which of the tolerances that keep the limits.",
      .commented = true};
}

std::vector<StudyRow> allocation_rows() {
  return {samples_row(),
          limits_row(),
          StudyRow{.name = "yield",
                   .value = asked_value(number_at(between_0_and_1("0.9973"), &Options::yield)),
                   .meaning = "The share of the machines that must be within all limits at every pose."},
          StudyRow{.name = "confidence",
                   .value = asked_value(number_at(between_0_and_1("0.95"), &Options::confidence)),
                   .meaning = "Confidence of the certificate that the yield is reached."},
          aim_row(),
          StudyRow{.name = "sigmas",
                   .value = {.type = "number", .bounds = "greater than 0"},
                   .usual = "each part has its own",
                   .example = "3",
                   .meaning = "How many standard deviations a tolerance is, for parts that do not say it themselves.",
                   .reader = read_usual_sigmas,
                   .shown = shown_sigmas},
          StudyRow{.name = "cpk",
                   .value = {.type = "number", .bounds = "greater than 0"},
                   .usual = "",
                   .example = "1.33",
                   .meaning = "Instead of sigmas, the capability of the processes: sigmas / 3.",
                   .reader = read_usual_sigmas,
                   .commented = true},
          StudyRow{.name = "parts",
                   .value = {.type = "list of tables"},
                   .required = true,
                   .meaning = "The parts whose tolerances are wanted. Errors in none of them vary as [errors] says.",
                   .reader = read_parts,
                   .lines = parts_lines,
                   .late = 2,
                   .shown = shown_parts}};
}

/// Refuses a number of machines that is too small for a certificate even if all machines are good.
void check_samples(const Study& study, const StudySection& section) {
  const Options& asked = asked_of<Options>(study.analysis);
  const std::uint64_t needed = trials_without_failure(asked.yield, asked.confidence);
  if (study.analysis.samples >= needed) return;
  const std::string problem =
      fmt::format("{} machines cannot certify a yield of {} at a confidence of {} even if all of them are good",
                  study.analysis.samples, shortest(asked.yield), shortest(asked.confidence));
  const std::string remedy = fmt::format("take samples = {} or more, or ask for a smaller yield", needed);
  if (const auto value = section.find("samples")) value->fail("is too small: " + problem, remedy);
  const auto yield = section.find("yield");
  throw InputError(yield ? yield->place() : section.place(), problem, remedy);
}

/// Refuses a study without limits or parts.
void require_all(const Study& study, const StudySection& section) {
  static_cast<void>(
      section.require("limits", "write what every machine must keep, e.g. limits = " + example_limits(study.model())));
  static_cast<void>(section.require("parts", "write [[analysis.parts]] with factors, e.g. factors = \"linear\""));
}

/// Refuses a limit on the spread over the poses of a response that has no sign.
void check_limits(const Study& study, const StudySection& section) {
  for (const ResponseLimit& limit : study.analysis.limits) {
    const Response& response = study.model().responses[limit.response];
    if (!limit.allowed.is_spread() || !response.is_magnitude()) continue;
    limit_value(section, study, limit)
        .fail("is a limit on the spread over the poses, but " + response.name +
                  " has no sign, and tolerances are found by differences of responses between poses, which are linear",
              "limit the spread of a response with a sign; a study of kind \"monte-carlo\" finds the yield under this "
              "limit");
  }
}

/// Refuses an aim that cannot choose the tolerance of an orientation, because the effect of an orientation on a limit
/// may be negative.
void check_aim_of_zones(const Study& study, const StudySection& section) {
  const Options& asked = asked_of<Options>(study.analysis);
  if (asked.aim != Aim::equal_effect && asked.aim != Aim::equal_tolerance) return;
  const std::vector<Within> pairs = zone_pairs(asked.parts, study.model());
  if (pairs.empty()) return;
  const std::string problem = fmt::format("is \"{}\", which gives no tolerance to '{}' within '{}'", name(asked.aim),
                                          asked.parts[pairs.front().inner].name, asked.parts[pairs.front().outer].name);
  constexpr std::string_view kRemedy =
      "write what the zones cost, e.g. cost = { law = \"reciprocal\", b = 1, unit = \"mm\" }, or aim = "
      "\"common-factor\"";
  if (const auto aim = section.find("aim")) aim->fail(problem, kRemedy);
  throw InputError(section.place(), "analysis.aim " + problem, kRemedy);
}

void complete_allocation(Study& study, const Reading& reading) {
  const StudySection section = reading.root.section("analysis");
  Options& asked = asked_of<Options>(study.analysis);
  if (!section.find("samples")) study.analysis.samples = usual_samples(asked.yield);
  check_samples(study, section);
  check_limits(study, section);
  if (reading.use == StudyUse::run) {
    require_all(study, section);
    check_simulated_machines(study, section);
  }
  check_error_sizes(study, reading, errors_of_parts(asked.parts));
  const bool costs = std::ranges::any_of(asked.parts, has_cost);
  const auto aim = section.find("aim");
  if (!aim) asked.aim = costs ? Aim::least_cost : Aim::equal_effect;
  check_aim_of_zones(study, section);
  if (!aim || costs || asked.aim != Aim::least_cost || reading.use != StudyUse::run) return;
  aim->fail("is \"least-cost\", but no part has a cost",
            "write what the parts' tolerances cost, e.g. cost = { law = \"reciprocal\", b = 1, unit = \"mm\" }, or "
            "choose another aim");
}

void check_sizes(const StudySection& analysis, const Study& study, const Model& model) {
  const auto usual = read_sigmas(analysis);
  for (const StudyValue& one : analysis.require("parts").list()) {
    const StudySection block = one.section();
    for (const AllocatedPart& part : read_part_block(block, study, usual, {})) check_part_sizes(block, part, model);
  }
}

std::optional<Refusal> no_template(const ModelDescription& model) {
  if (!model.factors.empty() && !model.responses.empty()) return std::nullopt;
  return Refusal{"model '" + model.name + "' has no errors or no responses, so it has no tolerances",
                 "choose another kind"};
}

std::string note_on_parts(const Study& study) {
  return in_no_part_text(errors_in_no_part(study), study.analysis.factors.size());
}

AtPose allocation_at_pose(const Study& study) {
  const auto parts = static_cast<double>(asked_of<Options>(study.analysis).parts.size());
  return {parts, "parts", static_cast<double>(study.analysis.samples), "samples"};
}

}  // namespace

std::string_view name(Aim aim) { return kAimNames.at(static_cast<std::size_t>(aim)); }

const StudyKind kStudy{.name = "allocation",
                       .asks = "which tolerances keep limits, and at what cost",
                       .keys = kKeys,
                       .varies = Varies::together,
                       .draws = Draws::per_machine,
                       .draws_machines_anew = true,
                       .finds_sizes = true,
                       .decides_by_samples = true,
                       .rows = allocation_rows,
                       .tables = part_tables,
                       .no_template = no_template,
                       .complete = complete_allocation,
                       .check_errors = check_sizes,
                       .note = note_on_parts,
                       .at_pose = allocation_at_pose};

}  // namespace poesy::allocation
