#include "models/file/model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "engine/base/contract.h"
#include "engine/schema/keys.h"
#include "models/chain/calibration.h"
#include "models/chain/deformation_model.h"
#include "models/chain/deformation_trace.h"
#include "models/chain/metric.h"
#include "models/chain/nominal.h"
#include "models/chain/passive_condition.h"
#include "models/chain/separation.h"
#include "models/chain/sketch.h"
#include "models/file/charts.h"
#include "models/file/mobility.h"
#include "models/file/rounding.h"
#include "models/file/structure.h"
#include "models/file/tracking.h"

namespace poesy::file {
namespace {

/// drives: of each joint that moves, as chain::Joint has it; those of the limb are taken off.
chain::Limb chain_limb(const Limb& limb, bool errors_at_joints, std::span<const std::size_t>& drives) {
  chain::Limb of_chain;
  for (const Joint& joint : limb.joints) {
    of_chain.joints.push_back(joint.of_chain());
    if (!joint.moves()) continue;
    of_chain.joints.back().drive = drives.front();
    drives = drives.subspan(1);
  }
  of_chain.home = limb.home;
  of_chain.errors_at_joints = errors_at_joints;
  return of_chain;
}

/// Of each joint that moves, the number of its drive where that moves others too, else 0.
std::vector<std::size_t> shared_drives(const Mechanism& mechanism) {
  std::vector<std::size_t> numbers(mechanism.moving(), 0);
  std::size_t number = 0;
  for (const Drive& drive : drives_of(mechanism)) {
    ++number;
    if (!drive.is_shared()) continue;
    for (const std::size_t joint : drive.joints) numbers[joint] = number;
  }
  return numbers;
}

/// A displacement for each joint and fixed frame, from those of the joints that move.
std::vector<double> with_fixed(const Mechanism& mechanism, std::span<const double> moving) {
  std::vector<double> all;
  for (const Limb& limb : mechanism.limbs) {
    for (const Joint& joint : limb.joints) {
      all.push_back(joint.moves() ? moving.front() : 0.0);
      if (joint.moves()) moving = moving.subspan(1);
    }
  }
  return all;
}

/// Displacements of joints and fixed frames at a pose.
std::function<std::vector<double>(std::span<const double>)> displacements_by(const Mechanism& mechanism,
                                                                             std::shared_ptr<const Tracker> tracker,
                                                                             const chain::DeformationModel& model) {
  if (!model.chain.rounded) {
    return [mechanism, tracker = std::move(tracker)](std::span<const double> pose) {
      return with_fixed(mechanism, tracker->track(pose).displacements);
    };
  }
  return [mechanism, tracker = std::move(tracker), chain = model.chain,
          points = model.points](std::span<const double> pose) {
    return chain::settled(chain, points, with_fixed(mechanism, tracker->track(pose).displacements));
  };
}

chain::DeformationModel chain_model(const Mechanism& mechanism, std::shared_ptr<const Tracker> tracker,
                                    const Mobility& home, std::vector<Vector3> points) {
  chain::DeformationModel model;
  const std::vector<std::size_t> drives = shared_drives(mechanism);
  std::span<const std::size_t> left = drives;
  for (const Limb& limb : mechanism.limbs) {
    model.chain.limbs.push_back(chain_limb(limb, mechanism.errors_at_joints, left));
  }
  model.chain.pairs = chain::pairs_of(mechanism.limbs.size());
  model.chain.idle = home.idle;
  model.chain.meets = home.passive_rank == home.loop_equations;
  for (const ErrorSlot& slot : mechanism.slots) {
    model.slots.push_back({slot.limb, slot.frame, slot.component, slot.scale});
  }
  model.points = std::move(points);
  model.held_at = mechanism.points;
  model.chain.rounded = mechanism.precision.rounded();
  model.joint_displacements = displacements_by(mechanism, std::move(tracker), model);
  model.platform = chain::PlatformReport{mechanism.tool, model.points.empty() ? mechanism.points : model.points};
  return model;
}

/// Positions of the responses with these names.
std::vector<std::size_t> positions(const std::vector<Response>& responses, std::span<const std::string_view> names) {
  std::vector<std::size_t> list;
  for (const std::string_view name : names) {
    const auto found = std::ranges::find(responses, name, &Response::name);
    if (found != responses.end()) list.push_back(static_cast<std::size_t>(found - responses.begin()));
  }
  return list;
}

ModelDescription describe(const MechanismFile& file, const Mechanism& mechanism, const chain::DeformationModel& model,
                          std::span<const Chart> charts) {
  ModelDescription description;
  description.name = file.name;
  description.title = file.title;
  description.geometry = file.geometry;
  for (const Coordinate& coordinate : mechanism.coordinates) {
    description.pose_coordinates.push_back({coordinate.name, coordinate.dimension(), coordinate_text(coordinate)});
    description.pose_lower.push_back(coordinate.lower);
    description.pose_upper.push_back(coordinate.upper);
  }
  description.structure = structure_text(mechanism);
  description.workspace_note = "This workspace is the mechanism file's.";
  description.factors = mechanism.factors;
  description.factor_sets = mechanism.sets;
  description.responses = chain::responses_of(model);
  description.joints = displacement_names(mechanism);
  for (const Chart& chart : charts) description.charts.push_back(chart.description());
  description.fidelities = {"exact", "first-order"};
  description.tolerance = chain::kToleranceByMetric;
  constexpr std::array<std::string_view, 5> kHeadline{"gap", "deformation_max", "position", "rotation", "tip_position"};
  constexpr std::array<std::string_view, 6> kSigned{"x", "y", "z", "theta_x", "theta_y", "theta_z"};
  description.headline = positions(description.responses, kHeadline);
  description.signed_headline = positions(description.responses, kSigned);
  description.separation = chain::separation_description(model);
  if (model.chain.meets) return description;
  description.metric = model.points.empty() ? "published" : "platform";
  if (model.points.empty()) description.tolerance = SolverOptions().tolerance;
  description.deformation = chain::deformation_measure(model);
  description.details = chain::deformation_details(model.chain);
  return description;
}

/// What rounded numbers leave of the deformation, at the most, at poses of the workspace.
double nominal_deformation(const Mechanism& mechanism, const chain::DeformationModel& model, std::size_t response) {
  const std::vector<double> no_errors(model.slots.size(), 0.0);
  double largest = 0.0;
  for (const PoseMobility& pose : workspace_mobility(mechanism)) {
    if (!pose.reached()) continue;
    largest = std::max(largest, chain::first_order_trace(model, pose.pose, no_errors).responses[response]);
  }
  return largest;
}

class FileModel final : public Model {
 public:
  /// points: of the platform's metric; none: as published.
  FileModel(const MechanismFile& file, Checked found, std::vector<Vector3> points, chain::Fidelity fidelity)
      : mechanism_(std::move(found.mechanism)),
        mismatch_(found.mismatch),
        tracker_(std::make_shared<const Tracker>(mechanism_)),
        charts_(charts_of(mechanism_)),
        model_(chain_model(mechanism_, tracker_, found.home, std::move(points))),
        description_(describe(file, mechanism_, model_, charts_)),
        fidelity_(fidelity) {
    if (!model_.chain.rounded || !description_.deformation) return;
    DeformationMeasure& measure = *description_.deformation;
    measure.rounding =
        std::max(measure.rounding, kNominalShare * nominal_deformation(mechanism_, model_, measure.response));
  }

  const ModelDescription& description() const override { return description_; }

  std::optional<std::string> unreachable(std::span<const double> pose) const override {
    std::string why = tracker_->track(pose).unreachable;
    return why.empty() ? std::nullopt : std::optional(std::move(why));
  }

  std::vector<double> joint_displacements(std::span<const double> pose) const override {
    return tracker_->track(pose).displacements;
  }

  std::optional<std::vector<double>> pose_from_chart(std::size_t chart,
                                                     std::span<const double> coordinates) const override {
    const Tracked found = charts_.at(chart).track(coordinates);
    return found.unreachable.empty() ? std::optional(coordinates_of(mechanism_, found.pose)) : std::nullopt;
  }

  std::string no_pose_because(std::size_t chart, std::span<const double> coordinates) const override {
    return charts_.at(chart).track(coordinates).unreachable;
  }

  double condition(std::span<const double> pose) const override {
    const std::vector<double> displacements = model_.joint_displacements(pose);
    const std::optional<chain::Metric> metric = model_.metric(displacements);
    return chain::passive_condition(model_.chain, displacements, metric ? &*metric : nullptr);
  }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return chain::deformation_evaluator(model_, options, fidelity_);
  }

  std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& options) const override {
    return description_.separation ? chain::calibrated_evaluator(model_, options, fidelity_) : nullptr;
  }

  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    if (fidelity_ == chain::Fidelity::first_order) return chain::first_order_trace(model_, pose, errors);
    return chain::deformation_trace(model_, pose, errors, options);
  }

  std::vector<std::string> mobility() const override {
    return mobility_lines(mechanism_, home_mobility(mechanism_), workspace_mobility(mechanism_));
  }

  std::vector<std::string> remarks() const override { return rounding_remarks(mechanism_, mismatch_); }

  std::vector<std::string> unusual_geometry() const override {
    std::vector<std::string> list = home_outside(mechanism_);
    for (std::string& unlike : unlike_limbs(mechanism_)) list.push_back(std::move(unlike));
    return list;
  }

  std::optional<Sketch> sketch(std::span<const double> pose) const override {
    Sketch sketch = sketch_of(mechanism_);
    chain::place(sketch, model_,
                 pose.empty() ? std::vector(model_.chain.joints(), 0.0) : model_.joint_displacements(pose));
    return sketch;
  }

  double rounding(std::size_t response) const override { return chain::effect_rounding(model_, response); }

  std::vector<double> norm_of_details(std::size_t response, std::span<const double> pose) const override {
    return chain::norm_of_details(model_, response, pose);
  }

  Separation separation(std::span<const double> pose) const override { return chain::separation(model_, pose); }

  std::vector<PlatformPoint> metric_points() const override {
    if (model_.chain.meets) return {};
    std::vector<PlatformPoint> points;
    for (const Vector3& point : model_.points) points.push_back({point.x(), point.y(), point.z()});
    return points;
  }

  /// The shortest link of the error's limb, the mechanism's reach where it has none, or half a turn.
  ErrorBound error_bound(FactorIndex factor) const override {
    const Factor& error = description_.factors[factor.value];
    if (error.dimension == Dimension::angle) return {std::numbers::pi, "half a turn"};
    const Limb& limb = mechanism_.limbs[error.limb - 1];
    ErrorBound bound{mechanism_.reach, "the mechanism's reach"};
    for (std::size_t j = 1; j < limb.home.size(); ++j) {
      const double length = limb.home[j].p.norm();
      if (length < kShortestLink * mechanism_.reach || length >= bound.size) continue;
      const std::string to = j < limb.joints.size() ? limb.joints[j].name : "the platform's origin";
      bound = {length, "the distance from " + limb.joints[j - 1].name + " to " + to};
    }
    return bound;
  }

 private:
  /// Errors change what rounded numbers leave by less than this factor.
  static constexpr double kNominalShare = 2.0;
  /// Of the reach; joints that are closer are one part, whose errors may well be as large as that.
  static constexpr double kShortestLink = 0.02;

  Mechanism mechanism_;
  double mismatch_;  ///< m: of perfect limbs, at the most
  std::shared_ptr<const Tracker> tracker_;
  std::vector<Chart> charts_;
  chain::DeformationModel model_;
  ModelDescription description_;
  chain::Fidelity fidelity_;
};

/// A file, and what was found of its mechanism with the default geometry.
struct Read {
  MechanismFile file;
  std::vector<double> defaults;
  Checked at_defaults;

  Checked with(std::span<const double> geometry) const {
    if (std::ranges::equal(geometry, defaults)) return at_defaults;
    return checked(mechanism(file, geometry), Workspace::as_it_is);
  }
};

/// The mechanism with these values, by the metric of these points; none: the file's own, or published.
struct Wanted {
  bool by_platform = true;                          ///< or as published
  std::optional<std::vector<Vector3>> points = {};  ///< instead of the file's
};

std::unique_ptr<Model> built(const Read& read, std::span<const double> values, std::size_t fidelity,
                             const Wanted& wanted) {
  Checked found = read.with(values);
  std::vector<Vector3> points;
  if (wanted.by_platform) points = wanted.points.value_or(found.mechanism.points);
  if (wanted.points) {
    const std::string why = chain::why_no_metric(points, found.mechanism.reach);
    if (!why.empty()) throw std::invalid_argument(why);
  }
  return std::make_unique<FileModel>(read.file, std::move(found), std::move(points),
                                     static_cast<chain::Fidelity>(fidelity));
}

CatalogEntry entry_by(const std::shared_ptr<const Read>& read, const std::string& path, bool by_platform) {
  CatalogEntry entry;
  entry.build = [read, by_platform](std::span<const double> values, std::size_t fidelity) {
    return built(*read, values, fidelity, {.by_platform = by_platform});
  };
  entry.description = entry.build(read->defaults, 0)->description();
  entry.file = path;
  return entry;
}

}  // namespace

std::string reference() {
  return "\n# Mechanism files\n\n"
         "Every key of a mechanism's file, which `[mechanism] file` of a study names and which commands take in the "
         "place "
         "of a\nmodel's name: `poesy models FILE` shows what was understood of it. Everything stands in the base's "
         "frame, "
         "with the\nmechanism at home, as on a drawing.\n\n"
         "- A number may be an expression of parameters: `\"a + 20 mm\"`, with `+ - * / ^ ( )`, `sqrt sin cos tan "
         "atan2 "
         "pi` and units\n  inside. Its dimension is checked. A bare 0 is any quantity; other bare numbers are "
         "numbers. A name behind a\n  number is a unit, `2 * g` twice a parameter.\n"
         "- A point is `[x, y, z]`; a direction `\"x\"`, `\"-z\"`, or three entries of one dimension.\n" +
         tables_reference(mechanism_file_tables());
}

CatalogEntry catalog_entry(const std::string& text, const std::string& path) {
  MechanismFile file = read_mechanism_file(text, path);
  const std::vector<double> defaults = default_geometry(file);
  Checked found = checked(mechanism(file, defaults), Workspace::in_reach);
  const bool meets = found.home.passive_rank == found.home.loop_equations;
  const auto read = std::make_shared<const Read>(std::move(file), defaults, std::move(found));
  CatalogEntry entry = entry_by(read, path, true);
  if (meets) return entry;
  entry.other_metric = std::make_shared<const CatalogEntry>(entry_by(read, path, false));
  entry.build_with_points = [read](std::span<const double> values, std::size_t fidelity,
                                   std::span<const PlatformPoint> points) {
    std::vector<Vector3> own;
    for (const PlatformPoint& point : points) own.emplace_back(point[0], point[1], point[2]);
    return built(*read, values, fidelity, {.points = std::move(own)});
  };
  return entry;
}

}  // namespace poesy::file
