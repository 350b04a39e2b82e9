#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "engine/base/name_pattern.h"
#include "engine/base/text.h"
#include "engine/model/leading_response.h"
#include "engine/study/calibration_keys.h"
#include "engine/study/limit_keys.h"
#include "engine/study/study_kind.h"
#include "engine/study/table_file.h"

namespace poesy {
namespace {

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
  if (written.find_first_of("*?") != std::string::npos) {
    value.fail("is '" + printable(written) + "', which is a pattern, not a set",
               "write it as a list: [\"" + printable(written) + "\"]");
  }
  std::vector<std::string_view> known = names(model.factor_sets);
  if (model.find_set("all") == nullptr) known.push_back("all");
  value.fail("is '" + printable(written) + "', which is not a factor set of the model", suggestion(written, known));
}

/// The factors that vary in a study of this kind if the study itself names none.
std::vector<FactorIndex> usual_factors(const StudyKind& kind, const ModelDescription& model) {
  const FactorSet* set = model.find_set(kind.usual_factors);
  return set != nullptr ? set->factors : all_factors(model);
}

void read_kind(const StudyValue& value, Study& study, const Reading& reading) {
  study.analysis.kind = reading.kinds.all[value.word(names(reading.kinds))];
}

void read_studied_factors(const StudyValue& value, Study& study, const Reading&) {
  study.analysis.factors = read_factors(value, study);
}

std::string factors_line(const Study& study) {
  return "factors = " + factors_text(study.analysis.factors, study.model()) + "\n";
}

std::string shown_factors(const TemplateLines& lines, const Study& study) {
  const std::string_view own = study.analysis.kind->usual_factors;
  const std::string_view usual = study.model().find_set(own) != nullptr ? own : "all";
  return "# Factor sets:\n" + sets_comment(study.model()) +
         lines.explained("analysis", "factors", fmt::format("factors = \"{}\"", usual));
}

/// The keys of the table [analysis.samples], with which a study asks for adaptive samples.
struct Adaptive {
  std::size_t min = AdaptiveSamples().min;
  std::size_t max = 0;
  double relative_error = 0.0;
  double conf_level = 0.0;  ///< confidence level of intervals; 0 if the table states none
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

KeyValue<Study> fixed_samples() {
  KeyValue<Study> value = whole_at(2, kMostSolves, &Study::analysis, &Analysis::samples);
  value.type = "integer or table";
  return value;
}

/// Reads the key `samples`: a number, or the table of adaptive samples. Throws InputError if this table and the key
/// `conf_level` state different confidence levels of intervals.
void read_samples(const StudyValue& value, Study& study, const Reading& reading) {
  Analysis& analysis = study.analysis;
  if (!value.is_section()) {
    fixed_samples().read(value, study);
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

/// The key `samples` as lines of the study's resolved_text(). Each key of adaptive samples has its own line, so that a
/// line-by-line comparison of two studies shows which key differs.
std::string samples_lines(const Study& study) {
  const Analysis& analysis = study.analysis;
  if (!analysis.adaptive) return fmt::format("samples = {}\n", analysis.samples);
  return fmt::format("samples.min = {}\nsamples.max = {}\nsamples.relative_error = {}\n", analysis.adaptive->min,
                     analysis.samples, shortest(analysis.adaptive->relative_error));
}

std::string shown_samples(const TemplateLines& lines, const Study&) {
  return lines.usual("analysis", "samples") + lines.keys_lines("analysis.samples") +
         "# samples = " + lines.inline_table("analysis.samples") + "\n";
}

/// The line of the key `relative` of the background; empty if the value is 0.
std::string relative_line(const Background& background) {
  return background.relative == 0.0 ? "" : "relative = " + shortest(background.relative) + "\n";
}

const InnerRows<Background>& background_keys() {
  static const InnerRows<Background> keys{
      .paths = {"analysis.background"},
      .meaning = "Errors held constant.",
      .rows = {InnerRow<Background>{
                   .name = "factors",
                   .value = {.type = "text or list of texts"},
                   .missing = "write a factor set or a list of factors",
                   .meaning = "The errors that are held: a factor set, all, or a list of factors and patterns."},
               InnerRow<Background>{.name = "linear",
                                    .value = quantity_at(Dimension::length, &Background::linear),
                                    .usual = "the standard deviation of linear in [errors]",
                                    .meaning = "The value of those that are lengths."},
               InnerRow<Background>{.name = "angular",
                                    .value = quantity_at(Dimension::angle, &Background::angular),
                                    .usual = "the standard deviation of angular in [errors]",
                                    .meaning = "The value of those that are angles."},
               InnerRow<Background>{.name = "relative",
                                    .value = quantity_at(Dimension::number, &Background::relative),
                                    .usual = "the standard deviation of relative in [errors]",
                                    .meaning = "The value of those that are numbers.",
                                    .lines = relative_line}}};
  return keys;
}

/// Reads the background (errors that are constant while others vary). By default, a constant error equals the standard
/// deviation of the study's errors of the same dimension.
void read_background(const StudyValue& value, Study& study, const Reading& reading) {
  const StudySection section = value.section();
  Background background{.factors = {},
                        .linear = usual_distribution(reading, Dimension::length).standard_deviation(),
                        .angular = usual_distribution(reading, Dimension::angle).standard_deviation(),
                        .relative = usual_distribution(reading, Dimension::number).standard_deviation()};
  read_keys(background_keys(), section, background, Nothing());
  background.factors = read_factors(section.require("factors"), study);
  const auto is_number = [&](FactorIndex factor) {
    return study.model().factors[factor.value].dimension == Dimension::number;
  };
  if (std::ranges::none_of(background.factors, is_number)) background.relative = 0.0;
  study.analysis.background = std::move(background);
}

std::string background_lines(const Study& study) {
  if (!study.analysis.background) return {};
  const Background& background = *study.analysis.background;
  return "\n[analysis.background]\nfactors = " + factors_text(background.factors, study.model()) + "\n" +
         keys_text(background_keys(), background);
}

/// The template's lines of the key `background`. They show the set of constant errors StudyKind::usual_background, or
/// an example in a comment if the model lacks this set.
std::string shown_background(const TemplateLines& lines, const Study& study) {
  const std::string_view held = study.analysis.kind->usual_background;
  return lines.explanation_lines("analysis", "background") + lines.keys_lines("analysis.background") +
         (study.model().find_set(held) != nullptr ? fmt::format("background = {{ factors = \"{}\" }}\n", held)
                                                  : "# background = { factors = \"all\" }\n");
}

/// Reads the key `calibrated`. build_model() checks later whether the model supports it.
void read_calibrated(const StudyValue& value, Study& study, const Reading&) {
  study.mechanism.calibrated = value.yes_or_no();
  study.mechanism.calibrated_place = value.place();
}

std::string calibrated_line(const Study& study) { return study.mechanism.calibrated ? "calibrated = true\n" : ""; }

/// The template's line of the key `calibrated`; empty for models whose drives cannot be corrected.
std::string shown_calibrated(const TemplateLines& lines, const Study& study) {
  return study.model().separation ? lines.usual("analysis", "calibrated") : "";
}

void read_limits(const StudyValue& value, Study& study, const Reading&) { read_response_limits(value, study); }

std::string shown_limits(const TemplateLines& lines, const Study& study) {
  return template_limits(lines, study.model(), "# ");
}

/// The keys of [analysis] that several kinds of study have, in the order of the reference.
std::vector<StudyRow> shared_rows() {
  return {
      StudyRow{
          .name = "kind",
          .value = {.type = "text", .text = [](const Study& study) { return in_quotes(study.analysis.kind->name); }},
          .usual = "",
          .meaning = "The kind of study.",
          .reader = read_kind},
      StudyRow{.name = "factors",
               .value = {.type = "text or list of texts"},
               .usual = "all",
               .may_stay = true,
               .meaning =
                   "The errors that vary or are tried: a factor set, all, or a list of factors and of patterns such as "
                   "\"rod_*\".",
               .reader = read_studied_factors,
               .lines = factors_line,
               .shown = shown_factors},
      StudyRow{
          .name = "samples",
          .value = fixed_samples(),
          .may_stay = true,
          .meaning = "Samples at each pose, of each varied error alone or of all together; or as many as it takes.",
          .reader = read_samples,
          .lines = samples_lines,
          .shown = shown_samples},
      StudyRow{.name = "draws",
               .value = word_at<Draws>(
                   {{Draws::per_pose, "anew at each pose, so that poses are independent"},
                    {Draws::per_machine,
                     "once for all poses: each sample is a machine with its errors, which has them wherever it goes"}},
                   &Study::analysis, &Analysis::draws),
               .usual = "`\"per machine\"`",
               .meaning = "Where errors are drawn."},
      StudyRow{.name = "calibrated",
               .value = {.type = "true or false"},
               .usual = "`false`",
               .meaning =
                   "Whether responses are what remains with the drives corrected at each pose so that the "
                   "platform's points (`metric_points` of a mechanism from a file) are best. For another "
                   "point, such as the tool, a calibration can be better; so put `metric_points` around the "
                   "point with the limit. For mechanisms of which sensitivity studies say what calibration can remove.",
               .reader = read_calibrated,
               .lines = calibrated_line,
               .shown = shown_calibrated},
      StudyRow{.name = "conf_level",
               .value = number_at(between_0_and_1("0.95"), &Study::analysis, &Analysis::conf_level),
               .may_stay = true,
               .meaning = "Level of the confidence intervals."},
      StudyRow{
          .name = "background",
          .value = {.type = "table"},
          .usual = "none",
          .meaning =
              "Errors held constant while others vary. An error that varies must not be named here; in a set it is "
              "ignored. Errors that a case sets are not held.",
          .reader = read_background,
          .lines = background_lines,
          .late = 2,
          .shown = shown_background},
      StudyRow{.name = "limits",
               .value = {.type = "table"},
               .usual = "none",
               .meaning =
                   "Limits of responses. The run ends with PASS or FAIL for each of them, and with exit code 6 if "
                   "one is not kept.",
               .reader = read_limits,
               .lines = response_limits_lines,
               .late = 1,
               .shown = shown_limits},
      calibration_row(),
  };
}

StudyRows shared_table() {
  return {.paths = {"analysis"}, .meaning = "What is asked.", .chooser = "kind", .rows = shared_rows()};
}

std::vector<StudyRow> own_rows(const StudyKind& kind) {
  return kind.rows == nullptr ? std::vector<StudyRow>() : kind.rows();
}

/// Returns true if the kind has its own key of this name, which replaces the shared key.
bool has_own_row(const StudyKind& kind, std::string_view name) {
  return std::ranges::count(own_rows(kind), name, &StudyRow::name) > 0;
}

/// Completes the shared keys of [analysis] for the reference: sets `only_for` of each key to the kinds of study that
/// have the key, and describes the key `kind`. In `only_for`, kinds that have the key `factors` come first.
void describe_kinds(StudyRows& table, std::span<const StudyKind* const> kinds) {
  std::vector<const StudyKind*> listed(kinds.begin(), kinds.end());
  std::stable_partition(listed.begin(), listed.end(), [](const StudyKind* kind) { return kind->has_key("factors"); });
  for (StudyRow& row : table.rows) {
    if (!row.only_for.empty()) continue;
    for (const StudyKind* kind : listed) {
      if (kind->has_key(row.name) && !has_own_row(*kind, row.name)) row.only_for.push_back(kind->name);
    }
  }
  StudyRow& row = table.rows.front();
  row.usual = "`" + in_quotes(kinds.front()->name) + "`";
  for (const StudyKind* kind : kinds) row.value.words.push_back({kind->name, kind->asks});
}

/// The factors that vary by default, in words: for each kind with StudyKind::usual_factors the name of this set, then
/// the default of all other studies.
std::string usual_factors_text(std::span<const StudyKind* const> kinds) {
  std::string text;
  for (const StudyKind* kind : kinds) {
    if (kind->usual_factors.empty()) continue;
    text += fmt::format("in a {} study the set `{}` if the model has it; ", kind->name, kind->usual_factors);
  }
  return text + (text.empty() ? "all" : "otherwise all");
}

}  // namespace

namespace {

/// Adds to `factors` the model's factors whose names match the pattern and that are not in the list yet.
void add_matching(const StudyValue& pattern, const Study& study, std::vector<FactorIndex>& factors) {
  const ModelDescription& model = study.model();
  bool any = false;
  for (std::size_t f = 0; f < model.factors.size(); ++f) {
    if (!matches(pattern.text(), model.factors[f].name)) continue;
    any = true;
    if (std::ranges::find(factors, FactorIndex(f)) == factors.end()) factors.emplace_back(f);
  }
  if (!any) pattern.fail("matches no error of the mechanism", listed_by_models(study));
}

}  // namespace

std::string listed_by_models(const Study& study) {
  const std::string& name = study.mechanism.file ? study.mechanism.file->name : study.model().name;
  return "'poesy models " + printable(name) + "' lists them";
}

std::vector<FactorIndex> read_factors(const StudyValue& value, const Study& study) {
  const ModelDescription& model = study.model();
  if (value.is_text()) return factors_of_set(value, model);
  std::vector<FactorIndex> factors;
  for (const StudyValue& element : value.list()) {
    if (element.is_text() && is_pattern(element.text())) {
      add_matching(element, study, factors);
      continue;
    }
    const FactorIndex factor(element.word(names(model.factors)));
    if (std::find(factors.begin(), factors.end(), factor) != factors.end()) {
      element.fail("names '" + model.factors[factor.value].name + "' a second time, but factors must differ",
                   "remove one of them");
    }
    factors.push_back(factor);
  }
  if (factors.empty()) value.fail("is empty", "name at least one factor, or a factor set");
  return factors;
}

std::string factors_text(std::span<const FactorIndex> factors, const ModelDescription& model) {
  const std::string set = set_name(factors, model);
  return set.empty() ? factor_list_text(factors, model) : in_quotes(set);
}

std::string factor_list_text(std::span<const FactorIndex> factors, const ModelDescription& model) {
  std::string text = "[";
  for (const FactorIndex factor : factors) text += "\n  " + in_quotes(model.factors[factor.value].name) + ",";
  return text + "\n]";
}

std::string example_limits(const ModelDescription& model) {
  const std::vector<Response>& responses = model.responses;
  if (responses.empty()) return {};
  const auto rank = [](const Response& one) {
    return std::pair(leading_rank(one.name), one.dimension != Dimension::length);
  };
  const Response& response = *std::ranges::min_element(responses, {}, rank);
  return fmt::format("{{ {} = {} }}", response.name, example_size(response.dimension, 0.05));
}

std::string template_limits(const TemplateLines& lines, const ModelDescription& model, std::string_view sign) {
  if (model.responses.empty()) return {};
  return comment(fmt::format("Responses: {}", fmt::join(names(model.responses), " "))) +
         lines.explained("analysis", "limits", fmt::format("{}limits = {}", sign, example_limits(model))) +
         lines.explanation_lines("analysis.limits", "RESPONSE") + lines.keys_lines("analysis.limits.RESPONSE");
}

std::string read_name(const StudySection& section, std::span<const std::string_view> taken, const std::string& usual) {
  const auto value = section.find("name");
  const std::string name = value ? value->text() : usual;
  if (const auto problem = value ? label_problem(name) : std::nullopt) {
    value->fail("is '" + printable(name) + "', which " + *problem, kLabelRule);
  }
  if (std::ranges::find(taken, name) == taken.end()) return name;
  if (value) value->fail("is '" + printable(name) + "', which another one has", "give each a name of its own");
  throw InputError(section.place(), "it has no name, and '" + name + "' is taken", "write name = \"...\"");
}

StudyRows analysis_keys(const StudyKind& kind) {
  StudyRows table = shared_table();
  for (StudyRow& row : own_rows(kind)) {
    const auto shared = std::ranges::find(table.rows, row.name, &StudyRow::name);
    if (shared == table.rows.end()) {
      table.rows.push_back(std::move(row));
    } else {
      *shared = std::move(row);
    }
  }
  return table;
}

StudyRow shared_analysis_row(std::string_view name) { return row_of(shared_table(), name); }

StudyTables analysis_tables(std::span<const StudyKind* const> kinds, std::span<const std::string_view> order) {
  StudyRows table = shared_table();
  for (const StudyKind* kind : kinds) {
    for (StudyRow& row : own_rows(*kind)) {
      row.only_for = {kind->name};
      table.rows.push_back(std::move(row));
    }
  }
  describe_kinds(table, kinds);
  std::ranges::find(table.rows, "factors", &StudyRow::name)->usual = usual_factors_text(kinds);
  std::ranges::stable_sort(table.rows, {}, [&](const StudyRow& row) { return std::ranges::find(order, row.name); });
  StudyTables tables{described(table)};
  for (StudyTable& limits : limit_tables()) tables.push_back(std::move(limits));
  tables.push_back(described(adaptive_keys()));
  tables.push_back(described(background_keys()));
  for (StudyTable& calibration : calibration_tables()) tables.push_back(std::move(calibration));
  for (const StudyKind* kind : kinds) {
    if (kind->tables == nullptr) continue;
    for (StudyTable& inner : kind->tables()) tables.push_back(std::move(inner));
  }
  return tables;
}

void read_analysis(Study& study, const Reading& reading) {
  const StudySection section = reading.root.section("analysis");
  const bool runs = reading.use == StudyUse::run;
  section.allow();
  study.analysis.kind = reading.kinds.all.front();
  if (const auto word = section.find("kind")) read_kind(*word, study, reading);
  const StudyKind& kind = *study.analysis.kind;
  if (const auto refusal = runs && kind.refusal != nullptr ? kind.refusal(study.model()) : std::nullopt) {
    section.require("kind").fail("is " + in_quotes(kind.name) + ", but " + refusal->problem, refusal->remedy);
  }
  if (runs) refuse_calibration(section, study, reading.kinds);
  study.analysis.draws = kind.draws;
  study.analysis.factors = usual_factors(kind, study.model());
  read_keys(analysis_keys(kind), section, study, reading, runs ? Extent::complete : Extent::any);
  if (kind.complete != nullptr) kind.complete(study, reading);
}

}  // namespace poesy
