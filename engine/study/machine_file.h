#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// What a column of a table of measurements holds.
enum class MachineColumn {
  deviation,  ///< a response as measured, less what was commanded
  actual,     ///< a coordinate of the place itself
  distance    ///< the distance to the platform at another row's pose
};

/// A value that was measured of a machine, SI.
struct MachineValue {
  MachineColumn column;                     ///< its kind
  std::string quantity;                     ///< "z", "tip_x", or "distance"
  std::size_t row;                          ///< position of its row
  std::size_t other = 0;                    ///< position of the row to which a distance is measured
  double value = 0.0;                       ///< SI
  std::optional<double> sd = std::nullopt;  ///< its standard deviation; none: that of [analysis.calibration] noise

  std::string column_name() const;  ///< "deviation_z", "actual_z" or "distance"
};

/// Measurements of one machine: W rows, each a pose and what was measured there.
struct MachineFile {
  PoseTable poses;                   ///< [W], as the file gives them
  std::vector<std::string> names;    ///< [W] names of the rows: "p4", or "row 5" without one
  std::vector<MachineValue> values;  ///< row by row, in the order of the columns; distances behind all others

  std::string name_of(const MachineValue& value) const;  ///< "deviation_z of p4", "distance p1 p4"
};

/// The responses that can be measured as deviation_R: the components of the platform's displacement that the model
/// reports.
std::vector<std::string_view> measurable(const ModelDescription& model);

/// Reads measurements from CSV. The first line names all of the model's pose coordinates or all coordinates of a chart,
/// and any of: deviation_R for a response R, actual_C for a coordinate x, y, z, tip_x, tip_y or tip_z, sd_R and sd_C
/// and sd_distance for standard deviations, name, to, distance. A name may have a unit in brackets; otherwise numbers
/// are SI. An empty cell, or nan, is a missing value. Throws InputError with line and column for a column that is
/// unknown, repeated, missing or of no use, a unit that does not fit, a cell without a number, a pose that is not
/// whole, a name that is taken or unknown, a distance without its other end, and a file without any measured value;
/// FileError if the file cannot be read.
MachineFile read_machine_file(const std::string& path, const ModelDescription& model);

}  // namespace poesy
