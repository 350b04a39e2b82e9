#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/index.h"

namespace poesy {

/// The geometric kind of a feature of a part. `rectangle` and `round` are plane faces with a rectangular or circular
/// outline; `distance` is a length of the part.
enum class FeatureKind { axis, rectangle, round, point, distance };

/// The property of a feature that a zone (a tolerance of a drawing) limits.
enum class ZoneClass {
  location,     ///< the position of the feature, and with it the orientation
  orientation,  ///< only the orientation
  size          ///< the length of a distance
};

/// A tolerance of a drawing, as a zone in which a feature must be.
struct Zone {
  std::string_view key;  ///< type of the zone, such as "position"; see zone_traits()
  /// Width or diameter of the zone as written on the drawing; for a distance, the largest deviation +- (m).
  double size;
  std::string datums;  ///< datums of the zone, such as "A|B"; empty: none
};

/// The clearance of a pin in a bore: the difference of their diameters (m).
struct Clearance {
  double most;         ///< largest clearance
  double mean_square;  ///< mean square of the clearance over the manufactured parts, m^2
  /// True if the pin always touches the bore; false if it may be anywhere within the clearance.
  bool touches = true;
};

/// A feature of a part, and the errors that displace it. All lengths are in m.
struct Feature {
  std::string name;   ///< name of the feature, such as "rail_1"
  std::string label;  ///< name on the drawing, the same in all limbs, such as "rail"
  std::size_t limb;   ///< limb of the part, counted from 1
  std::size_t frame;  ///< index of the limb's frame that the errors of the feature displace
  FeatureKind kind;   ///< geometric kind of the feature
  /// Size in m: length of an axis; two sides of a rectangle; diameter of a round face; nominal size of a distance, 0 if
  /// unknown.
  std::array<double, 2> size = {};
  bool one_direction = false;  ///< true if the zone of an axis or a point is between two planes
  /// Errors that move the feature: x and y of an axis; z of a plane face; x, y and z of a point; the error of a
  /// distance.
  std::vector<FactorIndex> middle = {};
  /// Errors that turn the feature: lean_x and lean_y of an axis; lift_x and lift_y of a plane face.
  std::vector<FactorIndex> tilt = {};
  std::optional<Zone> location = {};     ///< zone that limits the location; for a distance, the tolerance
  std::optional<Zone> orientation = {};  ///< zone that limits only the orientation
  /// The clearance of a pin whose axis is the feature, if the pin is loose in its bore; none for other features. A
  /// feature with a clearance has no zones. The position of the pin in the bore changes from pose to pose.
  std::optional<Clearance> clearance = {};

  std::vector<FactorIndex> errors() const;  ///< All errors: first those that move the feature, then those that turn it.
};

/// The properties of one type of zone.
struct ZoneTraits {
  std::string_view key;   ///< name in files, such as "position"
  ZoneClass of;           ///< property that the zone limits on a plane face; see zone_class() for other features
  std::string_view sign;  ///< symbol on a drawing, UTF-8
};

/// The properties of all types of zones: first zones of location, then of orientation, then of size (ZoneTraits::of).
const std::vector<ZoneTraits>& zone_traits();

/// The properties of zones with this key. Precondition: zone_traits() has the key.
const ZoneTraits& zone_traits(std::string_view key);

/// The property that a zone with this key limits on a feature of this kind. It is ZoneTraits::of, with one exception: a
/// run-out limits the location of an axis, because a dial gauge shows twice the eccentricity of the axis.
ZoneClass zone_class(std::string_view key, FeatureKind kind);

}  // namespace poesy
