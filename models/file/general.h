#pragma once

#include <optional>

#include "engine/fits/general_tolerance.h"
#include "engine/model/feature.h"
#include "engine/schema/keys.h"
#include "models/file/feature_lines.h"

/// General tolerances of a drawing, `[drawing] general`.
namespace poesy::file {

/// The general tolerances that the drawing names.
struct GeneralLines {
  std::optional<GeneralLengthClass> lengths;  ///< of ISO 2768-1
  std::optional<GeneralZoneClass> zones;      ///< of ISO 2768-2
};

/// Reads the table `[drawing]`.
GeneralLines read_drawing(const StudyValue& value);

/// The keys of that table, for the reference.
StudyTable drawing_keys_table();

/// The size (m) of a zone that is written "general". feature: its kind and size. Throws InputError if the file names no
/// standard for it, and for zones for which no standard has a value.
double general_size(const ZoneLines& zone, const Feature& feature, const GeneralLines& general);

}  // namespace poesy::file
