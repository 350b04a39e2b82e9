#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/feature.h"
#include "engine/schema/keys.h"
#include "models/file/lines.h"

/// Features of a limb's parts with their tolerances, as written.
namespace poesy::file {

/// The kind of a feature in a file.
enum class FeatureWord { axis, plane, point, distance };
std::string_view name(FeatureWord kind);  ///< "axis", "plane", "point" or "distance".

/// The part that bears a feature of a joint.
enum class PartSide { before, after };
std::string_view name(PartSide side);  ///< "before" or "after".

/// The shape of a zone that a drawing does not say by a diameter.
enum class ZoneShape { usual, planes };
std::string_view name(ZoneShape shape);  ///< "usual" or "planes".

/// A tolerance of a feature, as written.
struct ZoneLines {
  std::string_view key;  ///< "position"
  Expression size;       ///< width or diameter
  std::string datums;    ///< "A|B"; empty: none

  bool is_general() const { return size.text == "general"; }  ///< Whether a standard gives its size.
};

/// A feature, as written.
struct FeatureLines {
  std::string name;                      ///< unique in the limb
  std::string key;                       ///< for messages: "limb[0].features[1]"
  Place place;                           ///< of its table
  FeatureWord kind = FeatureWord::axis;  ///< what it is
  std::optional<Reference> joint;        ///< the joint to which it belongs
  std::optional<std::size_t> axis;       ///< elementary joint of that joint, from 1; none: first or last
  PartSide part = PartSide::before;      ///< the part that bears it
  std::optional<Triple> at;              ///< its middle
  std::optional<Reference> at_point;     ///< its middle, by name
  std::optional<Expression> length;      ///< of an axis
  std::vector<Expression> size;          ///< sides of a plane, along x and y
  std::optional<Expression> diameter;    ///< of a round plane
  std::optional<Triple> direction;       ///< of a distance
  /// How long a distance is.
  std::optional<Expression> nominal_size;
  std::optional<Triple> z;             ///< none: the joint's axis
  std::optional<Triple> x;             ///< none: that of the joint's frame
  ZoneShape shape = ZoneShape::usual;  ///< of its zones
  std::string along;                   ///< "x" or "y": across the planes of its zones
  std::vector<ZoneLines> zones;        ///< in the order of zone_traits()
};

/// Where the pin of a clearance is.
enum class Contact { boundary, uniform };
std::string_view name(Contact contact);  ///< "boundary" or "uniform".

/// A clearance, as written.
struct ClearanceLines {
  FeatureLines axis;                    ///< its axis, without zones
  std::string fit;                      ///< "8 H7/g6"; empty: the two lengths
  Place fit_place;                      ///< of the fit
  std::optional<Expression> least;      ///< difference of the diameters
  std::optional<Expression> most;       ///< difference of the diameters
  Contact contact = Contact::boundary;  ///< where the pin is
};

/// Reads `clearances = [ ... ]`.
std::vector<ClearanceLines> read_clearances(const StudyValue& value);

/// Its kind: a plane is a rectangle or round.
FeatureKind kind_of(const FeatureLines& lines);

/// Reads `features = [ ... ]`.
std::vector<FeatureLines> read_features(const StudyValue& value);

/// The tables of this header with all keys, for the reference.
StudyTables feature_tables();

}  // namespace poesy::file
