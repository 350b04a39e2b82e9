#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/progress.h"
#include "engine/app/results.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/calibration/calibrate.h"
#include "engine/kinds/calibration/kind.h"
#include "engine/kinds/calibration/words.h"
#include "engine/kinds/study_file.h"
#include "engine/report/table.h"
#include "engine/result/described.h"
#include "engine/result/result_file.h"
#include "engine/run/run_options.h"
#include "engine/storage/checkpoint.h"
#include "engine/storage/content_hash.h"
#include "engine/study/bare_numbers.h"
#include "engine/study/calibration.h"
#include "engine/study/machine_file.h"
#include "engine/study/mechanism_doubts.h"
#include "engine/study/study_file.h"
#include "engine/study/table_file.h"
#include "engine/study/text_file.h"
#include "models/file/expression.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

constexpr std::size_t kMostBytes = 64U << 20U;  // largest size of a table of measurements

struct CalibrateOptions {
  std::string study;
  std::string measured;
  std::string result;
  std::size_t threads = 0;
};

/// Reads the file of poses that a selection names, because read_study() for a calibration does not open this file.
void open_poses(PoseSelection& selection, const std::string& study_path, const ModelDescription& model) {
  if (selection.select != PoseSelection::Select::file || selection.file.empty()) return;
  const std::string path = (std::filesystem::path(study_path).parent_path() / selection.file).string();
  selection.from_file = read_poses(path, model);
  selection.place = {path, 2, 1};
}

/// The poses that a selection gives; none if the study states no selection.
std::optional<SelectedPoses> selected(PoseSelection selection, const std::string& study_path, const Model& model) {
  using Select = PoseSelection::Select;
  if (selection.select == Select::file && selection.file.empty()) return std::nullopt;
  if (selection.select != Select::file && selection.count == 0) return std::nullopt;
  if (selection.trajectory && !selection.trajectory->file.empty()) {
    throw InputError(selection.place, "poses of a calibration are not taken from the file of a trajectory",
                     "write select = \"file\"");
  }
  open_poses(selection, study_path, model.description());
  return select_poses(selection, model);
}

/// The poses of the rows of a table of measurements.
SelectedPoses measured_poses(const std::string& path, const MachineFile& file, const Model& model) {
  PoseSelection selection;
  selection.select = PoseSelection::Select::file;
  selection.file = path;
  selection.from_file = file.poses;
  selection.place = {path, 2, 1};
  SelectedPoses poses = select_poses(selection, model);
  const std::string doubt = outside_pose_text(path, file.poses, poses.poses, model.description());
  if (!doubt.empty()) say(Message::warning, doubt);
  return poses;
}

/// The given poses without repetitions.
SelectedPoses without_repetition(const SelectedPoses& poses) {
  std::vector<double> values;
  SelectedPoses once;
  for (std::size_t m = 0; m < poses.poses.size(); ++m) {
    const std::span<const double> pose = poses.poses[PoseIndex(m)];
    bool is_new = true;
    for (std::size_t at = 0; at < values.size(); at += pose.size()) {
      is_new = is_new && !std::ranges::equal(pose, std::span(values).subspan(at, pose.size()));
    }
    if (!is_new) continue;
    values.insert(values.end(), pose.begin(), pose.end());
    once.condition.push_back(poses.condition[m]);
  }
  once.poses = PoseSet(poses.poses.coordinates(), std::move(values));
  return once;
}

/// The names that expressions for the controller may use: geometry parameters, followed by fitted errors.
std::vector<GeometryParameter> names_in_expressions(const Study& study) {
  std::vector<GeometryParameter> list = study.model().geometry;
  for (const FittedErrors& fitted : study.analysis.calibration->fit) {
    if (std::ranges::find(list, fitted.name, &GeometryParameter::name) != list.end()) {
      throw InputError(fitted.place,
                       "the fitted error '" + fitted.name + "' has the name of a parameter of the geometry",
                       "give the combination another name");
    }
    list.push_back({fitted.name, fitted.dimension, 0.0, "a fitted error"});
  }
  return list;
}

/// The names in an expression. A name that follows a number, as in "5 mm", is a unit and is left out.
std::vector<std::string> names_in(const std::string& text) {
  const auto is_letter = [](char c) { return c == '_' || std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const auto is_part = [&](char c) { return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::vector<std::string> list;
  char before = ' ';
  for (auto at = text.begin(); at != text.end();) {
    const auto end = std::find_if_not(at, text.end(), is_part);
    if (end != at && is_letter(*at) && std::isdigit(static_cast<unsigned char>(before)) == 0)
      list.emplace_back(at, end);
    at = end == at ? at + 1 : end;
    if (*(at - 1) != ' ') before = *(at - 1);
  }
  return list;
}

/// Throws InputError if the expression of a number for the controller uses an error of the mechanism that is not fitted
/// on its own, because the value of such an error is not known.
void check_names(const ControllerNumber& number, const std::vector<GeometryParameter>& parameters, const Study& study) {
  for (const std::string& name : names_in(number.text)) {
    const auto factor = study.model().find_factor(name);
    if (!factor || std::ranges::find(parameters, name, &GeometryParameter::name) != parameters.end()) continue;
    const std::vector<FittedErrors>& fit = study.analysis.calibration->fit;
    const auto combination = std::ranges::find_if(fit, [&](const FittedErrors& fitted) {
      return std::ranges::find(fitted.factors, *factor) != fitted.factors.end();
    });
    throw InputError(
        number.place,
        fmt::format("controller number '{}' uses the error '{}', which is not fitted alone", number.name, name),
        combination == fit.end() ? "use fitted errors only, or add it to fit"
                                 : "use the combination '" + combination->name + "', which has this error");
  }
}

/// The dimension of an expression's value. Throws InputError unless it is a length, an angle or a number.
Dimension typed_dimension(const file::Value& value, const ControllerNumber& number) {
  for (const Dimension dimension : {Dimension::length, Dimension::angle, Dimension::number}) {
    if (file::of_dimension(0.0, dimension).like(value)) return dimension;
  }
  throw InputError(number.place, "controller number '" + number.name + "' is " + file::dimension_text(value),
                   "write an expression of a length, an angle or a number");
}

std::vector<calibration::TypedNumber> typed_numbers(const Study& study) {
  std::vector<calibration::TypedNumber> list;
  if (study.analysis.calibration->controller.empty()) return list;
  const std::vector<GeometryParameter> parameters = names_in_expressions(study);
  for (const ControllerNumber& number : study.analysis.calibration->controller) {
    check_names(number, parameters, study);
    const file::Expression expression{number.text, "analysis.calibration.controller." + number.name, number.place,
                                      true};
    const auto evaluated = [=, geometry = study.mechanism.geometry](std::span<const double> fitted) {
      std::vector<double> values = geometry;
      values.insert(values.end(), fitted.begin(), fitted.end());
      return file::evaluate(expression, parameters, values);
    };
    const std::vector<double> none(study.analysis.calibration->fit.size(), 0.0);
    list.push_back({number.name, number.text, typed_dimension(evaluated(none), number),
                    [evaluated](std::span<const double> fitted) { return evaluated(fitted).si; }});
  }
  return list;
}

Study study_to_calibrate(const std::string& path) {
  Study study = read_study(path, registry(), StudyUse::evaluate);
  if (study.analysis.calibration == nullptr) {
    throw InputError({path}, "there is no table [analysis.calibration]",
                     "write it, with fit = [...] and noise = { ... }; see the guide");
  }
  if (study.mechanism.compared) {
    throw InputError(study.mechanism.place, "mechanism.fidelity is \"both\", but a calibration solves at one fidelity",
                     "write one of them");
  }
  return study;
}

int calibrate_machine(const CalibrateOptions& options) {
  const Study study = study_to_calibrate(options.study);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  warn_of_mechanism(study, *model);
  const MachineFile file = read_machine_file(options.measured, model->description());
  const SelectedPoses measured = measured_poses(options.measured, file, *model);
  const SelectedPoses predicted = selected(study.poses, options.study, *model).value_or(without_repetition(measured));
  for (const std::string& of_box : workspace_doubts(study, predicted.poses)) say(Message::warning, of_box);
  const auto& asked = study.analysis.calibration->candidates;
  const auto candidates = asked ? selected(*asked, options.study, *model) : std::nullopt;
  const std::vector<calibration::TypedNumber> typed = typed_numbers(study);
  const std::string doubt = bare_measurement_text(options.measured, file, study);
  if (!doubt.empty()) say(Message::warning, doubt);
  std::string path;
  std::optional<RunLock> lock;
  if (!options.result.empty()) {
    path = check_result_path(options.result, std::array{options.study, options.measured});
    lock.emplace(path);
  }
  const std::size_t threads = resolved_threads(options.threads);
  start_threads(threads);
  const auto start = std::chrono::steady_clock::now();
  calibration::Calibrated made =
      calibration::calibrate({study, *model, options.measured, file, measured.poses, predicted.poses,
                              candidates ? candidates->poses : predicted.poses, typed, threads});
  if (made.result.estimate.empty()) {
    return complain(options.measured +
                        ": a machine on the way of the fit was not solved; look at the units of its columns, of which "
                        "those without one are in SI, fit fewer errors, or take prior = \"tolerances\"",
                    kTooManyNotConverged);
  }
  made.result.file = std::filesystem::path(options.measured).filename().string();
  made.result.file_text = read_text(options.measured, "table of measurements", kMostBytes);
  made.result.file_sha256 = hex(sha256(std::as_bytes(std::span(made.result.file_text))));
  if (model->description().deformation) {
    say(Message::note,
        "limbs over-constrain each other, so where a fitted error deforms them, the platform is where [solver] metric "
        "puts it: such an estimate is under that assumption");
  }
  for (const std::string& warning : made.warnings) say(Message::warning, warning);
  const bool converged = made.result.converged != 0;
  if (converged) {
    for (const std::string& warning : calibration::calibration_warnings(made.result)) say(Message::warning, warning);
  }
  StoredResult result = described(study, *model, predicted);
  result.kind = calibration::kKind.study.name;
  result.found = std::move(made.result);
  print(text_of(calibration::kReport.tables(result, {}), output_width()));
  if (!path.empty()) {
    write_result(path, calibration::kKind.study.name, calibration::kFile, study, predicted, result.found,
                 run_facts(seconds_since(start), threads, made.solves));
  }
  if (converged) return kDone;
  return complain(
      fmt::format("{}: {}; {}", options.measured, calibration::kNotConverged, calibration::kNotConvergedRemedy),
      kTooManyNotConverged);
}

}  // namespace

Command& add_calibrate(Command& program) {
  const auto [command, options] =
      program.add_command("calibrate", "fit the errors of one machine to measurements of it", calibrate_machine);
  command.add_value("study", options.study, "STUDY.toml", "study file with [analysis.calibration]")->required();
  command
      .add_value("--measured", options.measured, "FILE.csv",
                 "measurements; a row is a pose and what was measured there: deviation_R, actual_C, distance")
      ->required();
  command.add_value("-o,--output", options.result, "RESULT.h5", "result file; default: only the summary");
  command.add_whole_number("--threads", options.threads, "N", "number of threads; default: one per processor", 1, 1024);
  command.examples = {{"prints the fitted errors, and what to type into the controller",
                       "poesy calibrate study.toml --measured heights.csv"},
                      {"keeps everything", "poesy calibrate study.toml --measured heights.csv -o machine.h5"}};
  return command;
}

}  // namespace poesy::app
