#include "models/file/model.h"

#include <algorithm>
#include <array>
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
#include "models/file/branched_model.h"
#include "models/file/structure.h"
#include "models/file/tracked_model.h"

namespace poesy::file {
namespace {

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
  model.terms = mechanism.terms;
  model.points = std::move(points);
  model.held_at = mechanism.points;
  model.chain.rounded = mechanism.precision.rounded();
  model.joint_displacements = displacements_by(mechanism, std::move(tracker), model);
  model.platform = chain::PlatformReport{mechanism.tool, model.points.empty() ? mechanism.points : model.points};
  return model;
}

/// The largest deformation, over poses of the workspace, that rounded numbers cause without errors.
double nominal_deformation(const Mechanism& mechanism, const chain::DeformationModel& model, std::size_t response) {
  const std::vector<double> no_errors(model.terms.size(), 0.0);
  double largest = 0.0;
  for (const PoseMobility& pose : workspace_mobility(mechanism)) {
    if (!pose.reached()) continue;
    largest = std::max(largest, chain::first_order_trace(model, pose.pose, no_errors).responses[response]);
  }
  return largest;
}

/// A model of limbs between base and platform only, without stiffness.
class ChainModel final : public TrackedModel {
 public:
  /// points: of the platform's metric; none: the published weight.
  ChainModel(const MechanismFile& file, Checked found, std::vector<Vector3> points, chain::Fidelity fidelity)
      : TrackedModel(file, found),
        model_(chain_model(mechanism(), tracker(), found.home, std::move(points))),
        fidelity_(fidelity) {
    set_responses(chain::responses_of(model_));
    ModelDescription& description = described();
    description.separation = chain::separation_description(model_);
    if (model_.chain.meets) return;
    description.metric = model_.points.empty() ? "published" : "platform";
    if (model_.points.empty()) description.tolerance = SolverOptions().tolerance;
    DeformationMeasure measure = chain::deformation_measure(model_);
    if (model_.chain.rounded) {
      measure.rounding =
          std::max(measure.rounding, kNominalShare * nominal_deformation(mechanism(), model_, measure.response));
    }
    description.deformation = measure;
    description.details = chain::deformation_details(model_.chain);
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
    return description().separation ? chain::calibrated_evaluator(model_, options, fidelity_) : nullptr;
  }

  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    if (fidelity_ == chain::Fidelity::first_order) return chain::first_order_trace(model_, pose, errors);
    return chain::deformation_trace(model_, pose, errors, options);
  }

  lie::Matrix3<double> orientation(std::span<const double> pose) const override {
    if (pose.empty()) return mechanism().platform.R;
    return model_.platform_points(model_.joint_displacements(pose))->platform.R;
  }

  std::optional<Sketch> sketch(std::span<const double> pose) const override {
    Sketch sketch = sketch_of(mechanism());
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

 private:
  /// Errors change the deformation by rounded numbers by less than this factor.
  static constexpr double kNominalShare = 2.0;

  chain::DeformationModel model_;
  chain::Fidelity fidelity_;
};

/// A file, and its checked mechanism with the default geometry.
struct Read {
  MechanismFile file;
  std::vector<double> defaults;
  Checked at_defaults;

  Checked with(std::span<const double> geometry) const {
    if (std::ranges::equal(geometry, defaults)) return at_defaults;
    return checked(mechanism(file, geometry), Workspace::as_it_is);
  }
};

/// The basis of the responses: forces by stiffness, or mismatch by the platform's metric or by the published weight.
enum class By { stiffness, platform, published };

/// Throws if a point of the platform gives a response the name of another one.
void check_points(const MechanismFile& file, const ModelDescription& model) {
  for (const NamedPoint& named : file.platform.named) {
    for (const std::string_view end : {"_x", "_y", "_z", "_position"}) {
      const auto other = std::ranges::find(model.responses, named.name + std::string(end), &Response::name);
      if (other == model.responses.end()) continue;
      throw InputError(named.point.place,
                       named.point.key + " gives a response '" + other->name + "', which there is already (" +
                           other->description + ")",
                       "give the point another name");
    }
  }
}

/// The model with the named points of its platform.
std::unique_ptr<Model> with_points(std::unique_ptr<TrackedModel> model, const Read& read,
                                   std::vector<NamedPlatformPoint> named, chain::Fidelity fidelity) {
  check_points(read.file, model->description());
  const TrackedModel* const tracked = model.get();
  const auto orientation = [tracked](std::span<const double> pose) {
    const lie::Matrix3<double> R = tracked->orientation(pose);
    return std::array{R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)};
  };
  return with_platform_points(std::move(model), std::move(named), orientation,
                              fidelity == chain::Fidelity::first_order);
}

/// The model for these values of the geometry. points: of the platform's metric; none: the file's own.
std::unique_ptr<Model> built(const Read& read, std::span<const double> values, std::size_t fidelity, By by,
                             std::optional<std::vector<Vector3>> points = {}) {
  Checked found = read.with(values);
  if (points) {
    const std::string why = chain::why_no_metric(*points, found.mechanism.reach);
    if (!why.empty()) throw std::invalid_argument(why);
  }
  const auto wanted = static_cast<chain::Fidelity>(fidelity);
  std::vector<NamedPlatformPoint> named = found.mechanism.named;
  if (found.mechanism.is_branched() || by == By::stiffness) {
    const auto metric = by == By::stiffness ? assembly::Metric::stiffness : assembly::Metric::platform;
    if (points) found.mechanism.points = *std::move(points);
    return with_points(branched_model(read.file, std::move(found), metric, wanted), read, std::move(named), wanted);
  }
  std::vector<Vector3> own = by == By::platform ? points.value_or(found.mechanism.points) : std::vector<Vector3>();
  return with_points(std::make_unique<ChainModel>(read.file, std::move(found), std::move(own), wanted), read,
                     std::move(named), wanted);
}

CatalogEntry entry_by(const std::shared_ptr<const Read>& read, const std::string& path, By by) {
  CatalogEntry entry;
  entry.build = [read, by](std::span<const double> values, std::size_t fidelity) {
    return built(*read, values, fidelity, by);
  };
  entry.description = entry.build(read->defaults, 0)->description();
  entry.file = path;
  if (entry.description.metric != "platform") return entry;
  entry.build_with_points = [read](std::span<const double> values, std::size_t fidelity,
                                   std::span<const PlatformPoint> points) {
    std::vector<Vector3> own;
    for (const PlatformPoint& point : points) own.emplace_back(point[0], point[1], point[2]);
    return built(*read, values, fidelity, By::platform, std::move(own));
  };
  return entry;
}

}  // namespace

std::string reference() {
  StudyTables tables = mechanism_file_tables();
  std::erase_if(tables, [](const StudyTable& table) { return table.paths.front().starts_with("response"); });
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
         tables_reference(tables);
}

namespace {

/// The same responses for a model with another metric, without those that it cannot form.
std::vector<OwnResponse> by_names(const std::vector<OwnResponse>& own, const ModelDescription& from,
                                  const ModelDescription& to) {
  const ModelDescription named = described(from, own);
  std::vector<std::string> known;
  for (const Response& response : to.responses) known.push_back(response.name);
  std::vector<OwnResponse> list;
  for (OwnResponse one : own) {
    const bool is_formed = std::ranges::all_of(one.terms, [&](ResponseTerm& term) {
      const auto found = std::ranges::find(known, named.responses[term.response].name);
      term.response = static_cast<std::size_t>(found - known.begin());
      return found != known.end();
    });
    if (!is_formed || std::ranges::find(known, one.name) != known.end()) continue;
    known.push_back(one.name);
    list.push_back(std::move(one));
  }
  return list;
}

/// The entry with these responses, by all its metrics; positions are those of `from`.
CatalogEntry with_own(CatalogEntry entry, const std::vector<OwnResponse>& own, const ModelDescription& from) {
  if (entry.other_metric != nullptr) {
    entry.other_metric = std::make_shared<const CatalogEntry>(with_own(*entry.other_metric, own, from));
  }
  const std::vector<OwnResponse> formed = by_names(own, from, entry.description);
  return with_responses(std::move(entry), formed);
}

/// The catalog entry of a file.
CatalogEntry entry_of(MechanismFile file, const std::string& path, const std::string& text) {
  const std::vector<double> defaults = default_geometry(file);
  Checked found = checked(mechanism(file, defaults), Workspace::in_reach);
  const Mechanism& at_defaults = found.mechanism;
  const bool meets = found.home.passive_rank == found.home.loop_equations;
  std::vector<By> ways;
  if (at_defaults.is_elastic()) ways.push_back(By::stiffness);
  ways.push_back(By::platform);
  if (!at_defaults.is_branched() && !meets) ways.push_back(By::published);
  const auto read = std::make_shared<const Read>(std::move(file), defaults, std::move(found));
  std::shared_ptr<const CatalogEntry> other;
  for (auto by = ways.rbegin(); by != ways.rend(); ++by) {
    CatalogEntry entry = entry_by(read, path, *by);
    entry.other_metric = std::move(other);
    other = std::make_shared<const CatalogEntry>(std::move(entry));
  }
  const std::vector<OwnResponse> own = read_own_responses(text, path, other->description);
  if (own.empty()) return *other;
  static_cast<void>(with_responses(other->build(defaults, 0), own));  // throws if one is relative to no pose of it
  return with_own(*other, own, other->description);
}

/// Adds to the entry, for all its metrics, the function that changes loads.
CatalogEntry with_loads(CatalogEntry entry, const MechanismFile& file, const std::string& path,
                        const std::string& text) {
  entry.with_load = [file, path, text](const StudyValue& value) {
    MechanismFile loaded = file;
    loaded.load = read_load(value);
    CatalogEntry other = with_loads(entry_of(loaded, path, text), file, path, text);
    other.load = load_text(loaded.load);
    return other;
  };
  return entry;
}

}  // namespace

CatalogEntry catalog_entry(const std::string& text, const std::string& path) {
  const MechanismFile file = read_mechanism_file(text, path);
  return with_loads(entry_of(file, path, text), file, path, text);
}

}  // namespace poesy::file
