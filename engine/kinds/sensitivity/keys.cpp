#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/base/text.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/study/calibration_keys.h"
#include "engine/study/study.h"
#include "engine/study/study_kind.h"

namespace poesy::sensitivity {
namespace {

constexpr std::array<std::string_view, 7> kKeys{"factors",     "samples",   "conf_level", "background",
                                                "calibration", "linearity", "reference"};

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
  const FactorIndex named(factor.word(names(factors)));
  if (std::ranges::find(study.analysis.factors, named) == study.analysis.factors.end()) {
    factor.fail("is '" + factors[named.value].name + "', which this study does not vary", "name one of its factors");
  }
  const Dimension dimension = factors[named.value].dimension;
  const auto tolerance = section.find("tolerance");
  asked_of<Options>(study.analysis).reference = {
      named, tolerance ? tolerance->positive_quantity(dimension) : display_unit(dimension).si};
}

std::string reference_line(const Study& study) {
  const auto& reference = asked_of<Options>(study.analysis).reference;
  if (!reference) return {};
  const Factor& factor = study.model().factors[reference->factor.value];
  return fmt::format("reference = {{ factor = {}, tolerance = {} }}\n", in_quotes(factor.name),
                     exact_value(reference->tolerance, factor.dimension));
}

std::string shown_reference(const TemplateLines& lines, const Study& study) {
  if (study.model().factors.empty()) return {};
  const Factor& factor = study.model().factors.front();
  return lines.explanation_lines("analysis", "reference") + lines.keys_lines("analysis.reference") +
         fmt::format("# reference = {{ factor = {}, tolerance = {} }}\n", in_quotes(factor.name),
                     example_size(factor.dimension, 1.0));
}

KeyValue<Study> linearity() { return asked_value(number_at(between_0_and_1("0.01"), &Options::linearity)); }

std::string linearity_line(const Study& study) {
  return study.mechanism.compared ? "linearity = " + linearity().text(study) + "\n" : "";
}

/// The template's line for the key `linearity`; empty unless the model has two fidelities to compare.
std::string shown_linearity(const TemplateLines& lines, const Study& study) {
  return study.model().fidelities.size() == 2 ? lines.usual("analysis", "linearity", "# ") : "";
}

std::vector<StudyRow> sensitivity_rows() {
  return {StudyRow{.name = "reference",
                   .value = {.type = "table"},
                   .usual = "the error of smallest effect, at 1 mm or 1 deg",
                   .meaning = "The error from which tolerances of equal effect are counted, and its own tolerance.",
                   .reader = read_reference,
                   .lines = reference_line,
                   .late = 1,
                   .shown = shown_reference},
          StudyRow{.name = "linearity",
                   .value = linearity(),
                   .meaning =
                       "With fidelity = \"both\": an error whose effects differ by no more than this share is linear.",
                   .lines = linearity_line,
                   .shown = shown_linearity}};
}

void complete_sensitivity(Study& study, const Reading& reading) {
  if (reading.use != StudyUse::run) return;
  check_error_sizes(study, reading);
  const StudySection section = reading.root.section("analysis");
  check_simulated_machines(study, section);
  if (!study.mechanism.compared) return section.refuse("linearity", "a study without fidelity = \"both\"");
  if (const auto calibration = section.find("calibration")) {
    calibration->fail("is set, but mechanism.fidelity is \"both\", and a calibration solves at one fidelity",
                      "choose one fidelity, or remove the calibration");
  }
}

void check_reference(const StudySection& analysis, const Study& study, const Model& model) {
  const auto& reference = asked_of<Options>(study.analysis).reference;
  if (!reference) return;
  const auto problem = beyond_bound(model, reference->factor, reference->tolerance, "a tolerance");
  if (problem) refuse_error(analysis.section("reference"), "tolerance", *problem);
}

AtPose sensitivity_at_pose(const Study& study) {
  const auto factors = static_cast<double>(study.analysis.factors.size());
  const double solves = factors * static_cast<double>(study.analysis.samples);
  if (!study.mechanism.compared) return {factors, "factors", solves, "factors times samples"};
  return {factors, "factors", 2.0 * solves, "factors times samples times two fidelities"};
}

}  // namespace

const StudyKind kStudy{.name = "sensitivity",
                       .asks = "what each error does on its own",
                       .keys = kKeys,
                       .varies = Varies::one_by_one,
                       .compares_fidelities = true,
                       .usual_factors = "deforming",
                       .usual_background = "benign",
                       .rows = sensitivity_rows,
                       .tables = [] { return StudyTables{described(reference_keys())}; },
                       .complete = complete_sensitivity,
                       .check_errors = check_reference,
                       .at_pose = sensitivity_at_pose};

}  // namespace poesy::sensitivity
