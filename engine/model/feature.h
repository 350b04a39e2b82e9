#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/index.h"

namespace poesy {

/// What a feature of a part is. A plane is a rectangle or round.
enum class FeatureKind { axis, rectangle, round, point, distance };

/// What a zone limits.
enum class ZoneClass {
  location,     ///< where the feature is, and with it how it is turned
  orientation,  ///< how it is turned
  size          ///< how long a distance is
};

/// A tolerance of a drawing.
struct Zone {
  std::string_view key;  ///< "position"; see zone_traits()
  double size;           ///< width or diameter as written; of a distance the larger or smaller one by this (m)
  std::string datums;    ///< "A|B"; empty: none
};

/// The clearance of a pin in a bore, as a difference of diameters (m).
struct Clearance {
  double most;          ///< the largest
  double mean_square;   ///< m^2, over the parts that are made
  bool touches = true;  ///< whether the pin touches the bore; otherwise it is anywhere in it
};

/// A feature of a part with the errors by which it is displaced, all lengths (m).
struct Feature {
  std::string name;   ///< "rail_1"
  std::string label;  ///< name on the drawing, the same in all limbs: "rail"
  std::size_t limb;   ///< counts from 1
  std::size_t frame;  ///< of the limb, that its errors change
  FeatureKind kind;   ///< what it is
  /// m: length of an axis; sides of a rectangle; diameter of a round plane; nominal size of a distance, 0 if unknown
  std::array<double, 2> size = {};
  bool one_direction = false;            ///< whether the zone of an axis or a point is between two planes
  std::vector<FactorIndex> middle = {};  ///< errors that move it: x, y of an axis; z of a plane; x, y, z; a distance
  std::vector<FactorIndex> tilt = {};    ///< errors that turn it: lean_x, lean_y of an axis; lift_x, lift_y of a plane
  std::optional<Zone> location = {};     ///< also the tolerance of a distance
  std::optional<Zone> orientation = {};  ///< of class orientation
  /// Instead of zones: an axis is loose in its bore, at each pose in another way.
  std::optional<Clearance> clearance = {};

  std::vector<FactorIndex> errors() const;  ///< All errors: those that move it, then those that turn it.
};

/// What a kind of zone is.
struct ZoneTraits {
  std::string_view key;   ///< in files: "position"
  ZoneClass of;           ///< what it limits on a plane
  std::string_view sign;  ///< UTF-8, as on a drawing
};

/// All kinds of zones, in the order of ISO 1101.
const std::vector<ZoneTraits>& zone_traits();

/// The kind of this key. Precondition: it is one.
const ZoneTraits& zone_traits(std::string_view key);

/// What a zone of this key limits on a feature of this kind: a run-out of an axis is a location, because a pointer
/// shows twice the eccentricity.
ZoneClass zone_class(std::string_view key, FeatureKind kind);

}  // namespace poesy
