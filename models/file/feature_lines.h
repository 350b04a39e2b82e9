#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/feature.h"
#include "engine/schema/keys.h"
#include "models/file/lines.h"

/// Features of a limb's parts with their tolerances, as written in a mechanism file.
namespace poesy::file {

/// The kind of a feature in a file.
enum class FeatureWord { axis, plane, point, distance };
std::string_view name(FeatureWord kind);  ///< "axis", "plane", "point" or "distance".

/// The position of the part with a feature: before or after the joint to which the feature belongs, in the order of the
/// limb.
enum class PartSide { before, after };
std::string_view name(PartSide side);  ///< "before" or "after".

/// The shape of the zones of a feature: around its axis or point (`usual`), or between two planes (`planes`).
enum class ZoneShape { usual, planes };
std::string_view name(ZoneShape shape);  ///< "usual" or "planes".

/// A tolerance of a feature, as written.
struct ZoneLines {
  std::string_view key;  ///< key of the tolerance in the file: "position"
  Expression size;       ///< width or diameter of the zone
  std::string datums;    ///< datums: "A|B"; empty if there are none

  /// Returns true if the drawing's general tolerance gives the size.
  bool is_general() const { return size.text == "general"; }
};

/// A feature, as written.
struct FeatureLines {
  std::string name;                      ///< name, unique in the limb
  std::string key;                       ///< key in the file, for messages: "limb[0].features[1]"
  Place place;                           ///< place of the table of the feature in the file
  FeatureWord kind = FeatureWord::axis;  ///< kind of the feature
  std::optional<Reference> joint;        ///< joint to which the feature belongs
  /// If `joint` has several axes, the number of the feature's axis, counted from 1. The default is the first axis, but
  /// the last one for a part after a joint other than U.
  std::optional<std::size_t> axis;
  PartSide part = PartSide::before;    ///< position of the feature's part relative to the joint
  std::optional<Triple> at;            ///< middle of the feature
  std::optional<Reference> at_point;   ///< middle of the feature, as a named point
  std::optional<Expression> length;    ///< length of an axis
  std::vector<Expression> size;        ///< sides of a rectangular plane, along x and y
  std::optional<Expression> diameter;  ///< diameter of a round plane
  std::optional<Triple> direction;     ///< direction of a distance
  /// Nominal length of a feature of the kind `distance`.
  std::optional<Expression> nominal_size;
  std::optional<Triple> z;             ///< z axis of the feature; default: the joint's axis
  std::optional<Triple> x;             ///< x axis of the feature; default: the x axis of the joint's frame
  ZoneShape shape = ZoneShape::usual;  ///< shape of the feature's zones
  std::string along;                   ///< "x" or "y": normal of the planes between which the zones are
  std::vector<ZoneLines> zones;        ///< zones of the feature, in the order of zone_traits()
};

/// The position of the pin in the bore of a joint with clearance: always at the boundary of the clearance, or uniformly
/// distributed in it.
enum class Contact { boundary, uniform };
std::string_view name(Contact contact);  ///< "boundary" or "uniform".

/// A clearance, as written.
struct ClearanceLines {
  FeatureLines axis;                    ///< axis of the joint, a feature without zones
  std::string fit;                      ///< fit, such as "8 H7/g6"; empty if least and most are given
  Place fit_place;                      ///< place of the fit in the file
  std::optional<Expression> least;      ///< smallest difference of the diameters
  std::optional<Expression> most;       ///< largest difference of the diameters
  Contact contact = Contact::boundary;  ///< position of the pin
};

/// Reads `clearances = [ ... ]`.
std::vector<ClearanceLines> read_clearances(const StudyValue& value);

/// The kind of a feature. A plane is a rectangle or round.
FeatureKind kind_of(const FeatureLines& lines);

/// Reads `features = [ ... ]`.
std::vector<FeatureLines> read_features(const StudyValue& value);

/// The tables of features and clearances with all keys, for key_reference().
StudyTables feature_tables();

}  // namespace poesy::file
