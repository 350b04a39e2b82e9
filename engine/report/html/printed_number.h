#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/report/table.h"

namespace poesy {

/// The cell of a table as a page prints it.
struct PrintedNumber {
  std::string text;        ///< text as printed, UTF-8
  std::size_t tail = 0;    ///< number of characters from the decimal point, or from the power of ten, to the end
  bool is_number = false;  ///< true if the cell has a number; otherwise the text is unchanged and `tail` is 0
};

/// The cells of one column as a page prints them. Zeros are appended so that all numbers have the same number of
/// significant digits, but only where these zeros are correct digits ("0.5000" below "0.4913"). Large numbers have
/// groups of digits. Numbers of ten million or more, or below a millionth, are printed with powers of ten ("4.53 x
/// 10^-7" with typographic signs). digits: the number of significant digits; 0: as many as the longest number with a
/// fraction has.
std::vector<PrintedNumber> printed_numbers(std::span<const Cell> column, int digits = 0);

}  // namespace poesy
