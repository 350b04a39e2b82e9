#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/report/table.h"

namespace poesy {

/// A number of a table as a page prints it.
struct PrintedNumber {
  std::string text;        ///< UTF-8
  std::size_t tail = 0;    ///< how many characters stand behind its whole part: those from the point or the power on
  bool is_number = false;  ///< a cell without a number keeps its text, and has no tail
};

/// The cells of one column, of the digits that they have: with the zeros behind them that make as many significant
/// digits as the others have, as far as they are digits of the number ("0.5000" below "0.4913"); digits of large
/// numbers in groups of three; powers of ten above a million and below a millionth ("4.53 x 10^-7" with the signs of
/// print).
/// digits: how many those are; 0: as many as the longest has.
std::vector<PrintedNumber> printed_numbers(std::span<const Cell> column, int digits = 0);

}  // namespace poesy
