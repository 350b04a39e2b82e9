#include "engine/calibration/exact_machine.h"

#include <algorithm>
#include <stdexcept>

#include "engine/base/contract.h"
#include "engine/model/forwarding_model.h"
#include "models/lie/so3.h"

namespace poesy::calibration {
namespace {

Vector3 vector_of(const SketchVector& vector) { return {vector[0], vector[1], vector[2]}; }

/// The axes of the platform's frame in a sketch, as columns. Precondition: the sketch has a frame of the platform.
Matrix3 axes_of(const Sketch& sketch) {
  const SketchedFrame* const frame = sketch.platform_frame();
  POESY_EXPECTS(frame != nullptr);
  Matrix3 axes;
  for (Eigen::Index k = 0; k < 3; ++k) axes.col(k) = vector_of(frame->axes[static_cast<std::size_t>(k)]);
  return axes;
}

/// The largest distance between two joints, or between a joint and the point P, m.
double reach_of(const Sketch& sketch) {
  std::vector<Vector3> points{vector_of(sketch.platform)};
  for (const auto& limb : sketch.limbs) {
    for (const SketchedJoint& joint : limb) points.push_back(vector_of(joint.point));
  }
  double reach = 0.0;
  for (const Vector3& a : points) {
    for (const Vector3& b : points) reach = std::max(reach, (a - b).norm());
  }
  return reach;
}

}  // namespace

Components components(const Displacement& displacement, const Placement& nominal) {
  Components list;
  const Vector3 arm = nominal.tip - nominal.origin;
  list << lie::log(displacement.turn), displacement.moved,
      displacement.moved + (displacement.turn - Matrix3::Identity()) * arm;
  return list;
}

Displacement seen_from(const Displacement& displacement, const Placement& from, const Placement& to) {
  return {displacement.turn * from.turn * to.turn.transpose(), displacement.moved + (from.origin - to.origin)};
}

ExactMachine::ExactMachine(const Model& model, const SolverOptions& solver)
    : model_(&solving_model(model)),
      evaluator_(model_->evaluator(solver)),
      no_errors_(model.description().factors.size(), 0.0) {
  const std::vector<Response>& known = model_->description().responses;
  for (std::size_t c = 0; c < responses_.size(); ++c) {
    const auto found = std::ranges::find(known, kComponents[c], &Response::name);
    if (found == known.end()) throw std::invalid_argument("does not report the displacement of its platform");
    responses_[c] = static_cast<std::size_t>(found - known.begin());
  }
  const std::optional<Sketch> home = model.sketch({});
  if (!home || home->platform_frame() == nullptr) throw std::invalid_argument("does not say where its platform is");
  home_ = axes_of(*home);
  reach_ = reach_of(*home);
  has_tool_ = !home->tool.empty();
  for (std::size_t f = 0; f < no_errors_.size(); ++f) all_.emplace_back(f);
}

Placement ExactMachine::nominal(std::span<const double> pose) const {
  const std::optional<Sketch> sketch = model_->sketch(pose);
  POESY_EXPECTS(sketch.has_value());
  const Vector3 origin = vector_of(sketch->platform);
  return {axes_of(*sketch) * home_.transpose(), origin, has_tool_ ? vector_of(sketch->tool.front()) : origin};
}

std::vector<std::optional<Displacement>> ExactMachine::displaced(std::span<const double> pose, const Matrix& errors) {
  const auto count = static_cast<std::size_t>(errors.cols());
  POESY_EXPECTS(static_cast<std::size_t>(errors.rows()) == no_errors_.size());
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values = errors;
  std::vector<double> responses(model_->description().responses.size() * count);
  std::vector<SolveStatus> status(count);
  std::vector<std::uint32_t> iterations(count);
  evaluator_->evaluate({.pose = pose,
                        .errors = no_errors_,
                        .varied = all_,
                        .values = {values.data(), static_cast<std::size_t>(values.size())},
                        .count = count},
                       {.responses = responses, .status = status, .iterations = iterations, .details = {}});
  solves_ += count;
  std::vector<std::optional<Displacement>> list(count);
  for (std::size_t b = 0; b < count; ++b) {
    if (!solved(status[b])) continue;
    const auto at = [&](std::size_t component) { return responses[responses_[component] * count + b]; };
    list[b] = Displacement{lie::exp(Vector3(at(0), at(1), at(2))), Vector3(at(3), at(4), at(5))};
  }
  return list;
}

std::optional<Displacement> ExactMachine::displaced(std::span<const double> pose, const Vector& errors) {
  return displaced(pose, Matrix(errors)).front();
}

}  // namespace poesy::calibration
