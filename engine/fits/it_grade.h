#pragma once

#include <optional>
#include <string>

/// Grades of ISO 286-1: the width of the tolerance zone of a linear size.
namespace poesy {

/// The twenty grades, the finest first.
enum class ItGrade {
  it01,
  it0,
  it1,
  it2,
  it3,
  it4,
  it5,
  it6,
  it7,
  it8,
  it9,
  it10,
  it11,
  it12,
  it13,
  it14,
  it15,
  it16,
  it17,
  it18
};

/// The name of a grade: ItGrade::it01 -> "IT01".
std::string it_grade_name(ItGrade grade);

/// The width of the tolerance zone (m) for a nominal size (m). A tolerance +-T has the width 2 T. The values are those
/// of the standard's table (ISO 286-1:2010, Table 1; IT01 and IT0: ISO 286-1:1988, Table 5). The formulas of the 1988
/// edition, 7 i, 10 i, 16 i, ... with i = 0.45 D^(1/3) + 0.001 D in micrometres for a size D in mm, differ from the
/// table for small and large sizes. None if the standard has no value: for sizes of 0 or above 3150 mm, for IT01 and
/// IT0 above 500 mm, for IT14 and coarser grades up to 1 mm.
std::optional<double> it_grade_width(double nominal_size, ItGrade grade);

}  // namespace poesy
