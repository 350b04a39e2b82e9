#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/base/text.h"
#include "engine/study/keys.h"
#include "engine/study/study_text.h"

namespace poesy {
namespace {

using Kind = Analysis::Kind;

/// A kind of study, with its keys of [analysis] in the order of its templates.
struct KindKeys {
  Kind kind;
  std::vector<std::string_view> keys;
};

/// In the order in which the reference names kinds.
const std::array<KindKeys, 5>& kinds() {
  static const std::array<KindKeys, 5> list{{
      {Kind::sensitivity, {"factors", "samples", "conf_level", "background", "linearity", "reference"}},
      {Kind::identification, {"factors", "pose_share", "groups"}},
      {Kind::monte_carlo, {"factors", "samples", "conf_level", "quantiles", "limits", "judge", "share", "background"}},
      {Kind::evaluate, {"background", "limits", "cases"}},
      {Kind::coupling, {"linear", "angular", "limbs", "components", "sources"}},
  }};
  return list;
}

FactorIndex factor_named(const StudyValue& value, const ModelDescription& model) {
  return FactorIndex(value.word(names(model.factors)));
}

std::vector<FactorIndex> all_factors(const ModelDescription& model) {
  std::vector<FactorIndex> factors;
  for (std::size_t f = 0; f < model.factors.size(); ++f) factors.emplace_back(f);
  return factors;
}

std::vector<FactorIndex> factors_of_set(const StudyValue& value, const ModelDescription& model) {
  const std::string written = value.text();
  if (const FactorSet* set = model.find_set(written)) return set->factors;
  if (written == "all") return all_factors(model);
  if (model.find_factor(written)) {
    value.fail("is '" + written + "', which is a factor, not a set", "write it as a list: [\"" + written + "\"]");
  }
  std::vector<std::string_view> known = names(model.factor_sets);
  if (model.find_set("all") == nullptr) known.push_back("all");
  value.fail("is '" + printable(written) + "', which is no factor set of the model", suggestion(written, known));
}

/// The factor set that a study of this kind takes when it names none.
std::vector<FactorIndex> usual_factors(Analysis::Kind kind, const ModelDescription& model) {
  const FactorSet* set = model.find_set("deforming");
  return kind == Analysis::Kind::sensitivity && set != nullptr ? set->factors : all_factors(model);
}

void read_studied_factors(const StudyValue& value, Study& study, const Reading&) {
  study.analysis.factors = read_factors(value, study.model());
}

std::string factors_line(const Study& study) {
  return "factors = " + factors_text(study.analysis.factors, study.model()) + "\n";
}

/// The table of adaptive samples.
struct Adaptive {
  std::size_t min = AdaptiveSamples().min;
  std::size_t max = 0;
  double relative_error = 0.0;
  double conf_level = 0.0;  ///< 0 where it names none
};

const InnerRows<Adaptive>& adaptive_keys() {
  static const InnerRows<Adaptive> keys{
      .paths = {"analysis.samples"},
      .meaning = "As many samples as it takes until every interval is narrow enough.",
      .rows = {InnerRow<Adaptive>{.name = "min",
                                  .value = whole_at(2, kMostSolves, &Adaptive::min),
                                  .meaning = "Samples before the first decision."},
               InnerRow<Adaptive>{.name = "max",
                                  .value = whole_at(2, kMostSolves, &Adaptive::max),
                                  .missing = "write the most samples to take at each pose, e.g. {}",
                                  .example = "1000000",
                                  .meaning = "The most samples at each pose."},
               InnerRow<Adaptive>{
                   .name = "relative_error",
                   .value = number_at(between_0_and_1("0.01"), &Adaptive::relative_error),
                   .missing = "write how narrow intervals are to be, half their width over the value, e.g. 0.01",
                   .example = "0.01",
                   .meaning = "Half the width of an interval over the value it belongs to, at the most."},
               InnerRow<Adaptive>{.name = "conf_level",
                                  .value = number_at(between_0_and_1("0.95"), &Adaptive::conf_level),
                                  .usual = "that of [analysis]",
                                  .meaning = "Level of the confidence intervals, if it is not set in [analysis]."}}};
  return keys;
}

void check_order(const StudySection& section, const Adaptive& adaptive) {
  if (adaptive.min <= adaptive.max) return;
  if (const auto min = section.find("min")) {
    min->fail("is " + std::to_string(adaptive.min) + ", more than max = " + std::to_string(adaptive.max),
              "write a smaller min or a larger max");
  }
  section.require("max").fail("is " + std::to_string(adaptive.max) + ", less than min, which is " +
                                  std::to_string(adaptive.min) + " where it is not set",
                              "write a larger max, or min besides");
}

/// A number, or the table of adaptive samples, whose level of the intervals must be the only one.
void read_samples(const StudyValue& value, Study& study, const Reading& reading) {
  Analysis& analysis = study.analysis;
  if (!value.is_section()) {
    analysis.samples = static_cast<std::size_t>(value.whole_number(2, kMostSolves));
    return;
  }
  Adaptive adaptive;
  const StudySection section = value.section();
  read_keys(adaptive_keys(), section, adaptive, Nothing());
  check_order(section, adaptive);
  analysis.samples = adaptive.max;
  analysis.adaptive = {adaptive.min, adaptive.relative_error};
  if (adaptive.conf_level == 0.0) return;
  analysis.conf_level = adaptive.conf_level;
  const auto other = reading.root.section("analysis").find("conf_level");
  const double level = other ? read_number(*other, between_0_and_1("0.95")) : adaptive.conf_level;
  if (level == adaptive.conf_level) return;
  section.require("conf_level")
      .fail("is " + shortest(adaptive.conf_level) + ", but analysis.conf_level is " + shortest(level),
            "write the level of the intervals once");
}

/// A line for each key of adaptive samples, so that a comparison of two studies line by line names the key.
std::string samples_lines(const Study& study) {
  const Analysis& analysis = study.analysis;
  if (!analysis.adaptive) return fmt::format("samples = {}\n", analysis.samples);
  return fmt::format("samples.min = {}\nsamples.max = {}\nsamples.relative_error = {}\n", analysis.adaptive->min,
                     analysis.samples, shortest(analysis.adaptive->relative_error));
}

const InnerRows<Background>& background_keys() {
  static const InnerRows<Background> keys{
      .paths = {"analysis.background"},
      .meaning = "Errors held constant.",
      .rows = {InnerRow<Background>{.name = "factors",
                                    .value = {.type = "text or list of texts"},
                                    .missing = "write a factor set or a list of factors",
                                    .meaning = "The errors that are held: a factor set, all, or a list of factors."},
               InnerRow<Background>{.name = "linear",
                                    .value = quantity_at(Dimension::length, &Background::linear),
                                    .usual = "the standard deviation of linear in [errors]",
                                    .meaning = "The value of those that are lengths."},
               InnerRow<Background>{.name = "angular",
                                    .value = quantity_at(Dimension::angle, &Background::angular),
                                    .usual = "the standard deviation of angular in [errors]",
                                    .meaning = "The value of those that are angles."}}};
  return keys;
}

/// Errors are held as large as errors of the study are, unless it says otherwise.
void read_background(const StudyValue& value, Study& study, const Reading& reading) {
  const StudySection section = value.section();
  Background background{.factors = {},
                        .linear = usual_distribution(reading.root, Dimension::length).standard_deviation(),
                        .angular = usual_distribution(reading.root, Dimension::angle).standard_deviation()};
  read_keys(background_keys(), section, background, Nothing());
  background.factors = read_factors(section.require("factors"), study.model());
  study.analysis.background = std::move(background);
}

std::string background_lines(const Study& study) {
  if (!study.analysis.background) return {};
  const Background& background = *study.analysis.background;
  return "\n[analysis.background]\nfactors = " + factors_text(background.factors, study.model()) + "\n" +
         keys_text(background_keys(), background);
}

const InnerRows<ToleranceReference>& reference_keys() {
  static const InnerRows<ToleranceReference> keys{
      .paths = {"analysis.reference"},
      .meaning = "Where tolerances of equal effect begin.",
      .rows = {InnerRow<ToleranceReference>{.name = "factor",
                                            .value = {.type = "text"},
                                            .missing = "name the error from which tolerances are counted",
                                            .meaning = "One of the errors that vary."},
               InnerRow<ToleranceReference>{.name = "tolerance",
                                            .value = {.type = "quantity", .bounds = "greater than 0"},
                                            .usual = "1 mm or 1 deg",
                                            .meaning = "Its tolerance, the standard deviation of a normal error."}}};
  return keys;
}

void read_reference(const StudyValue& value, Study& study, const Reading&) {
  const StudySection section = value.section();
  section.allow();
  const StudyValue factor = section.require("factor");
  const std::vector<Factor>& factors = study.model().factors;
  const FactorIndex named = factor_named(factor, study.model());
  if (std::ranges::find(study.analysis.factors, named) == study.analysis.factors.end()) {
    factor.fail("is '" + factors[named.value].name + "', which this study does not vary", "name one of its factors");
  }
  const Dimension dimension = factors[named.value].dimension;
  const auto tolerance = section.find("tolerance");
  study.analysis.reference = {named, tolerance ? tolerance->positive_quantity(dimension) : display_unit(dimension).si};
}

std::string reference_line(const Study& study) {
  if (!study.analysis.reference) return {};
  const Factor& factor = study.model().factors[study.analysis.reference->factor.value];
  return fmt::format("reference = {{ factor = {}, tolerance = {} }}\n", in_quotes(factor.name),
                     exact_value(study.analysis.reference->tolerance, factor.dimension));
}

std::string linearity_line(const Study& study) {
  return study.mechanism.compared ? "linearity = " + shortest(study.analysis.linearity) + "\n" : "";
}

/// Shares between 0 and 1, ascending.
KeyValue<Study> quantiles() {
  const NumberBounds bounds = between_0_and_1("0.95");
  const auto read = [=](const StudyValue& value, Study& study) {
    std::vector<double> list;
    for (const StudyValue& one : value.list()) {
      list.push_back(read_number(one, bounds));
      if (list.size() > 1 && !(list[list.size() - 2] < list.back())) {
        one.fail("is " + shortest(list.back()) + ", not above the one before it", "write them in ascending order");
      }
    }
    if (list.empty()) value.fail("is empty", "leave it out for 0.05, 0.5 and 0.95");
    study.analysis.quantiles = list;
  };
  const auto text = [](const Study& study) {
    std::vector<std::string> list;
    for (const double quantile : study.analysis.quantiles) list.push_back(shortest(quantile));
    return list_text(list);
  };
  return {.type = "list of numbers", .bounds = std::string(bounds.words), .read = read, .text = text};
}

/// In the order of the model's responses.
void read_response_limits(const StudyValue& value, Study& study, const Reading&) {
  const std::vector<Response>& responses = study.model().responses;
  const StudySection section = value.section();
  section.allow(names(responses), "response");
  for (std::size_t r = 0; r < responses.size(); ++r) {
    const auto own = section.find(responses[r].name);
    if (own) study.analysis.limits.push_back({r, own->positive_quantity(responses[r].dimension)});
  }
  if (study.analysis.limits.empty()) value.fail("states no limit", "write a response with its limit, or leave it out");
}

/// A line for each limit, as for adaptive samples.
std::string response_limits_lines(const Study& study) {
  std::string text;
  for (const ResponseLimit& limit : study.analysis.limits) {
    const Response& response = study.model().responses[limit.response];
    text += fmt::format("limits.{} = {}\n", response.name, exact_value(limit.most, response.dimension));
  }
  return text;
}

std::string judge_line(const Study& study) {
  const bool idle = study.analysis.judge == Judge::rms && study.analysis.limits.empty();
  return idle ? "" : "judge = " + in_quotes(name(study.analysis.judge)) + "\n";
}

/// What a share of the draws stays within is part of a run's state, so `share` has its line even where limits are left
/// out (CheckpointIdentity).
std::string share_line(const Study& study) {
  return study.analysis.judge == Judge::share ? "share = " + shortest(study.analysis.share) + "\n" : "";
}

void check_judge(const StudySection& section, const Analysis& analysis) {
  const auto judge = section.find("judge");
  const auto share = section.find("share");
  if (analysis.judge == Judge::share && !share) {
    judge->fail("is \"share\", but analysis.share is missing",
                "write the share of the draws, e.g. share = " + row_of(analysis_keys(), "share").example);
  }
  if (analysis.judge != Judge::share && share) {
    share->fail("is set, but analysis.judge is \"rms\"", "write judge = \"share\", or leave it out");
  }
  if (judge && !section.find("limits")) {
    judge->fail("is set, but the study states no limit", "write [analysis.limits], or leave it out");
  }
}

/// The keys of [analysis] that several kinds have, in the order of the reference.
std::vector<StudyRow> shared_rows() {
  return {
      StudyRow{.name = "kind",
               .value = word_at<Kind>({{Kind::sensitivity, "what each error does on its own"},
                                       {Kind::identification, "which errors deform the mechanism at all"},
                                       {Kind::evaluate, "what named cases of fixed errors do"},
                                       {Kind::monte_carlo, "what all errors do together"},
                                       {Kind::coupling, "what sources of errors do one by one and together"}},
                                      &Study::analysis, &Analysis::kind),
               .meaning = "The kind of study."},
      StudyRow{.name = "factors",
               .value = {.type = "text or list of texts"},
               .usual = "in a sensitivity study deforming, where the model has that set; else all",
               .may_stay = true,
               .meaning = "The errors that vary or are tried: a factor set, all, or a list of factors.",
               .reader = read_studied_factors,
               .lines = factors_line},
      StudyRow{
          .name = "samples",
          .value = {.type = "integer or table",
                    .bounds = "at least 2",
                    .text = [](const Study& study) { return std::to_string(study.analysis.samples); }},
          .may_stay = true,
          .meaning = "Samples at each pose, of each varied error alone or of all together; or as many as it takes.",
          .reader = read_samples,
          .lines = samples_lines},
      StudyRow{.name = "conf_level",
               .value = number_at(between_0_and_1("0.95"), &Study::analysis, &Analysis::conf_level),
               .may_stay = true,
               .meaning = "Level of the confidence intervals."},
      StudyRow{.name = "background",
               .value = {.type = "table"},
               .usual = "none",
               .meaning = "Errors held constant while others vary; what varies, or what a case sets, is not held.",
               .reader = read_background,
               .lines = background_lines,
               .late = 2},
  };
}

std::vector<StudyRow> sensitivity_rows() {
  return {StudyRow{.name = "reference",
                   .value = {.type = "table"},
                   .usual = "the error of smallest effect, at 1 mm or 1 deg",
                   .meaning = "The error from which tolerances of equal effect are counted, and its own tolerance.",
                   .reader = read_reference,
                   .lines = reference_line,
                   .late = 1},
          StudyRow{.name = "linearity",
                   .value = number_at(between_0_and_1("0.01"), &Study::analysis, &Analysis::linearity),
                   .meaning =
                       "With fidelity = \"both\": an error whose effects differ by no more than this share is linear.",
                   .lines = linearity_line}};
}

std::vector<StudyRow> monte_carlo_rows() {
  return {StudyRow{
      .name = "quantiles", .value = quantiles(), .meaning = "Shares of the samples that lie below, ascending."}};
}

std::vector<StudyRow> identification_rows() {
  return {groups_row(), StudyRow{.name = "pose_share",
                                 .value = number_at(between_0_and_1("0.95"), &Study::analysis, &Analysis::pose_share),
                                 .meaning = "The share of the poses that a verdict asks for."}};
}

std::vector<StudyRow> limits_rows() {
  return {
      StudyRow{.name = "limits",
               .value = {.type = "table"},
               .usual = "none",
               .meaning =
                   "Limits of responses. The run ends with PASS or FAIL for each of them, and with exit code 6 if "
                   "one is not kept.",
               .reader = read_response_limits,
               .lines = response_limits_lines,
               .late = 1},
      StudyRow{.name = "judge",
               .value = word_at<Judge>(
                   {{Judge::rms,
                     "the response's root mean square over the draws of all poses is within the limit; "
                     "draws that were not solved are left out"},
                    {Judge::share,
                     "at every pose at least a share of the draws is within the limit; draws that were not solved are "
                     "not"}},
                   &Study::analysis, &Analysis::judge),
               .meaning = "When a limit is kept. (In an evaluation, if each case is within it at every pose.)",
               .lines = judge_line},
      StudyRow{.name = "share",
               .value = number_at(between_0_and_1("0.9973"), &Study::analysis, &Analysis::share),
               .usual = "",
               .example = "0.9973",
               .meaning = "With judge = \"share\", and required there: the share of the draws.",
               .lines = share_line}};
}

StudyTable response_limits_table() {
  return {.paths = {"analysis.limits"},
          .meaning = "'poesy models MODEL' lists the responses.",
          .keys = {{.name = "RESPONSE",
                    .type = "quantity",
                    .bounds = "greater than 0",
                    .usual = "none",
                    .meaning = "A value of this response is good up to here; one that has a sign, by its magnitude."}}};
}

void check_kind(const StudySection& section, const Study& study) {
  if (study.analysis.kind != Kind::identification || study.model().deformation) return;
  section.require("kind").fail(
      "is \"identification\", but nothing deforms in model \"" + study.model().name + "\"",
      "identification needs limbs that hold one platform against each other; choose another kind");
}

/// What a kind has where the study does not say it.
void complete(const StudySection& section, Study& study, const Reading& reading) {
  Analysis& analysis = study.analysis;
  if (analysis.kind == Kind::evaluate) {
    analysis.factors.clear();
    if (!analysis.cases.empty() || reading.use == StudyUse::evaluate) return;
    throw InputError(section.place(), "kind = \"evaluate\" needs at least one case",
                     "write [[analysis.cases]] with name and errors, or use 'poesy evaluate' for a table of errors");
  }
  if (analysis.kind == Kind::identification && analysis.groups.empty()) analysis.groups.push_back(usual_group());
  if (analysis.kind != Kind::coupling) return;
  complete_coupling(study, reading);
  analysis.factors = coupling_factors(analysis.coupling, study.model());
}

}  // namespace

std::vector<FactorIndex> read_factors(const StudyValue& value, const ModelDescription& model) {
  if (value.is_text()) return factors_of_set(value, model);
  std::vector<FactorIndex> factors;
  for (const StudyValue& element : value.list()) {
    const FactorIndex factor = factor_named(element, model);
    if (std::find(factors.begin(), factors.end(), factor) != factors.end()) {
      element.fail("names '" + model.factors[factor.value].name + "' a second time, but factors must differ",
                   "remove one of them");
    }
    factors.push_back(factor);
  }
  if (factors.empty()) value.fail("is empty", "name at least one factor, or a factor set");
  return factors;
}

std::span<const std::string_view> keys_of(Analysis::Kind kind) {
  return std::ranges::find(kinds(), kind, &KindKeys::kind)->keys;
}

const StudyRows& analysis_keys() {
  static const StudyRows keys = [] {
    StudyRows table{.paths = {"analysis"}, .meaning = "What is asked.", .chooser = "kind", .rows = shared_rows()};
    for (const auto& more : {sensitivity_rows(), monte_carlo_rows(), identification_rows(),
                             std::vector<StudyRow>{cases_row()}, limits_rows(), coupling_rows_of_keys()}) {
      table.rows.insert(table.rows.end(), more.begin(), more.end());
    }
    for (StudyRow& row : table.rows) {
      for (const KindKeys& kind : kinds()) {
        if (std::ranges::find(kind.keys, row.name) != kind.keys.end()) row.only_for.push_back(name(kind.kind));
      }
    }
    return table;
  }();
  return keys;
}

StudyTables analysis_tables() {
  StudyTables tables{described(analysis_keys()),   response_limits_table(),     described(adaptive_keys()),
                     described(background_keys()), described(reference_keys()), group_table()};
  const StudyTables cases = case_tables();
  tables.insert(tables.end(), cases.begin(), cases.end());
  tables.push_back(source_table());
  return tables;
}

void read_analysis(Study& study, const Reading& reading) {
  const StudySection section = reading.root.section("analysis");
  const bool runs = reading.use == StudyUse::run;
  section.allow();
  if (const auto kind = section.find("kind")) read_key(row_of(analysis_keys(), "kind"), *kind, study, reading);
  if (runs) check_kind(section, study);
  study.analysis.factors = usual_factors(study.analysis.kind, study.model());
  read_keys(analysis_keys(), section, study, reading, runs ? Extent::complete : Extent::any);
  check_judge(section, study.analysis);
  complete(section, study, reading);
}

}  // namespace poesy
