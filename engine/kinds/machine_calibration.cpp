#include "engine/kinds/machine_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/nan.h"
#include "engine/calibration/inference.h"
#include "engine/kinds/commanded.h"
#include "engine/model/forwarding_model.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"
#include "engine/report/display.h"
#include "engine/run/outlook.h"

namespace poesy {
namespace {

using calibration::Matrix;
using calibration::Measured;
using calibration::MeasuredValue;
using calibration::Vector;

constexpr std::size_t kAngles = 3;          // number of components of a displacement that are angles; they come first
constexpr std::size_t kFirstOtherBody = 2;  // index in Sketch::bodies of the first body after base and platform

Eigen::Index position(std::size_t at) { return static_cast<Eigen::Index>(at); }

calibration::ExactMachine exact_machine(const Study& study, const Model& model) {
  try {
    return {model, study.solver};
  } catch (const std::invalid_argument& reason) {
    throw InputError(study.mechanism.place, "mechanism '" + model.description().name + "' " + reason.what(),
                     "take another mechanism, or fidelity");
  }
}

/// The poses at which machines are measured.
PoseSet poses_of_calibration(const Study& study, const Model& model, const PoseSet& poses) {
  const auto& asked = study.analysis.calibration->poses;
  return asked ? select_poses(*asked, model).poses : poses;
}

/// The components of the displacement that a word of the key `measured` names, as indices in kComponents.
std::vector<std::size_t> components_of(const std::string& word, const Study& study) {
  static constexpr std::array<std::size_t, 6> kPose{3, 4, 5, 0, 1, 2};
  if (word == kMeasuredPose) return {kPose.begin(), kPose.end()};
  const auto* const found = std::ranges::find(calibration::kComponents, word);
  if (found != calibration::kComponents.end()) {
    return {static_cast<std::size_t>(found - calibration::kComponents.begin())};
  }
  throw InputError(study.analysis.calibration->measured_place,
                   "'" + word + "' is not measured by a calibration, which knows the displacement of the platform",
                   "measure x, y, z, theta_x, theta_y, theta_z, tip_x, tip_y, tip_z, \"pose\" or \"distance\"");
}

/// A part of a message about the combinations of fitted errors that the measurement does not determine. A single
/// combination is written out, " (zero_1 + 0.93 rods ...)"; the text is empty if it mixes lengths and angles. For
/// several combinations, the text is their number.
std::string unseen_text(const calibration::Confounded& part, const Matrix& projector, const Vector& scale,
                        const std::vector<FittedErrors>& fit) {
  if (part.directions != 1) return " (" + counted(part.directions, "direction", "directions") + ")";
  constexpr std::size_t kMostTerms = 3;
  const std::size_t first = part.numbers.front();
  std::string text = fit[first].name;
  for (std::size_t n = 1; n < part.numbers.size(); ++n) {
    const std::size_t other = part.numbers[n];
    if (fit[other].dimension != fit[first].dimension) return {};
    if (n == kMostTerms) text += " ...";
    if (n >= kMostTerms) continue;
    const double weight = scale(position(other)) * projector(position(other), position(first)) /
                          (scale(position(first)) * projector(position(first), position(first)));
    const std::string size = fmt::format("{:.2g}", std::abs(weight));
    text += fmt::format(" {} {}{}", weight < 0.0 ? '-' : '+', size == "1" ? "" : size + " ", fit[other].name);
  }
  return " (" + text + ")";
}

double stated_noise(const CalibrationTable& table, std::string_view what) {
  const auto found = std::ranges::find(table.noise, what, &StatedNoise::what);
  // `found` is not the end, because the reader of study files refuses a study that does not state this noise.
  return found->sd / std::sqrt(static_cast<double>(table.repeats));
}

}  // namespace

MachineCalibration::MachineCalibration(const Study& study, const Model& model, const PoseSet& poses)
    : study_(&study), model_(&model), measured_(poses_of_calibration(study, model, poses)) {
  check_limits();
  calibration::ExactMachine machine = exact_machine(study, model);
  commanded_ = commanded_coordinates(study, model, machine, measured_);
  columns_ = fitted_columns(study, table(), machine);
  list_values();
  set_weights();
  check_count();
  const calibration::Measurement of_perfect = measurement(machine);
  try {
    expansion_ = std::make_shared<const calibration::Expansion>(of_perfect, columns_.directions);
  } catch (const std::invalid_argument& reason) {
    throw InputError(table().place, "the mechanism " + std::string(reason.what()),
                     "measure at other poses (analysis.calibration.poses)");
  }
  check_seen(of_perfect);
}

MachineCalibration MachineCalibration::of(const Study& study) const {
  MachineCalibration other = *this;
  other.study_ = &study;
  other.columns_ = fitted_columns(study, table(), calibration::ExactMachine(*model_, study.solver));
  return other;
}

void MachineCalibration::list_values() {
  std::vector<std::size_t> components;
  for (const std::string& word : table().measured) {
    if (word == kMeasuredDistance) continue;
    for (const std::size_t component : components_of(word, *study_)) {
      if (std::ranges::find(components, component) == components.end()) components.push_back(component);
    }
  }
  for (std::size_t row = 0; row < measured_.size(); ++row) {
    for (const std::size_t component : components) {
      values_.push_back({.what = Measured::deviation, .row = row, .component = component});
      noise_.push_back(stated_noise(table(), calibration::kComponents[component]));
    }
  }
  for (const auto& [one, other] : table().pairs) {
    if (std::max(one, other) >= measured_.size()) {
      throw InputError(table().pairs_place,
                       fmt::format("analysis.calibration.pairs names pose {}, but {} measured", std::max(one, other),
                                   counted(measured_.size(), "pose is", "poses are")),
                       "count the poses of the calibration from 0");
    }
    values_.push_back({.what = Measured::distance, .row = one, .other = other});
    noise_.push_back(stated_noise(table(), kMeasuredDistance));
  }
}

void MachineCalibration::set_weights() {
  weights_ = Eigen::Map<const Vector>(noise_.data(), position(noise_.size()));
  if ((weights_.array() > 0.0).all()) return;
  const Place& place = table().measured_place;
  if ((weights_.array() > 0.0).any()) {
    throw InputError(place, "some values have noise 0, and others have noise", "state the noise of all, or 0 for all");
  }
  const auto is_angle = [](const MeasuredValue& value) {
    return value.what == Measured::deviation && value.component < kAngles;
  };
  if (std::ranges::any_of(values_, is_angle) && !std::ranges::all_of(values_, is_angle)) {
    throw InputError(place, "noise is 0 and values have lengths and angles: say how they are weighed",
                     "state the noise of each");
  }
  if (table().prior == PriorKnowledge::tolerances) {
    throw InputError(place, "noise is 0, so nothing can be weighed against the tolerances",
                     "state the noise, or write prior = \"none\"");
  }
  // Without noise, all values get the same standard deviation kEqual (m or rad). It must be small, because the fit
  // counts as converged when a step changes the values by less than a small share of this standard deviation.
  constexpr double kEqual = 1e-6;
  weights_.setConstant(kEqual);
}

void MachineCalibration::check_limits() const {
  const std::optional<Sketch> home = model_->sketch({});
  if (!home) return;
  for (const ResponseLimit& limit : study_->analysis.limits) {
    const std::string& response = model_->description().responses[limit.response].name;
    for (std::size_t body = kFirstOtherBody; body < home->bodies.size(); ++body) {
      if (!response.starts_with(home->bodies[body].name + "_")) continue;
      throw InputError(
          table().place,
          "the limit on '" + response +
              "' is not on the platform, and the error that remains after a calibration is known only for the platform",
          "remove the limit, or the calibration");
    }
  }
}

void MachineCalibration::check_count() const {
  const std::size_t places = numbers_of(frame()) + numbers_of(target());
  if (places > 0 && places >= values()) {
    throw InputError(table().place,
                     fmt::format("{} numbers of frame and target and {} measured values", places, values()),
                     "measure at more poses, or in a known frame");
  }
  if (table().prior == PriorKnowledge::tolerances || fitted() + places <= values()) return;
  const std::string of_places = places == 0 ? "" : fmt::format(" with {} numbers of frame and target", places);
  throw InputError(table().place,
                   fmt::format("{} fitted errors{} and {} measured values", fitted(), of_places, values()),
                   "measure at more poses, fit fewer, or take prior = \"tolerances\"");
}

void MachineCalibration::check_seen(const calibration::Measurement& measurement) const {
  if (table().prior == PriorKnowledge::tolerances) return;
  const calibration::Derivatives derivatives =
      expansion_->derivatives(measurement, Vector::Zero(position(fitted())), expansion_->without_errors(),
                              Vector::Zero(position(measurement.places())));
  const calibration::ScaledFit scaled = scaled_fit(derivatives, weights_, directions().scale);
  const Matrix projector = calibration::null_projector(scaled);
  const auto unseen = calibration::confounded(projector);
  if (unseen.empty()) return;
  std::vector<std::string> names;
  for (const std::size_t n : unseen.front().numbers) names.push_back(table().fit[n].name);
  throw InputError(table().place,
                   some_names(names, 18) + (names.size() == 1 ? " changes nothing that is measured"
                                                              : ": the measurements do not tell them apart" +
                                                                    unseen_text(unseen.front(), projector,
                                                                                directions().scale, table().fit)),
                   "fit fewer, measure something else (\"distance\"), or take prior = \"tolerances\"");
}

calibration::Measurement MachineCalibration::measurement(calibration::ExactMachine& machine) const {
  std::vector<calibration::MeasuredPose> poses;
  for (std::size_t row = 0; row < measured_.size(); ++row) {
    const std::span<const double> pose = measured_[PoseIndex(row)];
    poses.push_back({{pose.begin(), pose.end()}, {pose.begin(), pose.end()}});
  }
  return {machine, std::move(poses), values_, frame(), target()};
}

std::unique_ptr<calibration::CorrectedEvaluator> MachineCalibration::corrected() const {
  return std::make_unique<calibration::CorrectedEvaluator>(*model_, study_->solver, commanded_, frame());
}

std::unique_ptr<Evaluator> MachineCalibration::evaluator(calibration::Controllers controllers) const {
  std::unique_ptr<calibration::CorrectedEvaluator> solving = corrected();
  solving->set(std::move(controllers));
  return all_formed(*model_, std::move(solving));
}

std::optional<MachineCalibration> machine_calibration(const Study& study, const Model& model, const PoseSet& poses) {
  if (study.analysis.calibration == nullptr) return std::nullopt;
  return std::make_optional<MachineCalibration>(study, model, poses);
}

std::string calibration_cost_text(const MachineCalibration& calibration, std::string_view each) {
  return fmt::format(", some 5 times as many with the corrected drives; for each {} about {} to fit {} to {} at {}",
                     each, 4 * calibration.measured_poses(), counted_things(calibration.fitted(), "errors"),
                     counted_things(calibration.values(), "values"),
                     counted_things(calibration.measured_poses(), "poses"));
}

Matrix all_errors(const SampleBlock& samples) {
  Matrix errors(position(samples.errors.size()), position(samples.count));
  for (std::size_t f = 0; f < samples.errors.size(); ++f) errors.row(position(f)).setConstant(samples.errors[f]);
  for (std::size_t v = 0; v < samples.varied.size(); ++v) {
    errors.row(position(samples.varied[v].value)) =
        Eigen::Map<const Eigen::RowVectorXd>(samples.values.data() + v * samples.count, position(samples.count));
  }
  return errors;
}

MachineCalibrator::MachineCalibrator(const MachineCalibration& calibration)
    : calibration_(&calibration),
      machine_(calibration.model(), calibration.study().solver),
      measurement_(calibration.measurement(machine_)) {}

Matrix MachineCalibrator::noise(std::span<const std::size_t> machines) const {
  Matrix found(position(calibration_->values()), position(machines.size()));
  for (std::size_t i = 0; i < calibration_->values(); ++i) {
    const StreamAddress address{calibration_->study().seed, Purpose::calibration, FactorIndex(i), PoseIndex(1)};
    const double sd = calibration_->noise()[i];
    for (std::size_t b = 0; b < machines.size(); ++b) {
      const double uniform = uniform_from_bits(random_bits(address, SampleIndex(machines[b])));
      found(position(i), position(b)) = sd > 0.0 ? normal_quantile(sd, uniform) : 0.0;
    }
  }
  return found;
}

calibration::Controllers MachineCalibrator::operator()(const Matrix& errors, std::span<const std::size_t> machines) {
  return with_noise(errors, noise(machines));
}

calibration::Controllers MachineCalibrator::without_noise(const Matrix& errors) {
  return with_noise(errors, Matrix::Zero(position(calibration_->values()), errors.cols()));
}

calibration::Controllers MachineCalibrator::with_noise(const Matrix& errors, const Matrix& noise) {
  const auto machines = static_cast<std::size_t>(errors.cols());
  const Vector true_places = Vector::Zero(position(measurement_.places()));
  calibration::Controllers found{Matrix::Constant(errors.rows(), errors.cols(), kNaN),
                                 Matrix::Constant(true_places.size(), errors.cols(), kNaN)};
  const auto displacements = measurement_.displacements_of_solved(errors);
  for (std::size_t b = 0; b < machines; ++b) {
    if (displacements[b].empty()) continue;
    const auto column = position(b);
    measurement_.set_measured(measurement_.values_of(displacements[b], true_places) + noise.col(column));
    const calibration::FitResult fit = calibration::fit({.measurement = measurement_,
                                                         .directions = calibration_->directions(),
                                                         .sd = calibration_->weights(),
                                                         .prior = calibration_->prior(),
                                                         .expansion = &calibration_->expansion()});
    if (!fit.solved || !fit.converged) continue;
    found.errors.col(column) = calibration_->directions().F * fit.theta;
    found.phi.col(column) = fit.phi;
  }
  return found;
}

}  // namespace poesy
