#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// What a column of a table of measurements contains.
enum class MachineColumn {
  deviation,  ///< deviation of a response: its measured value minus its commanded value
  actual,     ///< a measured coordinate of the platform or of its tool
  distance    ///< the distance between the measured point at this row's pose and at another row's pose
};

/// One measured value of a machine.
struct MachineValue {
  MachineColumn column;   ///< kind of the column
  std::string quantity;   ///< name of the measured quantity: "z", "tip_x", or "distance"
  std::size_t row;        ///< index of the row
  std::size_t other = 0;  ///< index of the row to which a distance is measured
  double value = 0.0;     ///< measured value, SI
  /// Standard deviation of the measured value, SI; none: the key `noise` of [analysis.calibration] states it.
  std::optional<double> sd = std::nullopt;

  std::string column_name() const;  ///< The title of the value's column: "deviation_z", "actual_z" or "distance".
};

/// Measurements of one machine. Each row has a pose and the values that were measured at this pose.
struct MachineFile {
  PoseTable poses;                 ///< pose of each row, in the coordinates of the file
  std::vector<std::string> names;  ///< name of each row: "p4", or "row 5" for a row without a name
  /// All values except distances, row by row in the order of the columns, followed by all distances.
  std::vector<MachineValue> values;
  /// Titles, without a unit, of the columns of values and standard deviations that state no unit.
  std::vector<std::string> bare;

  /// The value's name in messages: "deviation_z of p4", "distance p1 p4".
  std::string name_of(const MachineValue& value) const;
};

/// The responses of the model that can be measured, each in a column "deviation_RESPONSE": the components of the
/// displacement of the platform and of its tool.
std::vector<std::string_view> measurable(const ModelDescription& model);

/// Reads measurements from a CSV file. The first line names all of the model's pose coordinates, or all coordinates of
/// a chart. It may also name these columns:
/// - deviation_R for a response R,
/// - actual_C for a coordinate C, which is one of x, y, z, tip_x, tip_y and tip_z,
/// - sd_R, sd_C and sd_distance for standard deviations,
/// - `name` for the name of the row,
/// - `distance` for a measured distance, together with `to` for the name of the row to which the distance is measured.
///
/// A title may have a unit in brackets; numbers without a unit are SI. A cell that is empty or has the text nan is a
/// missing value.
///
/// Throws InputError with line and column for a column that is unknown, repeated, missing or unused, a unit of another
/// dimension, a cell without a number, an incomplete pose, a row name that is taken or unknown, a distance without the
/// name of the other row, and a file without any measured value. Throws FileError if the file cannot be read.
MachineFile read_machine_file(const std::string& path, const ModelDescription& model);

}  // namespace poesy
