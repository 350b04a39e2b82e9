#include "engine/calibration/corrected_evaluator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "models/lie/so3.h"

namespace poesy::calibration {
namespace {

constexpr int kMostSteps = 20;
// m or rad: if the error of the commanded coordinates is smaller than this, one first-order correction is enough,
// because the error that remains after it is far smaller.
constexpr double kSmall = 1e-8;

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

CorrectedEvaluator::CorrectedEvaluator(const Model& model, const SolverOptions& solver, CoordinateError commanded,
                                       Frame frame)
    : machine_(model, solver), correction_(machine_, std::move(commanded)), frame_(frame) {
  for (const Response& response : machine_.model().description().responses) {
    const auto* const found = std::ranges::find(kComponents, response.name);
    const bool is_one = found != kComponents.end();
    component_.push_back(is_one ? std::optional(static_cast<std::size_t>(found - kComponents.begin())) : std::nullopt);
  }
  for (std::size_t f = 0; f < machine_.errors(); ++f) all_.emplace_back(f);
}

const CommandedPose& CorrectedEvaluator::commanded_at(std::span<const double> pose) {
  const std::vector<double> key(pose.begin(), pose.end());
  const auto known = poses_.find(key);
  if (known != poses_.end()) return known->second;
  if (poses_.size() >= kMostPoses) poses_.clear();
  return poses_.emplace(key, correction_.at(pose)).first->second;
}

std::vector<double> CorrectedEvaluator::Pair::second(const std::vector<double>& rows) {
  std::vector<double> column;
  for (std::size_t r = 1; r < rows.size(); r += 2) column.push_back(rows[r]);
  return column;
}

Matrix CorrectedEvaluator::errors_of(const SampleBlock& samples, std::size_t b) const {
  Matrix errors(controllers_.errors.rows(), 2);
  errors.col(0) = controllers_.errors.col(static_cast<Eigen::Index>(b));
  for (std::size_t f = 0; f < samples.errors.size(); ++f) errors(static_cast<Eigen::Index>(f), 1) = samples.errors[f];
  for (std::size_t v = 0; v < samples.varied.size(); ++v) {
    errors(static_cast<Eigen::Index>(samples.varied[v].value), 1) = samples.values[v * samples.count + b];
  }
  return errors;
}

CorrectedEvaluator::Pair CorrectedEvaluator::solve(std::span<const double> pose, const Matrix& errors,
                                                   std::size_t details) {
  const RowMatrix values = errors;
  const std::vector<double> no_errors(machine_.errors(), 0.0);
  Pair pair{std::vector<double>(2 * component_.size()), std::vector<double>(2 * details), {}, {}};
  machine_.evaluator().evaluate(
      {.pose = pose,
       .errors = no_errors,
       .varied = all_,
       .values = {values.data(), static_cast<std::size_t>(values.size())},
       .count = 2},
      {.responses = pair.responses, .status = pair.status, .iterations = pair.iterations, .details = pair.details});
  return pair;
}

Displacement CorrectedEvaluator::displacement_of(const Pair& pair, std::size_t set) const {
  Components there = Components::Zero();
  for (std::size_t r = 0; r < component_.size(); ++r) {
    if (component_[r]) there(static_cast<Eigen::Index>(*component_[r])) = pair.responses[2 * r + set];
  }
  return {lie::exp(Vector3(there.head<3>())), there.segment<3>(3)};
}

CorrectedEvaluator::Outcome CorrectedEvaluator::corrected(const SampleBlock& samples, std::size_t b,
                                                          const CommandedPose& commanded,
                                                          const Displacement& uncorrected, std::size_t details) {
  const Outcome none{std::vector<double>(component_.size(), kNaN), std::vector<double>(details, kNaN)};
  const Matrix errors = errors_of(samples, b);
  Vector error = correction_.error_of(commanded, commanded.nominal, uncorrected);
  std::vector<double> drive_at = commanded.pose;
  for (int n = 0; n < kMostSteps; ++n) {
    drive_at = DriveCorrection::without(drive_at, commanded, error);
    if (!error.allFinite() || machine_.model().unreachable(drive_at)) return none;
    const Pair pair = solve(drive_at, errors, details);
    if (!poesy::solved(pair.status[0])) return none;
    const Placement nominal = machine_.nominal(drive_at);
    error = correction_.error_of(commanded, nominal, displacement_of(pair, 0));
    if (!(error.cwiseAbs().maxCoeff() < kSmall)) continue;
    Displacement left = seen_from(displacement_of(pair, 1), nominal, commanded.nominal);
    const Vector step = commanded.per_error * error;
    const Vector last = commanded.motion * step;
    left.turn = lie::exp(Vector3(-last.head<3>())) * left.turn;
    left.moved -= last.tail<3>();
    Outcome outcome{Pair::second(pair.responses), Pair::second(pair.details), pair.status[1], pair.iterations[1]};
    move(commanded, left, b, outcome);
    return outcome;
  }
  return none;
}

void CorrectedEvaluator::move(const CommandedPose& commanded, const Displacement& left, std::size_t b,
                              Outcome& outcome) const {
  const Vector believed = controllers_.phi.col(static_cast<Eigen::Index>(b));
  const Displacement seen = seen_by_device(left, commanded.nominal, Vector::Zero(believed.size()), believed, frame_);
  const Components found = components(seen, commanded.nominal);
  const std::vector<Response>& responses = machine_.model().description().responses;
  for (std::size_t r = 0; r < component_.size(); ++r) {
    if (component_[r]) outcome.responses[r] = found(static_cast<Eigen::Index>(*component_[r]));
  }
  for (std::size_t r = 0; r < component_.size(); ++r) {
    const std::vector<std::size_t>& parts = responses[r].components;
    const auto is_moved = [&](std::size_t part) { return component_[part].has_value(); };
    if (parts.empty() || !std::ranges::all_of(parts, is_moved)) continue;
    double squares = 0.0;
    for (const std::size_t part : parts) squares += outcome.responses[part] * outcome.responses[part];
    outcome.responses[r] = std::sqrt(squares);
  }
}

void CorrectedEvaluator::evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) {
  const std::size_t count = samples.count;
  POESY_EXPECTS(static_cast<std::size_t>(controllers_.errors.cols()) == count);
  const CommandedPose& commanded = commanded_at(samples.pose);
  const Matrix errors = controllers_.errors.array().isFinite().select(controllers_.errors, 0.0);
  const auto uncorrected = machine_.displaced(samples.pose, errors);
  const std::size_t details = outcomes.details.size() / count;
  for (std::size_t b = 0; b < count; ++b) {
    const bool is_calibrated = controllers_.errors.col(static_cast<Eigen::Index>(b)).allFinite() && uncorrected[b];
    const Outcome one = is_calibrated
                            ? corrected(samples, b, commanded, *uncorrected[b], details)
                            : Outcome{std::vector<double>(component_.size(), kNaN), std::vector<double>(details, kNaN)};
    for (std::size_t r = 0; r < one.responses.size(); ++r) outcomes.responses[r * count + b] = one.responses[r];
    for (std::size_t d = 0; d < one.details.size(); ++d) outcomes.details[d * count + b] = one.details[d];
    outcomes.status[b] = one.status;
    outcomes.iterations[b] = one.iterations;
  }
}

}  // namespace poesy::calibration
