#include "engine/study/calibration_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <set>

#include "engine/base/name_pattern.h"
#include "engine/base/text.h"
#include "engine/study/calibration.h"
#include "engine/study/fitted_keys.h"
#include "engine/study/machine_file.h"
#include "engine/study/table_file.h"

namespace poesy {
namespace {

constexpr std::int64_t kMostRepeats = 1'000'000;
constexpr std::int64_t kMostNext = 1000;
/// The six responses that the word "pose" in the key `measured` selects.
constexpr std::array<std::string_view, 6> kWholePose{"x", "y", "z", "theta_x", "theta_y", "theta_z"};

/// What the readers of the keys of [analysis.calibration] need in addition to the key's value.
struct CalibrationReading {
  const Study& study;
  const Reading& reading;
  StudySection section;
};

using CalibrationRow = Key<CalibrationTable, CalibrationReading>;
using CalibrationKeys = Keys<CalibrationTable, CalibrationReading>;

void read_fit(const StudyValue& value, CalibrationTable& table, const CalibrationReading& at) {
  table.fit = read_fitted(value, at.section, at.study);
}

/// The response of this name. Throws InputError if the response is unknown or has no sign.
const Response& signed_response(const StudyValue& value, const std::string& word, const ModelDescription& model) {
  const auto found = std::ranges::find(model.responses, word, &Response::name);
  if (found == model.responses.end()) {
    std::vector<std::string_view> known;
    for (const Response& response : model.responses) {
      if (!response.is_magnitude()) known.push_back(response.name);
    }
    known.insert(known.end(), {kMeasuredPose, kMeasuredDistance});
    value.fail("is '" + printable(word) + "', which cannot be measured", suggestion(word, known));
  }
  if (found->is_magnitude()) {
    std::string remedy = "measure responses with a sign";
    if (!found->components.empty()) {
      std::vector<std::string> parts;
      for (const std::size_t r : found->components) parts.push_back(model.responses[r].name);
      remedy = fmt::format("measure {}", fmt::join(parts, ", "));
    }
    value.fail("is '" + word + "', which has no sign", remedy);
  }
  return *found;
}

void read_measured(const StudyValue& value, CalibrationTable& table, const CalibrationReading& at) {
  table.measured_place = value.place();
  for (const StudyValue& element : value.list()) {
    const std::string word = element.text();
    if (word != kMeasuredPose && word != kMeasuredDistance)
      static_cast<void>(signed_response(element, word, at.study.model()));
    if (std::ranges::find(table.measured, word) != table.measured.end()) {
      element.fail("names '" + word + "' a second time", "remove one of them");
    }
    table.measured.push_back(word);
  }
  if (table.measured.empty()) value.fail("is empty", "name what is measured, e.g. [\"z\"]");
}

void read_noise(const StudyValue& value, CalibrationTable& table, const CalibrationReading& at) {
  for (const auto& [key, level] : in_order(value.section())) {
    const Dimension dimension =
        key == kMeasuredDistance ? Dimension::length : signed_response(level, key, at.study.model()).dimension;
    const double sd = level.is_zero() ? 0.0 : level.quantity(dimension);
    if (sd < 0.0) level.fail("is below zero", "write a standard deviation, or 0");
    table.noise.push_back({key, sd});
  }
  if (table.noise.empty()) value.fail("is empty", "write e.g. { z = \"5 um\" }");
}

/// Reads a table that selects poses with the same keys as [poses].
PoseSelection read_selection(const StudyValue& value, const CalibrationReading& at) {
  Study other;
  other.mechanism = at.study.mechanism;
  read_pose_selection(value.section(), other, at.reading);
  return std::move(other.poses);
}

void read_poses(const StudyValue& value, CalibrationTable& table, const CalibrationReading& at) {
  table.poses = read_selection(value, at);
}

void read_candidates(const StudyValue& value, CalibrationTable& table, const CalibrationReading& at) {
  table.candidates = read_selection(value, at);
}

void read_pairs(const StudyValue& value, CalibrationTable& table, const CalibrationReading&) {
  table.pairs_place = value.place();
  for (const StudyValue& pair : value.list()) {
    const auto ends = pair.list(2, "write the positions of two poses: [0, 3]");
    const auto position = [](const StudyValue& end) {
      return static_cast<std::size_t>(end.whole_number(0, kMostPoses));
    };
    table.pairs.push_back({position(ends[0]), position(ends[1])});
    if (table.pairs.back()[0] == table.pairs.back()[1]) pair.fail("is one pose twice", "write two different poses");
  }
}

void read_prior(const StudyValue& value, CalibrationTable& table, const CalibrationReading& at) {
  constexpr std::array<std::string_view, 2> kWords{"none", "tolerances"};
  table.prior = static_cast<PriorKnowledge>(value.word(kWords));
  if (table.prior == PriorKnowledge::none) return;
  for (const FittedErrors& fitted : table.fit) {
    for (const FactorIndex factor : fitted.factors) {
      if (std::ranges::binary_search(table.with_tolerance, factor)) continue;
      value.fail(
          "is \"tolerances\", and " + at.study.model().factors[factor.value].name + " has no tolerance in [errors]",
          "state it there, or write prior = \"none\"");
    }
  }
}

/// Throws InputError if the element names a position, such as tip_x, that the mechanism has as a response but not as a
/// coordinate of its poses. known: all coordinates that a controller may command.
void refuse_position(const StudyValue& element, const Study& study, const std::vector<std::string_view>& known) {
  const ModelDescription& model = study.model();
  const std::string word = element.text();
  const auto response = std::ranges::find(model.responses, word, &Response::name);
  const bool is_position =
      response != model.responses.end() && response->dimension == Dimension::length && !response->is_magnitude();
  if (!is_position || std::ranges::find(known, word) != known.end()) return;
  element.fail(fmt::format("is '{}', but the coordinates of this mechanism are {}", word, fmt::join(known, ", ")),
               study.mechanism.file ? "use x, y, z as coordinates of the platform in the mechanism's file, so that a "
                                      "controller can command a position"
                                    : "name some of these");
}

void read_coordinates(const StudyValue& value, CalibrationTable& table, const CalibrationReading& at) {
  const ModelDescription& model = at.study.model();
  table.coordinates_place = value.place();
  std::vector<std::string_view> known = names(model.pose_coordinates);
  for (const PoseChart& chart : model.charts) {
    if (chart.name == "actuators") continue;
    for (const PoseCoordinate& other : chart.coordinates) {
      if (std::ranges::find(known, other.name) == known.end()) known.push_back(other.name);
    }
  }
  for (const StudyValue& element : value.list()) {
    refuse_position(element, at.study, known);
    const std::string word(known[element.word(known)]);
    if (std::ranges::find(table.coordinates, word) != table.coordinates.end()) {
      element.fail("names '" + word + "' a second time", "remove one of them");
    }
    table.coordinates.push_back(word);
  }
  if (table.coordinates.size() == model.pose_coordinates.size()) return;
  value.fail(
      fmt::format("has {} coordinates, but a pose has {}", table.coordinates.size(), model.pose_coordinates.size()),
      fmt::format("name as many as {}", fmt::join(names(model.pose_coordinates), ", ")));
}

void read_motors(const StudyValue& value, CalibrationTable& table, const CalibrationReading& at) {
  const ModelDescription& model = at.study.model();
  std::set<std::string> seen;
  for (const StudyValue& motor : value.list()) {
    std::vector<std::string>& drives = table.motors.emplace_back();
    for (const StudyValue& drive : motor.list()) {
      const std::string word(names(model.joints)[drive.word(names(model.joints))]);
      if (!seen.insert(word).second) drive.fail("names '" + word + "' a second time", "a drive has one motor");
      drives.push_back(word);
    }
    if (drives.empty()) motor.fail("is empty", "name the drives that this motor moves");
  }
  if (table.motors.size() == model.pose_coordinates.size()) return;
  value.fail(fmt::format("has {} motors, but there are {} commanded coordinates", table.motors.size(),
                         model.pose_coordinates.size()),
             "say which drives move together, as many motors as coordinates");
}

void read_present(const StudyValue& value, CalibrationTable& table, const CalibrationReading&) {
  const StudySection section = value.section();
  section.allow(names(table.fit), "fitted error");
  table.present.assign(table.fit.size(), 0.0);
  for (std::size_t n = 0; n < table.fit.size(); ++n) {
    const auto own = section.find(table.fit[n].name);
    if (own) table.present[n] = own->is_zero() ? 0.0 : own->quantity(table.fit[n].dimension);
  }
}

void read_controller(const StudyValue& value, CalibrationTable& table, const CalibrationReading&) {
  for (const auto& [key, expression] : in_order(value.section())) {
    if (const auto problem = label_problem(key)) {
      expression.fail("has the name '" + printable(key) + "', which " + *problem, std::string(kLabelRule));
    }
    table.controller.push_back({key, expression.text(), expression.place()});
  }
}

/// Throws InputError if the noise of a measured quantity is missing, if distances are measured but no pairs of poses
/// are stated, or if pairs are stated but no distances are measured.
void check_measured(const CalibrationTable& table, const StudySection& section) {
  const bool measures_distances = std::ranges::find(table.measured, kMeasuredDistance) != table.measured.end();
  if (measures_distances && table.pairs.empty()) {
    section.require("measured")
        .fail("has 'distance', but analysis.calibration.pairs names no poses",
              "write the poses between which distances are measured: pairs = [[0, 3]]");
  }
  if (!table.pairs.empty() && !table.measured.empty() && !measures_distances) {
    section.require("pairs").fail("is set, but analysis.calibration.measured has no \"distance\"",
                                  "add it there, or remove pairs");
  }
  for (const std::string& word : table.measured) {
    const std::span<const std::string_view> whole = kWholePose;
    const std::array<std::string_view, 1> alone{word};
    for (const std::string_view needed : word == kMeasuredPose ? whole : std::span<const std::string_view>(alone)) {
      if (std::ranges::find(table.noise, needed, &StatedNoise::what) != table.noise.end()) continue;
      const StudyValue value = section.require("measured");
      value.fail(
          fmt::format("has '{}', but analysis.calibration.noise does not say how well {} is measured", word, needed),
          fmt::format("write noise.{} = \"...\", or 0", needed));
    }
  }
}

template <class Enum>
KeyValue<CalibrationTable> choice(std::vector<WordFor<Enum>> words, Enum CalibrationTable::*member) {
  return word_at<Enum>(std::move(words), member);
}

std::vector<CalibrationRow> calibration_rows() {
  return {
      CalibrationRow{.name = "fit",
                     .value = {.type = "text or list of texts"},
                     .missing = "name the errors that the controller can correct, e.g. {}",
                     .example = "[\"zero_*\", \"radius\"]",
                     .meaning = "The fitted errors: errors, patterns, sets, and names of combinations.",
                     .reader = read_fit},
      CalibrationRow{
          .name = "combinations",
          .value = {.type = "table"},
          .usual = "none",
          .meaning = "Errors that are fitted by one number, each its factor times the number. A name may be a pattern, "
                     "\"rod_*\"; of keys that fit an error the last one counts."},
      CalibrationRow{.name = "measured",
                     .value = {.type = "list of texts"},
                     .usual = "",
                     .meaning = "For studies: what is measured, responses with a sign, \"pose\" (x, y, z and theta_x, "
                                "theta_y, theta_z) or \"distance\".",
                     .reader = read_measured},
      CalibrationRow{.name = "noise",
                     .value = {.type = "table"},
                     .usual = "none",
                     .meaning =
                         "The standard deviation of one measured value of each quantity; for `poesy calibrate` of "
                         "each column without a column sd_.",
                     .reader = read_noise},
      CalibrationRow{.name = "poses",
                     .value = {.type = "table"},
                     .usual = "the study's poses",
                     .meaning = "For studies: where it is measured, a table as [poses].",
                     .reader = read_poses},
      CalibrationRow{.name = "pairs",
                     .value = {.type = "list of pairs of integers"},
                     .usual = "none",
                     .meaning = "For studies: the poses, from 0, between which distances are measured.",
                     .reader = read_pairs},
      CalibrationRow{.name = "repeats",
                     .value = whole_at(1, kMostRepeats, &CalibrationTable::repeats),
                     .meaning = "Each value is the mean of so many, so its noise is divided by their square root."},
      CalibrationRow{
          .name = "frame",
          .value = choice<MeasuringFrame>(
              {{MeasuringFrame::known, "the device measures in the base's frame"},
               {MeasuringFrame::height, "its zero of heights is unknown (1 number)"},
               {MeasuringFrame::plane, "heights are measured from a plane, a bed, with unknown height and slopes (3)"},
               {MeasuringFrame::rigid, "all of its frame is unknown (6)"}},
              &CalibrationTable::frame),
          .meaning = "What is unknown of the frame of the measuring device, and fitted too."},
      CalibrationRow{.name = "target",
                     .value = choice<MeasuredTarget>({{MeasuredTarget::known, "P or the point of the tool"},
                                                      {MeasuredTarget::point, "an unknown point of the platform (3)"},
                                                      {MeasuredTarget::rigid, "a point and axes that are unknown (6)"}},
                                                     &CalibrationTable::target),
                     .meaning = "What is unknown of the place on the platform that is measured, and fitted too."},
      CalibrationRow{.name = "prior",
                     .value = choice<PriorKnowledge>(
                         {{PriorKnowledge::none, "least squares, as firmware does"},
                          {PriorKnowledge::tolerances, "the distributions in [errors] count as knowledge (Bayesian)"}},
                         &CalibrationTable::prior),
                     .meaning = "What is known of the fitted errors before they are measured.",
                     .reader = read_prior},
      CalibrationRow{.name = "sd",
                     .value = choice<NoiseLevel>(
                         {{NoiseLevel::given, "the noise is as stated"},
                          {NoiseLevel::estimated, "it is known up to one factor, which follows from the residual"}},
                         &CalibrationTable::sd),
                     .meaning = "For `poesy calibrate`: whether the noise is known."},
      CalibrationRow{
          .name = "coordinates",
          .value = {.type = "list of texts"},
          .usual = "the platform's coordinates",
          .meaning = "What the controller commands: other coordinates of a pose, such as tip_x, tip_y, tip_z, which "
                     "a mechanism with a tool has if the coordinates of its platform are x, y, z.",
          .reader = read_coordinates},
      CalibrationRow{.name = "motors",
                     .value = {.type = "list of lists of texts"},
                     .usual = "each drive is one",
                     .meaning = "Drives that move together, as many motors as coordinates.",
                     .reader = read_motors},
      CalibrationRow{.name = "present",
                     .value = {.type = "table"},
                     .usual = "none",
                     .meaning = "For `poesy calibrate`: fitted errors that the controller corrected while it measured. "
                                "Estimates are totals, not increments.",
                     .reader = read_present},
      CalibrationRow{.name = "controller",
                     .value = {.type = "table"},
                     .usual = "none",
                     .meaning = "For `poesy calibrate`: numbers to be typed in, as expressions in parameters of the "
                                "geometry and fitted errors.",
                     .reader = read_controller},
      CalibrationRow{.name = "next",
                     .value = whole_at(0, kMostNext, &CalibrationTable::next),
                     .meaning = "For `poesy calibrate`: how many poses to propose that tell most."},
      CalibrationRow{.name = "candidates",
                     .value = {.type = "table"},
                     .usual = "the study's poses",
                     .meaning = "The poses from which these are chosen, a table as [poses].",
                     .reader = read_candidates},
  };
}

const CalibrationKeys& calibration_keys() {
  static const CalibrationKeys keys{
      .paths = {"analysis.calibration"},
      .meaning = "How a machine is calibrated: few numbers, fitted to what is measured of it.",
      .rows = calibration_rows()};
  return keys;
}

void read_calibration(const StudyValue& value, Study& study, const Reading& reading) {
  const CalibrationReading at{study, reading, value.section()};
  auto table = std::make_shared<CalibrationTable>();
  table->place = value.place();
  table->with_tolerance = errors_with_tolerance(study, reading.root);
  read_keys(calibration_keys(), at.section, *table, at);
  check_measured(*table, at.section);
  if (study.mechanism.calibrated) {
    value.fail("is set beside calibrated = true, which takes away the best correction of each pose",
               "remove one of them");
  }
  study.analysis.calibration = std::move(table);
}

std::string quoted_list(const std::vector<std::string>& texts) {
  std::vector<std::string> quoted;
  for (const std::string& text : texts) quoted.push_back(in_quotes(text));
  return list_text(quoted);
}

std::string combination_line(const FittedErrors& fitted, const ModelDescription& model) {
  std::vector<std::string> weights;
  for (std::size_t n = 0; n < fitted.factors.size(); ++n) {
    const Factor& factor = model.factors[fitted.factors[n].value];
    const std::string number = shortest(fitted.weights[n]);
    const std::string unit = fmt::format(" {}/{}", si_unit(factor.dimension), si_unit(fitted.dimension));
    weights.push_back(factor.name + " = " + (factor.dimension == fitted.dimension ? number : in_quotes(number + unit)));
  }
  return fmt::format("combinations.{} = {{ {} }}\n", fitted.name, fmt::join(weights, ", "));
}

bool is_single(const FittedErrors& fitted, const ModelDescription& model) {
  return model.factors[fitted.factors.front().value].name == fitted.name;
}

/// The lines of a table [analysis.calibration.KEY] that selects poses.
std::string selection_lines(std::string_view key, const PoseSelection& selection, const Study& study) {
  Study other;
  other.mechanism = study.mechanism;
  other.poses = selection;
  return fmt::format("\n[analysis.calibration.{}]\n", key) + keys_text(poses_keys(), other);
}

std::string calibration_lines(const Study& study) {
  if (!study.analysis.calibration) return {};
  const CalibrationTable& table = *study.analysis.calibration;
  const ModelDescription& model = study.model();
  std::vector<std::string> fit;
  for (const FittedErrors& fitted : table.fit) fit.push_back(fitted.name);
  std::string text = "\n[analysis.calibration]\nfit = " + quoted_list(fit) + "\n";
  for (const FittedErrors& fitted : table.fit) {
    if (!is_single(fitted, model)) text += combination_line(fitted, model);
  }
  if (!table.measured.empty()) text += "measured = " + quoted_list(table.measured) + "\n";
  for (const StatedNoise& noise : table.noise) {
    const auto response = std::ranges::find(model.responses, noise.what, &Response::name);
    const Dimension dimension = response == model.responses.end() ? Dimension::length : response->dimension;
    text += fmt::format("noise.{} = {}\n", noise.what, exact_value(noise.sd, dimension));
  }
  if (!table.pairs.empty()) {
    std::vector<std::string> pairs;
    for (const auto& [one, other] : table.pairs) pairs.push_back(fmt::format("[{}, {}]", one, other));
    text += "pairs = " + list_text(pairs) + "\n";
  }
  text += keys_text(calibration_keys(), table);
  if (!table.coordinates.empty()) text += "coordinates = " + quoted_list(table.coordinates) + "\n";
  if (!table.motors.empty()) {
    std::vector<std::string> motors;
    for (const auto& drives : table.motors) motors.push_back(quoted_list(drives));
    text += "motors = " + list_text(motors) + "\n";
  }
  for (std::size_t n = 0; n < table.present.size(); ++n) {
    text += fmt::format("present.{} = {}\n", table.fit[n].name, exact_value(table.present[n], table.fit[n].dimension));
  }
  for (const ControllerNumber& number : table.controller) {
    text += fmt::format("controller.{} = {}\n", in_quotes(number.name), in_quotes(number.text));
  }
  if (table.poses) text += selection_lines("poses", *table.poses, study);
  if (table.candidates) text += selection_lines("candidates", *table.candidates, study);
  return text;
}

/// Comment lines of a template with a calibration of one error as an example; empty if the model has no errors, or no
/// response that can be measured (measurable()).
std::string shown_calibration(const TemplateLines& lines, const Study& study) {
  const ModelDescription& model = study.model();
  const std::vector<std::string_view> known = measurable(model);
  if (known.empty() || model.factors.empty()) return {};
  const auto height = std::ranges::find(known, "z");
  const std::string what(height == known.end() ? known.front() : *height);
  const Dimension dimension = std::ranges::find(model.responses, what, &Response::name)->dimension;
  return lines.explained("analysis", "calibration",
                         fmt::format("# calibration = {{ fit = [\"{}\"], measured = [\"{}\"], noise = {{ {} = {} }} }}",
                                     model.factors.front().name, what, what, example_size(dimension, 0.005))) +
         lines.keys_lines("analysis.calibration");
}

}  // namespace

void check_simulated(const Study& study, const StudySection& analysis) {
  const auto calibration = analysis.find("calibration");
  if (!calibration || !study.analysis.calibration->measured.empty()) return;
  calibration->fail("does not say what is measured",
                    "write analysis.calibration.measured, e.g. [\"z\"], and its noise");
}

void check_simulated_machines(const Study& study, const StudySection& analysis) {
  check_simulated(study, analysis);
  const auto calibration = analysis.find("calibration");
  if (!calibration || study.errors.per_pose.empty()) return;
  calibration->fail("is of a machine, but '" + study.model().factors[study.errors.per_pose.front().value].name +
                        "' is drawn anew at each pose, and no measurement of such errors is simulated",
                    "leave these errors out, and state what they do to a measured value as noise");
}

void refuse_calibration(const StudySection& analysis, const Study& study, const StudyKinds& kinds) {
  const auto calibration = analysis.find("calibration");
  if (!calibration || study.analysis.kind->has_key("calibration")) return;
  std::vector<std::string> others;
  for (const StudyKind* kind : kinds.all) {
    if (kind->has_key("calibration")) others.push_back(fmt::format("kind = \"{}\"", kind->name));
  }
  calibration->fail(fmt::format("does not belong to kind = \"{}\"", study.analysis.kind->name),
                    fmt::format("take {}, or remove it here; `poesy calibrate` takes it from a study of any kind",
                                fmt::join(others, " or ")));
}

std::string_view name(MeasuringFrame frame) {
  constexpr std::array<std::string_view, 4> kNames{"known", "height", "plane", "rigid"};
  return kNames[static_cast<std::size_t>(frame)];
}

std::string_view name(MeasuredTarget target) {
  constexpr std::array<std::string_view, 3> kNames{"known", "point", "rigid"};
  return kNames[static_cast<std::size_t>(target)];
}

std::string_view name(PriorKnowledge prior) { return prior == PriorKnowledge::none ? "none" : "tolerances"; }

std::string_view name(NoiseLevel level) { return level == NoiseLevel::given ? "given" : "estimated"; }

std::vector<FactorIndex> errors_with_tolerance(const Study& study, const StudySection& root) {
  const StudySection errors = root.section("errors");
  const std::vector<std::optional<Distribution>> by_zones = distributions_by_zones(study);
  const bool names_factors = root.section("analysis").find("factors").has_value();
  std::vector<FactorIndex> list;
  for (std::size_t f = 0; f < study.model().factors.size(); ++f) {
    const bool is_stated = by_zones[f] || states_size(errors, study.model().factors[f]);
    const bool varies =
        !names_factors || std::ranges::find(study.analysis.factors, FactorIndex(f)) != study.analysis.factors.end();
    if (is_stated && varies) list.emplace_back(f);
  }
  return list;
}

StudyRow calibration_row() {
  return {
      .name = "calibration",
      .value = {.type = "table"},
      .usual = "none",
      .meaning =
          "How a machine is calibrated: few numbers that its controller can correct, fitted to what is "
          "measured of it. `poesy calibrate` fits them to a file of measurements; a Monte Carlo study with draws = "
          "\"per machine\" and an allocation measure and calibrate each of their machines, an evaluation each of its "
          "cases and a sensitivity study each of its samples, without noise.",
      .reader = read_calibration,
      .lines = calibration_lines,
      .late = 3,
      .shown = shown_calibration};
}

StudyTables calibration_tables() {
  return {
      described(calibration_keys()),
      {.paths = {"analysis.calibration.combinations"},
       .meaning = "Each combination has a name, by which it is fitted.",
       .keys = {{.name = "NAME",
                 .type = "table",
                 .meaning = "Errors with their factors. The unit is that of the first error."}}},
      {.paths = {"analysis.calibration.combinations.NAME"},
       .meaning = "The errors of a combination.",
       .keys = {{.name = "ERROR",
                 .type = "number or quantity",
                 .meaning = "The error is this factor times the fitted number: a number, or where units differ "
                            "\"125 mm/rad\"."}}},
      {.paths = {"analysis.calibration.noise"},
       .meaning = "Standard deviations of one measured value.",
       .keys = {{.name = "RESPONSE",
                 .type = "quantity",
                 .bounds = "at least 0",
                 .meaning = "Of a response with a sign, or of \"distance\"."}}},
      {.paths = {"analysis.calibration.present"},
       .meaning = "What the controller corrected while it measured.",
       .keys = {{.name = "FITTED", .type = "quantity", .usual = "`0`", .meaning = "The value of a fitted error."}}},
      {.paths = {"analysis.calibration.controller"},
       .meaning = "Numbers to be typed into a controller.",
       .keys = {{.name = "NAME",
                 .type = "text",
                 .meaning = "An expression in parameters of the geometry and fitted errors: \"R - r + radius\"."}}}};
}

}  // namespace poesy
