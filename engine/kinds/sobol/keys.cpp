#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/name_pattern.h"
#include "engine/base/text.h"
#include "engine/kinds/sobol/groups.h"
#include "engine/kinds/sobol/result.h"
#include "engine/study/study_kind.h"

namespace poesy::sobol {
namespace {

constexpr std::array<std::string_view, 9> kKeys{"factors", "samples", "conf_level", "groups",    "second_order",
                                                "shapley", "design",  "replicates", "background"};

constexpr std::array kGroupings{GroupsBy::none, GroupsBy::limb, GroupsBy::frame};

/// The patterns of a group, which are written as a text or as a list of texts.
std::vector<std::string> read_patterns(const StudyValue& value) {
  if (value.is_text()) return {value.text()};
  std::vector<std::string> patterns;
  for (const StudyValue& one : value.list()) patterns.push_back(one.text());
  if (patterns.empty()) value.fail("is empty", "name errors, e.g. [\"delta_1_4_*\"]");
  return patterns;
}

/// Throws InputError if the name cannot be used in tables and files.
void check_group_name(const StudyValue& value, std::string_view name) {
  if (const auto problem = label_problem(name)) value.fail("is not a name for a group: it " + *problem, kLabelRule);
  if (name == kOtherErrors) value.fail("is not a name for a group", "it is that of the errors of no group");
}

void read_groups(const StudyValue& value, Study& study, const Reading&) {
  Options& asked = asked_of<Options>(study.analysis);
  if (value.is_text()) {
    std::vector<std::string_view> words;
    for (const GroupsBy by : kGroupings) words.push_back(name(by));
    asked.groups_by = kGroupings[value.word(words)];
    return;
  }
  const StudySection section = value.section();
  asked.groups_by = GroupsBy::name;
  for (const std::string& group : section.keys()) {
    const StudyValue patterns = section.require(group);
    check_group_name(patterns, group);
    asked.named_groups.push_back({group, read_patterns(patterns)});
  }
  if (asked.named_groups.empty())
    value.fail("names no group", "write { NAME = [\"delta_1_4_*\"], ... }, or leave it out");
}

std::string groups_lines(const Study& study) {
  const Options& asked = asked_of<Options>(study.analysis);
  if (asked.groups_by != GroupsBy::name) return "groups = " + in_quotes(name(asked.groups_by)) + "\n";
  std::string text;
  for (const NamedGroup& group : asked.named_groups) {
    std::vector<std::string> patterns;
    for (const std::string& pattern : group.patterns) patterns.push_back(in_quotes(pattern));
    text += fmt::format("groups.{} = {}\n", in_quotes(group.name), list_text(patterns));
  }
  return text;
}

std::string shown_groups(const TemplateLines& lines, const Study& study) {
  std::string text = lines.explained("analysis", "groups", "groups = \"none\"");
  if (study.model().factors.empty()) return text;
  return text + fmt::format("# groups = {{ mine = [{}] }}\n", in_quotes(study.model().factors.front().name));
}

KeyValue<Options> design() {
  return word_at<Design>(
      {{Design::random, "independent draws, those of a Monte Carlo study with one set of errors at all poses"},
       {Design::lhs, "a Latin hypercube for each replicate"},
       {Design::sobol, "scrambled Sobol' points, a scramble of its own for each replicate"}},
      &Options::design);
}

KeyValue<Options> yes_or_no(bool Options::*member) {
  const auto read = [](const StudyValue& value) { return value.yes_or_no(); };
  const auto text = [](bool asked) { return std::string(asked ? "true" : "false"); };
  return value_at("true or false", "", read, text, member);
}

std::string replicates_line(const Study& study) {
  const Options& asked = asked_of<Options>(study.analysis);
  return asked.design == Design::random ? "" : fmt::format("replicates = {}\n", asked.replicates);
}

std::vector<StudyRow> sobol_rows() {
  return {StudyRow{.name = "groups",
                   .value = {.type = "text or table",
                             .words = {{"none", "each error is a group of its own"},
                                       {"limb", "the errors of each limb"},
                                       {"frame", "the errors of each frame of a limb"}}},
                   .usual = "`\"none\"`",
                   .meaning =
                       "Errors that are taken together; or a table { NAME = [\"delta_1_4_*\"] } of groups, the errors "
                       "of none of them being one more.",
                   .reader = read_groups,
                   .lines = groups_lines,
                   .late = 1,
                   .shown = shown_groups},
          StudyRow{.name = "second_order",
                   .value = asked_value(yes_or_no(&Options::second_order)),
                   .meaning = "Whether the interaction of each pair is asked for; it takes a solve for each of them."},
          StudyRow{.name = "shapley",
                   .value = asked_value(yes_or_no(&Options::shapley)),
                   .meaning = "Whether Shapley effects are asked for, which divide all of the variance, also among "
                              "errors that are correlated; with G groups, at most 8, it takes 2^G solves of a sample."},
          StudyRow{.name = "design", .value = asked_value(design()), .meaning = "How samples fill the errors' space."},
          StudyRow{.name = "replicates",
                   .value = asked_value(whole_at(8, 100'000, &Options::replicates)),
                   .meaning = "Independent parts of a design that is not random, from which intervals follow; they "
                              "share the samples evenly.",
                   .lines = replicates_line,
                   .commented = true}};
}

StudyTables sobol_tables_of_keys() {
  return {{.paths = {"analysis.groups"},
           .meaning = "For kind = \"sobol\".",
           .keys = {{.name = "GROUP",
                     .type = "text or list of texts",
                     .usual = "none",
                     .meaning = "The group's errors by name, '*' for any letters and '?' for one."}}}};
}

/// The name of the error at this position of the study.
const std::string& factor_name(const Study& study, std::size_t position) {
  return study.model().factors[study.analysis.factors[position].value].name;
}

/// Throws InputError if a pattern matches no error of the study, or an error of an earlier group.
void check_named_groups(const Study& study, const StudySection& section) {
  std::vector<std::string_view> owner(study.analysis.factors.size());
  for (const NamedGroup& group : asked_of<Options>(study.analysis).named_groups) {
    const StudyValue value = section.require(group.name);
    for (const std::string& pattern : group.patterns) {
      bool any = false;
      for (std::size_t p = 0; p < owner.size(); ++p) {
        if (!matches(pattern, factor_name(study, p))) continue;
        any = true;
        if (!owner[p].empty() && owner[p] != group.name) {
          value.fail(fmt::format("has '{}', which group '{}' has as well", factor_name(study, p), owner[p]),
                     "an error belongs to one group");
        }
        owner[p] = group.name;
      }
      if (!any) {
        value.fail("has '" + printable(pattern) + "', which is none of the errors that the study varies",
                   listed_by_models(study) + "; see also analysis.factors");
      }
    }
  }
}

/// Throws InputError if the samples cannot be divided equally among the replicates, with at least two for each, or if
/// random draws have the key `replicates`.
void check_replicates(const Study& study, const StudySection& analysis) {
  const Options& asked = asked_of<Options>(study.analysis);
  const auto replicates = analysis.find("replicates");
  if (asked.design == Design::random) {
    if (replicates) replicates->fail("is set, but analysis.design is \"random\"", "write another design, or remove it");
    return;
  }
  const std::size_t samples = study.analysis.samples;
  if (samples % asked.replicates == 0 && samples / asked.replicates >= 2) return;
  const std::size_t each = std::max<std::size_t>(2, (samples + asked.replicates - 1) / asked.replicates);
  const std::string problem = fmt::format("is {}, which {} replicates do not share evenly", samples, asked.replicates);
  const std::string remedy = fmt::format("write samples = {}, or other replicates", each * asked.replicates);
  if (const auto value = analysis.find("samples")) value->fail(problem, remedy);
  throw InputError(analysis.place(), "analysis.samples " + problem, remedy);
}

std::string names_of(const std::vector<FactorIndex>& factors, const Study& study) {
  std::string text;
  for (const FactorIndex factor : factors)
    text += (text.empty() ? "" : ", ") + study.model().factors[factor.value].name;
  return printable(text, 120);
}

/// Throws InputError if there are too many groups for Shapley effects, or if errors of different groups are correlated.
/// Such a correlation is allowed if the study asks for Shapley effects and for no second-order indices.
void check_correlation(const Study& study, const StudySection& analysis) {
  const Options& asked = asked_of<Options>(study.analysis);
  const std::vector<ErrorGroup> groups = error_groups(study.analysis, study.model());
  if (asked.shapley && groups.size() > kMostShapleyGroups) {
    analysis.require("shapley").fail(
        fmt::format("is true, but there are {} groups, and each subset of them takes a solve", groups.size()),
        fmt::format("join the errors to at most {} groups with analysis.groups", kMostShapleyGroups));
  }
  for (const CorrelatedErrors& block : study.errors.correlated) {
    Study alone = study;
    alone.errors.correlated = {block};
    if (std::ranges::count(split_groups(groups, alone), 1) == 0) continue;
    const std::string problem = "are correlated, but belong to different groups";
    const std::string names = names_of(block.factors, study);
    if (asked.shapley && !asked.second_order) continue;
    if (asked.shapley) {
      analysis.require("second_order")
          .fail("is true, but the errors " + names + " " + problem,
                "remove it, or take groups that hold them together");
    }
    const auto value = analysis.find("groups");
    throw InputError(value ? value->place() : analysis.place(), "the errors " + names + " " + problem,
                     "take groups that hold them together, e.g. groups = { NAME = [...] }, or shapley = true for "
                     "Shapley effects");
  }
}

/// Throws InputError if errors of a feature that are drawn together are in different groups.
void check_zone_groups(const Study& study, const StudySection& analysis) {
  const std::vector<ErrorGroup> groups = error_groups(study.analysis, study.model());
  const auto group_of = [&](FactorIndex error) {
    return std::ranges::find_if(groups, [&](const ErrorGroup& group) {
      return std::ranges::any_of(group.members, [&](std::size_t p) { return study.analysis.factors[p] == error; });
    });
  };
  for (const Feature& feature : features_drawn_together(study)) {
    const std::vector<FactorIndex> errors = feature.errors();
    const auto is_elsewhere = [&](FactorIndex error) { return group_of(error) != group_of(errors.front()); };
    if (std::ranges::none_of(errors, is_elsewhere)) continue;
    const auto value = analysis.find("groups");
    throw InputError(value ? value->place() : analysis.place(),
                     "the errors " + names_of(errors, study) +
                         " are drawn together in their zone, but belong to "
                         "different groups",
                     fmt::format("take groups that hold whole features, e.g. groups = {{ {} = [\"{}_*\"] }}, or write "
                                 "errors.zones = {{ distribution = \"normal\", sigmas = 3 }}",
                                 feature.label, feature.label));
  }
}

constexpr std::string_view kPerPose = "drawn per pose, but indices of Sobol' are of errors that a machine keeps";

/// Throws InputError if a machine draws an error anew at each pose, because a mixture of two samples takes an error
/// from the same sample at all poses.
void check_draws(const Study& study, const StudySection& analysis) {
  for (const FactorIndex factor : study.analysis.factors) {
    if (!study.errors.is_per_pose(factor)) continue;
    const auto value = analysis.find("factors");
    throw InputError(value ? value->place() : analysis.place(),
                     fmt::format("the error '{}' is {}", study.model().factors[factor.value].name, kPerPose),
                     "name other errors in analysis.factors, remove its draws = \"per pose\", or take kind = "
                     "\"monte-carlo\", whose S1 knows it");
  }
}

/// The reason why a mechanism with clearances has no template: a study of all its errors would be refused
/// (check_draws()).
std::optional<Refusal> no_template(const ModelDescription& model) {
  const std::vector<FactorIndex> loose = clearance_errors(model);
  if (loose.empty()) return std::nullopt;
  return Refusal{fmt::format("model '{}' has clearances, whose errors, such as {}, are {}", model.name,
                             model.factors[loose.front().value].name, kPerPose),
                 "take kind 'monte-carlo', or write a study of kind 'sobol' whose factors leave these errors out"};
}

void check_sobol(Study& study, const Reading& reading) {
  const StudySection analysis = reading.root.section("analysis");
  if (study.analysis.adaptive && asked_of<Options>(study.analysis).design != Design::random) {
    analysis.require("samples").fail("is a table, but analysis.design is not \"random\"",
                                     "write a number, e.g. samples = 4096");
  }
  check_draws(study, analysis);
  check_error_sizes(study, reading);
  check_replicates(study, analysis);
  if (asked_of<Options>(study.analysis).groups_by == GroupsBy::name) {
    check_named_groups(study, analysis.section("groups"));
  }
  if (reading.use == StudyUse::run) {
    check_correlation(study, analysis);
    check_zone_groups(study, analysis);
  }
  if (error_groups(study.analysis, study.model()).size() > 1 || reading.use != StudyUse::run) return;
  throw InputError(analysis.place(), "all errors are one group, so there is nothing to compare",
                   "name more factors, or other groups");
}

/// The number of solves for a sample of the panel at each pose: one for each of the sets of errors A and B and one for
/// each group; with Shapley effects, one for each subset of groups instead. Second-order indices add one for each pair.
double solves_of_sample(const Study& study) {
  const auto groups = static_cast<double>(error_groups(study.analysis, study.model()).size());
  const Options& asked = asked_of<Options>(study.analysis);
  return (asked.shapley ? std::exp2(groups) : 2.0 + groups) +
         (asked.second_order ? 0.5 * groups * (groups - 1.0) : 0.0);
}

AtPose sobol_at_pose(const Study& study) {
  const auto groups = static_cast<double>(error_groups(study.analysis, study.model()).size());
  return {groups, "groups", solves_of_sample(study) * static_cast<double>(study.analysis.samples),
          "samples times groups and two"};
}

}  // namespace

std::string_view name(GroupsBy by) {
  switch (by) {
    case GroupsBy::none:
      return "none";
    case GroupsBy::limb:
      return "limb";
    case GroupsBy::frame:
      return "frame";
    case GroupsBy::name:
      break;
  }
  return "name";
}

std::string_view name(Design design) {
  switch (design) {
    case Design::random:
      return "random";
    case Design::lhs:
      return "lhs";
    case Design::sobol:
      break;
  }
  return "sobol";
}

const StudyKind kStudy{.name = "sobol",
                       .asks = "how the variance of each response divides among the errors and their interactions",
                       .keys = kKeys,
                       .varies = Varies::together,
                       .draws = Draws::per_machine,
                       .draws_machines_anew = true,
                       .rows = sobol_rows,
                       .tables = sobol_tables_of_keys,
                       .no_template = no_template,
                       .complete = check_sobol,
                       .at_pose = sobol_at_pose};

}  // namespace poesy::sobol
