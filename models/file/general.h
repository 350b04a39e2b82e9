#pragma once

#include <optional>

#include "engine/fits/general_tolerance.h"
#include "engine/model/feature.h"
#include "engine/schema/keys.h"
#include "models/file/feature_lines.h"

/// General tolerances of a drawing: `[drawing] general`.
namespace poesy::file {

/// The classes of general tolerances that the drawing names.
struct GeneralLines {
  std::optional<GeneralLengthClass> lengths;  ///< class of ISO 2768-1 for lengths
  std::optional<GeneralZoneClass> zones;      ///< class of ISO 2768-2 for zones
};

/// Reads the table `[drawing]`.
GeneralLines read_drawing(const StudyValue& value);

/// The keys of `[drawing]`, for key_reference().
StudyTable drawing_keys_table();

/// The size (m) of a zone that is written "general". feature: the feature that has the zone. Throws InputError if the
/// file names no standard for the zone, or if the standard has no value for it.
double general_size(const ZoneLines& zone, const Feature& feature, const GeneralLines& general);

}  // namespace poesy::file
