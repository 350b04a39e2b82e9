#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/model/model.h"
#include "engine/model/pose_set.h"

namespace poesy {

/// Points in the pose's own coordinates, or in those of one of the model's charts.
struct PoseTable {
  std::optional<std::size_t> chart;  ///< position among the model's charts; none: the pose's own coordinates
  PoseSet points;                    ///< [M x coordinates], SI
};

/// The coordinates of the pose, or of a chart.
const std::vector<PoseCoordinate>& coordinates(const ModelDescription& model, std::optional<std::size_t> chart);

/// Points run through in time.
struct TimedPoints {
  std::vector<double> time;  ///< [M] s, strictly ascending
  PoseTable table;           ///< [M]
};

/// A part of a curve's time.
struct TimeRange {
  double start;  ///< s
  double end;    ///< s, after start
};

/// What a study says of a trajectory: a named curve of the model, or points of a file.
struct Trajectory {
  std::optional<std::size_t> curve;  ///< position among the model's curves; none: of a file
  std::vector<double> origin;        ///< where the curve's zero stands, [coordinates of its chart], SI
  std::string file;                  ///< as written in the study; empty for a curve
  TimedPoints from_file;             ///< at least two; empty where the file was not opened
  std::size_t points = 0;            ///< poses, evenly spaced in time; 0: those of the file as they are
  std::optional<TimeRange> time;     ///< none where points is 0, or where the file was not opened and sets it
  Place first_row;                   ///< of the file (point m is m lines below)
};

/// The trajectory's points: of a curve at evenly spaced times, both ends included; those of the file as they are; or
/// those of the file interpolated over time at evenly spaced times, each coordinate by itself: a modified Akima spline
/// through four points or more, straight lines through two or three. Precondition: the file was opened, the times lie
/// inside its range.
TimedPoints sampled(const Trajectory& trajectory, const ModelDescription& model);

}  // namespace poesy
