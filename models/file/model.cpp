#include "models/file/model.h"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <utility>

#include "engine/schema/keys.h"
#include "models/chain/metric.h"
#include "models/file/balanced_model.h"
#include "models/file/metric_check.h"
#include "models/file/published_model.h"

namespace poesy::file {
namespace {

/// The mechanism for these values of the geometry. Faults of loops and drives are reported before faults of the metric.
Checked checked_mechanism(const MechanismFile& file, std::span<const double> geometry, Workspace workspace) {
  Checked found = checked(mechanism(file, geometry), workspace);
  check_metric(file, found.mechanism);
  return found;
}

/// A mechanism file, and its checked mechanism with the default geometry.
struct Read {
  MechanismFile file;
  std::vector<double> defaults;
  Checked at_defaults;

  Checked with(std::span<const double> geometry) const {
    if (std::ranges::equal(geometry, defaults)) return at_defaults;
    return checked_mechanism(file, geometry, Workspace::as_it_is);
  }
};

/// The measure by which a model states how limbs deform each other: forces from stiffness, mismatch in the platform's
/// metric, or mismatch as published (1 rad weighs as much as 1 m).
enum class By { stiffness, platform, published };

/// Throws if a response of a named point of the platform would have the name of another response.
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

/// The model extended by the named points of its platform.
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

/// Builds the model for these values of the geometry (SI). points: points that define the platform's metric (m);
/// default: those of the file.
std::unique_ptr<Model> built(const Read& read, std::span<const double> values, std::size_t fidelity, By by,
                             std::optional<std::vector<Vector3>> points = {}) {
  Checked found = read.with(values);
  if (points) {
    const std::string why = chain::why_no_metric(*points, found.mechanism.reach);
    if (!why.empty()) throw std::invalid_argument(why);
  }
  const auto wanted = static_cast<chain::Fidelity>(fidelity);
  std::vector<NamedPlatformPoint> named = found.mechanism.named;
  if (points) found.mechanism.points = *std::move(points);
  const auto made = [&]() -> std::unique_ptr<TrackedModel> {
    if (by == By::published) return published_model(read.file, std::move(found), wanted);
    const auto metric = by == By::stiffness ? assembly::Metric::stiffness : assembly::Metric::platform;
    return balanced_model(read.file, std::move(found), metric, wanted);
  };
  return with_points(made(), read, std::move(named), wanted);
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

std::string key_reference() {
  StudyTables tables = mechanism_file_tables();
  std::erase_if(tables, [](const StudyTable& table) { return table.paths.front().starts_with("response"); });
  return "\n# Mechanism files\n\n"
         "Every key of a mechanism's file, which `[mechanism] file` of a study names and which commands take in the "
         "place "
         "of a\nmodel's name: `poesy models FILE` shows what was understood of it. Everything stands in the base's "
         "frame, "
         "with the\nmechanism at home, as on a drawing.\n\n"
         "- A number may be an expression of parameters: `\"a + 20 mm\"`, with `+ - * / ^ ( )`, `sqrt sin cos tan "
         "atan atan2 "
         "pi` and units\n  inside. Its dimension is checked. A bare 0 is any quantity; other bare numbers are "
         "numbers. A name behind a\n  number is a unit, `2 * g` twice a parameter.\n"
         "- A point is `[x, y, z]`; a direction `\"x\"`, `\"-z\"`, or three entries of one dimension.\n" +
         tables_reference(tables);
}

namespace {

/// Converts the responses `own`, which the file itself defines, from the model `from` to the model `to` with another
/// metric. They refer to other responses by their indices in the model. Responses that `to` cannot form are left out.
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

/// The catalog entry, extended for each of its metrics by the responses `own` that the file defines. `own` refers to
/// other responses by their indices in the model `from`.
CatalogEntry with_own(CatalogEntry entry, const std::vector<OwnResponse>& own, const ModelDescription& from) {
  if (entry.other_metric != nullptr) {
    entry.other_metric = std::make_shared<const CatalogEntry>(with_own(*entry.other_metric, own, from));
  }
  const std::vector<OwnResponse> formed = by_names(own, from, entry.description);
  return with_responses(std::move(entry), formed);
}

/// The catalog entry of a mechanism file.
CatalogEntry entry_of(MechanismFile file, const std::string& path, const std::string& text) {
  const std::vector<double> defaults = default_geometry(file);
  Checked found = checked_mechanism(file, defaults, Workspace::in_reach);
  const Mechanism& at_defaults = found.mechanism;
  const bool meets = found.home.passive_rank == found.home.loop_equations;
  std::vector<By> ways;
  if (at_defaults.is_elastic()) ways.push_back(By::stiffness);
  ways.push_back(By::platform);
  if (!at_defaults.is_branched() && !meets) ways.push_back(By::published);
  const auto read = std::make_shared<const Read>(Read{std::move(file), defaults, std::move(found)});
  std::shared_ptr<const CatalogEntry> other;
  for (auto by = ways.rbegin(); by != ways.rend(); ++by) {
    CatalogEntry entry = entry_by(read, path, *by);
    entry.other_metric = std::move(other);
    other = std::make_shared<const CatalogEntry>(std::move(entry));
  }
  const std::vector<OwnResponse> own = read_own_responses(text, path, other->description);
  if (own.empty()) return *other;
  // Throws if a response is relative to a pose that the model does not reach.
  static_cast<void>(with_responses(other->build(defaults, 0), own));
  return with_own(*other, own, other->description);
}

/// Adds the function that changes loads (CatalogEntry::with_load) to the catalog entry. The entry that with_load
/// returns has all metrics of the file.
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
