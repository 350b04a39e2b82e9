#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/report/table.h"

namespace poesy {

/// A number in a table, as a page prints it.
struct PrintedNumber {
  std::string text;        ///< UTF-8
  std::size_t tail = 0;    ///< number of characters after its whole part: from the point or the power on
  bool is_number = false;  ///< a cell without a number keeps its text, and has no tail
};

/// The cells of one column in print. Trailing zeros are appended so that all have equally many significant digits, as
/// far as these are digits of the number ("0.5000" below "0.4913"). Large numbers have groups of digits; above a
/// million and below a millionth powers of ten are used ("4.53 x 10^-7" with typographic signs). digits: the number of
/// significant digits; 0: that of the longest cell.
std::vector<PrintedNumber> printed_numbers(std::span<const Cell> column, int digits = 0);

}  // namespace poesy
